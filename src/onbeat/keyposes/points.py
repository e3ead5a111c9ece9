"""The points of a body whose energy is looked at: joints or markers, with the body-centre frame and weights."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numba
import numpy as np

from onbeat._shapes import Array, Bools, Ints, Positions, Rotations
from onbeat.capture import SITES, find_sites, marker_body_frames
from onbeat.errors import BodyError
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body, body_frames
from onbeat.motion.markers import Markers
from onbeat.motion.motion import Motion

WEIGHTS = ("uniform", "mass")
"""Every point counts alike (the default), or by the mass of the body around it."""
# Shares of the body's mass (Winter, Biomechanics and Motor Control of Human Movement, table 4.1); the trunk's .497
# parted into abdomen and pelvis .281 and thorax .216.
_MASS: Mapping[str, float] = {
    "Hips": 0.142,
    "Spine": 0.139,
    "Chest": 0.216,
    "Head": 0.081,
    "Arm": 0.028,
    "ForeArm": 0.016,
    "Hand": 0.006,
    "UpLeg": 0.100,
    "Leg": 0.0465,
    "Foot": 0.0145,
}
# The joints between which each segment's mass lies, half at each.
_ENDS: Mapping[str, tuple[str, ...]] = {
    "Hips": ("hips",),
    "Spine": ("spine", "hips"),
    "Chest": ("chest", "neck"),
    "Head": ("head",),
    "Arm": ("shoulder", "elbow"),
    "ForeArm": ("elbow", "wrist"),
    "Hand": ("hand", "wrist"),
    "UpLeg": ("hip", "knee"),
    "Leg": ("knee", "ankle"),
    "Foot": ("toe", "ankle"),
}
_SIDES = ("left", "right")
_CENTRE = ("Hips", "Spine", "Chest", "Head")
ENOUGH = 12
"""Markers on known places, from which on others are left out."""
LONGEST_GAP = 0.5
"""Seconds a marker may be unseen and still count, on a straight line between where it was seen."""


@dataclass(frozen=True)
class Points:
    """Points on a moving body.

    Parameters
    ----------
    names : N joints' roles or markers' labels.
    positions : (F, N, 3) metres in the world, never NaN.
    seen : (F, N) whether a point counts at a frame.
    frames, origins : (F, 4) wxyz and (F, 3) metres, the body-centre frame.
    weights : (N,) how much each point counts; they add up to 1.
    hands, feet : which points end the arms and the legs.
    fps : frames per second.
    centred : whether the body-centre frame is known.
    """

    names: tuple[str, ...]
    positions: Positions
    seen: Bools
    frames: Rotations
    origins: Positions
    weights: Array
    hands: Ints
    feet: Ints
    fps: float
    centred: bool = True

    def local(self, which: Ints | slice = slice(None)) -> Positions:
        """Some of the points (F, K, 3) in the body-centre frame, metres."""
        return np.matmul(self.positions[:, which] - self.origins[:, None], rot.to_matrix(self.frames))


def body_points(source: Motion | Markers, weights: str = "uniform", local: bool = True) -> Points:
    """The points of a motion or of markers.

    Of a motion all joints that play a role, so that fingers and a skirt's bones do not outvote the body; of markers
    those that are ever seen: where ``ENOUGH`` of them sit on known places only these, as files hold computed points,
    too. Without ``local`` the body-centre frame is not looked for: markers need no known labels then.

    Raises
    ------
    BodyError
        If the body-centre frame cannot be found, or ``weights`` is unknown.
    """
    if weights not in WEIGHTS:
        raise BodyError(f"no weights {weights!r}; there are {' and '.join(WEIGHTS)}")
    return _of_markers(source, weights, local) if isinstance(source, Markers) else _of_motion(source, weights)


def _of_motion(motion: Motion, weights: str) -> Points:
    body = Body.of(motion.skeleton)
    roles = tuple(body.joints)
    positions = motion.positions[:, body.indices(*roles)]
    frames, origins = body_frames(motion, body)
    shares = role_masses(roles) if weights == "mass" else np.full(len(roles), 1.0 / len(roles))
    hands, feet = (np.array([roles.index(f"{side}_{part}") for side in _SIDES]) for part in ("wrist", "ankle"))
    seen = np.ones(positions.shape[:2], np.bool_)
    return Points(roles, positions, seen, frames, origins, shares, hands, feet, motion.fps)


def _of_markers(markers: Markers, weights: str, local: bool) -> Points:
    sites = find_sites(markers.names)
    segment = {label: SITES[site].segment for site, labels in sites.items() for label in labels}
    ever: Bools = np.asarray(markers.seen.any(axis=0))
    known: Bools = ever & np.array([name in segment for name in markers.names])
    ever = known if known.sum() >= ENOUGH else ever
    names = tuple(name for name, is_seen in zip(markers.names, ever, strict=True) if is_seen)
    frames, origins = marker_body_frames(markers) if local else _at_rest(len(markers))
    positions = markers.positions if ever.all() else markers.positions[:, ever]
    positions, counted = bridged(positions, markers.fps)
    shares = marker_masses(names, segment) if weights == "mass" else np.full(len(names), 1.0 / len(names))
    hands, feet = (
        np.array([k for k, name in enumerate(names) if segment.get(name, "").endswith(part)], np.int64)
        for part in ("Hand", "Foot")
    )
    return Points(names, positions, counted, frames, origins, shares, hands, feet, markers.fps, local)


def _at_rest(count: int) -> tuple[Rotations, Positions]:
    return np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)), np.zeros((count, 3))


def bridged(positions: Positions, fps: float) -> tuple[Positions, Bools]:
    """Paths (F, N, 3) without holes, and where (F, N) they may be believed.

    Holes are crossed on a straight line; those longer than ``LONGEST_GAP`` seconds, and before the first and after the
    last sight, are not counted.
    """
    whole = np.array(positions)
    return whole, _cross(whole, LONGEST_GAP * fps + 1.0)


@numba.njit(cache=True)
def _cross(positions: Positions, longest: float) -> Bools:
    """Cross the holes in place; where (F, N) points are seen or their holes are short."""
    frames, points = positions.shape[:2]
    counted = np.ones((frames, points), np.bool_)
    last = np.full(points, -1)  # frame at which each point was last seen
    for frame in range(frames):
        for point in range(points):
            if np.isfinite(positions[frame, point]).all():
                before, gap = last[point], frame - last[point]
                for hole in range(before + 1, frame):
                    part = (hole - before) / gap if before >= 0 else 1.0
                    for axis in range(3):
                        start = positions[before, point, axis] if before >= 0 else 0.0
                        end = positions[frame, point, axis]
                        positions[hole, point, axis] = start + part * (end - start) if before >= 0 else end
                    counted[hole, point] = before >= 0 and gap <= longest
                last[point] = frame
    for point in range(points):
        for hole in range(last[point] + 1, frames):
            positions[hole, point] = positions[max(last[point], 0), point]
            counted[hole, point] = False
    return counted


def role_masses(roles: tuple[str, ...]) -> Array:
    """Shares of the body's mass (N,) at joints with these roles; where a segment's end has no joint the other bears it.

    Examples
    --------
    >>> role_masses(("hips", "chest")).round(2).tolist()
    [0.57, 0.43]
    """
    shares = np.zeros(len(roles))
    for segment, mass in _MASS.items():
        for side in ("",) if segment in _CENTRE else ("left_", "right_"):
            ends = [roles.index(side + end) for end in _ENDS[segment] if side + end in roles]
            if ends:
                shares[ends] += mass / len(ends)
    return shares / shares.sum()


def marker_masses(names: tuple[str, ...], segment: Mapping[str, str]) -> Array:
    """Shares of the body's mass (N,) at markers; those of one segment bear it together, unknown ones bear none."""
    kinds = [segment.get(name, "") for name in names]
    mass = [_MASS.get(kind.removeprefix("Left").removeprefix("Right"), 0.0) for kind in kinds]
    shares = np.array([m / kinds.count(kind) for m, kind in zip(mass, kinds, strict=True)])
    if not shares.any():
        raise BodyError(f"no marker of {', '.join(names)} is known to sit on a bone; use weights='uniform'")
    return shares / shares.sum()
