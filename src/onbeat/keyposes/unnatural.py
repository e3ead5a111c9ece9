"""Unnatural postures of rebuilt poses (keyposes 2009, Figs. 13 and 14): what people's own motions never do.

Three kinds: a bone goes through another (a hand inside the trunk), a joint is bent beyond its range (a shin to the
front of its knee, a forearm into the upper arm), a bone has another length. What is natural is learned from the
originals, in body sizes: by construction they have none of the three. A limb straighter than the originals' is natural;
which way an elbow bends is not told by points, for the shoulder may have turned.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numba
import numpy as np

from onbeat._shapes import Array, Bools, Ints, Positions, frozen
from onbeat.errors import BodyError
from onbeat.keyposes.playable import bone_ends
from onbeat.keyposes.vectors import CROWN, PoseVectors
from onbeat.motion.motion import Motion

ADULT = 1.9
"""Metres, the body size of the adult whose radii are below."""
SLACK = 0.01
"""Metres of an adult that a bone may come nearer to another than the originals' do."""
BENT = np.radians(10.0)
"""Radians that a joint may bend beyond the originals' range."""
STRETCHED = 0.1
"""Of a bone's length, by which it may differ."""
SHORT = 0.03
"""Body sizes; the length of shorter bones is not looked at."""
_HINGES = (
    ("shoulder", "elbow", "wrist"),
    ("elbow", "wrist", "hand"),
    ("hip", "knee", "ankle"),
    ("knee", "ankle", "toe"),
)


class Bone(NamedTuple):
    """A capsule from one point to another; its radius in metres of an adult."""

    first: str
    last: str
    radius: float


def _bones() -> tuple[Bone, ...]:
    bones = [Bone("hips", "neck", 0.1), Bone("head", CROWN, 0.09)]
    for side in ("left", "right"):
        bones += [
            Bone(f"{side}_{first}", f"{side}_{last}", radius)
            for first, last, radius in (
                ("shoulder", "hip", 0.07), ("shoulder", "elbow", 0.045), ("elbow", "wrist", 0.035),
                ("wrist", "hand", 0.03), ("hip", "knee", 0.07), ("knee", "ankle", 0.05), ("ankle", "toe", 0.035),
            )
        ]  # fmt: skip
    return tuple(bones)


BONES = _bones()
"""The body's capsules; of each side of the trunk there is one, for a trunk is wide."""


@dataclass(frozen=True, eq=False)
class Unnatural:
    """How far each of F poses is beyond what is natural; 0 and below is natural.

    Parameters
    ----------
    through : (F,) metres that the worst bone is inside another.
    beyond : (F,) radians that the worst joint is beyond its range.
    stretched : (F,) how much more than ``STRETCHED`` of its length the worst bone has changed.
    change : (F,) mean change of the bones' lengths, of their length.
    """

    through: Array
    beyond: Array
    stretched: Array
    change: Array

    def __post_init__(self) -> None:
        for name in ("through", "beyond", "stretched", "change"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @property
    def postures(self) -> Bools:
        """(F,) true where a bone goes through another or a joint is beyond its range: what is seen as unnatural."""
        return np.asarray((self.through > 0) | (self.beyond > 0))

    def shares(self) -> dict[str, float]:
        """The share of the frames with each kind, and the mean change of bone lengths."""
        return {
            "through": float((self.through > 0).mean()),
            "beyond": float((self.beyond > 0).mean()),
            "stretched": float((self.stretched > 0).mean()),
            "postures": float(self.postures.mean()),
            "length_change": float(self.change.mean()),
        }


@dataclass(frozen=True, eq=False)
class Natural:
    """What some people's motions do, in body sizes and radians.

    Parameters
    ----------
    points : N names.
    pairs : (P, 4) points of two bones each.
    nearest : (P,) how near they may come.
    hinges : (H, 3) points of a joint's two bones; ``angles`` (H,) radians it may be bent, 0 is straight.
    knees : (L, 4) points of hip, knee, ankle and toe; ``fronts`` (L,) how far the knee is before the line from hip to
        ankle at least, as an angle.
    """

    points: tuple[str, ...]
    pairs: Ints
    nearest: Array
    hinges: Ints
    angles: Array
    knees: Ints
    fronts: Array

    @classmethod
    def of(cls, people: Sequence[PoseVectors]) -> Natural:
        """Learn from motions, given as vectors of the same points.

        Raises
        ------
        BodyError
            If there is no motion, or the points differ.
        """
        if not people or any(one.points != people[0].points for one in people):
            raise BodyError("postures are learned from motions by the same points; take them with `pose_vectors`")
        names = people[0].points
        at = {name: number for number, name in enumerate(names)}
        bones = [bone for bone in BONES if bone.first in at and bone.last in at]
        pairs, touching = _pairs(bones, at)
        hinges, knees = _hinges(at)
        poses = np.concatenate([one.values for one in people]).reshape(-1, len(names), 3)
        nearest = np.minimum(_gaps(poses, pairs).min(axis=0), touching)
        most = _angles(poses, hinges).max(axis=0) + BENT
        # A straight leg is natural, however bent the originals' always are.
        fronts = np.minimum(_fronts(poses, knees).min(axis=0), 0.0) - BENT
        return cls(names, pairs, nearest - SLACK / ADULT, hinges, most, knees, fronts)

    def judge(self, values: Array, vectors: PoseVectors, original: Motion) -> Unnatural:
        """How unnatural poses (F, 3N) are that stand for those of a person.

        Parameters
        ----------
        values : the poses, in body sizes.
        vectors : the person's own poses, which give the size and the bones' lengths.
        original : the motion they are of, for its skeleton.
        """
        poses = np.asarray(values, np.float64).reshape(len(values), len(self.points), 3)
        bent, fronts = _angles(poses, self.hinges), _fronts(poses, self.knees)
        past = np.concatenate((bent - self.angles, self.fronts - fronts), axis=1)
        bones = bone_ends(original.skeleton, vectors.joints)
        lengths = _lengths(vectors.values.reshape(len(vectors), -1, 3), bones)
        usual = np.median(lengths, axis=0)
        long, low, high = usual > SHORT, lengths.min(axis=0), lengths.max(axis=0)
        made = _lengths(poses, bones)[:, long]
        change = np.maximum(np.maximum(made - high[long], low[long] - made), 0.0) / usual[long]
        return Unnatural(
            (self.nearest - _gaps(poses, self.pairs)).max(axis=1) * vectors.size,
            past.max(axis=1),
            change.max(axis=1) - STRETCHED,
            change.mean(axis=1),
        )


def _pairs(bones: Sequence[Bone], at: Mapping[str, int]) -> tuple[Ints, Array]:
    """Points of all pairs of bones that share none, and the distance at which they touch, in body sizes."""
    pairs = [(a, b) for n, a in enumerate(bones) for b in bones[:n] if not {a.first, a.last} & {b.first, b.last}]
    ends = [[at[name] for name in (a.first, a.last, b.first, b.last)] for a, b in pairs]
    return np.array(ends, np.int64).reshape(-1, 4), np.array([a.radius + b.radius for a, b in pairs]) / ADULT


def _hinges(at: Mapping[str, int]) -> tuple[Ints, Ints]:
    """Points of the joints whose angle is looked at, and of the knees with their toes."""
    sides = [[f"{side}_{part}" for part in hinge] for hinge in _HINGES for side in ("left", "right")]
    hinges = [hinge for hinge in [*sides, ["neck", "head", CROWN], ["chest", "neck", "head"]] if set(hinge) <= set(at)]
    legs = [[f"{side}_{part}" for part in ("hip", "knee", "ankle", "toe")] for side in ("left", "right")]
    knees = [leg for leg in legs if set(leg) <= set(at)]
    return (
        np.array([[at[name] for name in hinge] for hinge in hinges], np.int64).reshape(-1, 3),
        np.array([[at[name] for name in leg] for leg in knees], np.int64).reshape(-1, 4),
    )


def _lengths(poses: Positions, bones: Ints) -> Array:
    return np.linalg.norm(poses[:, bones[:, 1]] - poses[:, bones[:, 0]], axis=-1)


def _angles(poses: Positions, hinges: Ints) -> Array:
    """(F, H) radians between a joint's two bones, 0 where it is straight."""
    a, b = (poses[:, hinges[:, n + 1]] - poses[:, hinges[:, n]] for n in (0, 1))
    return np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1))


def _fronts(poses: Positions, knees: Ints) -> Array:
    """(F, L) radians: how far the knee is off the line from hip to ankle, to where the toes are; below 0 behind it.

    Of a straight leg the bend is next to none, whichever way: it is the sine of half the bend, with its sign.
    """
    hip, knee, ankle, toe = (poses[:, knees[:, n]] for n in range(4))
    leg, long = ankle - hip, np.linalg.norm(knee - hip, axis=-1) + np.linalg.norm(ankle - knee, axis=-1)
    along = leg / np.maximum(np.linalg.norm(leg, axis=-1, keepdims=True), 1e-9)
    off, ahead = (v - along * np.sum(v * along, axis=-1, keepdims=True) for v in (knee - hip, toe - ankle))
    ahead = ahead / np.maximum(np.linalg.norm(ahead, axis=-1, keepdims=True), 1e-9)
    sine = 2.0 * np.sum(off * ahead, axis=-1) / np.maximum(long, 1e-9)
    return 2.0 * np.arcsin(np.clip(sine, -1.0, 1.0))


def _gaps(poses: Positions, pairs: Ints) -> Array:
    """(F, P) the distances of two bones each."""
    return bone_gaps(np.ascontiguousarray(poses), pairs)


@numba.njit(cache=True)
def bone_gaps(poses: Positions, pairs: Ints) -> Array:
    """(F, P) the least distances between bones, straight from one point to another, in poses (F, N, 3).

    Of two crossing lines' nearest points, and of each of the four ends from the other bone, whatever lies on both bones
    is nearest. ``pairs`` (P, 4) are the points of two bones each.

    Examples
    --------
    >>> crossing = np.array([[[-1.0, 0, 0], [1, 0, 0], [0, -1, 2], [0, 1, 2]]])
    >>> beside = np.array([[[0.0, 0, 0], [1, 0, 0], [4, 4, 0], [4, 9, 0]]])
    >>> bone_gaps(np.concatenate((crossing, beside)), np.array([[0, 1, 2, 3]])).tolist()
    [[2.0], [5.0]]
    """
    gaps = np.empty((len(poses), len(pairs)))
    u, v, w, apart = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for frame in range(len(poses)):
        for pair in range(len(pairs)):
            a, b = poses[frame, pairs[pair, 0]], poses[frame, pairs[pair, 1]]
            c, d = poses[frame, pairs[pair, 2]], poses[frame, pairs[pair, 3]]
            u[:], v[:], w[:] = b - a, d - c, a - c
            uu, vv, uv, uw, vw = _dot(u, u), _dot(v, v), _dot(u, v), _dot(u, w), _dot(v, w)
            square = uu * vv - uv * uv
            nearest = min(min(_off(a, c, v), _off(b, c, v)), min(_off(c, a, u), _off(d, a, u)))
            if square > 1e-12 * uu * vv:
                s, t = (uv * vw - vv * uw) / square, (uu * vw - uv * uw) / square
                if 0.0 <= s <= 1.0 and 0.0 <= t <= 1.0:
                    apart[:] = w + s * u - t * v
                    nearest = min(nearest, np.sqrt(_dot(apart, apart)))
            gaps[frame, pair] = nearest
    return gaps


@numba.njit(cache=True)
def _dot(a: Positions, b: Positions) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@numba.njit(cache=True)
def _off(point: Positions, start: Positions, along: Positions) -> float:
    """How far a point is from a bone."""
    x, y, z = point[0] - start[0], point[1] - start[1], point[2] - start[2]
    share = (x * along[0] + y * along[1] + z * along[2]) / max(_dot(along, along), 1e-300)
    share = min(max(share, 0.0), 1.0)
    return np.sqrt((x - share * along[0]) ** 2 + (y - share * along[1]) ** 2 + (z - share * along[2]) ** 2)
