"""The master as a ghost: danced at the pupil's pace, in the pupil's size, where the pupil is.

At each moment of the pupil's, the master is at the moment that is paired with it
(:func:`onbeat.recognition.pupil.pairing`), stands on the same ground below the pupil's hips and faces as the pupil
does. What then lies between both bodies is what the pupil does otherwise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array, Bools, Ints, Times, frozen
from onbeat.errors import MetricError
from onbeat.keyposes.vectors import PoseVectors, pose_vectors
from onbeat.motion import rotations as rot
from onbeat.motion.body import facing
from onbeat.motion.edit import scaled
from onbeat.motion.motion import Motion

_SMOOTHING = 1.5  # moments: pairs go by whole steps, and a body that goes so jerks
_FEET = ("left_ankle", "right_ankle", "left_toe", "right_toe")


@dataclass(frozen=True, eq=False)
class Beside:
    """A pupil's motion and the master's beside it, frame by frame.

    Parameters
    ----------
    pupil : F frames, from the first segment's start to the last one's end.
    master : F frames of the master's body, as large as the pupil's, where the pupil is.
    elements : E names of points that both have.
    joints : (E,) the pupil's joint that each element is.
    errors : (F, E) metres between both; NaN outside of all segments.
    starts : (S,) seconds of the pupil's motion at which segments begin.
    """

    pupil: Motion
    master: Motion
    elements: tuple[str, ...]
    joints: Ints
    errors: Array
    starts: Times

    def __post_init__(self) -> None:
        object.__setattr__(self, "errors", frozen(self.errors))
        object.__setattr__(self, "starts", frozen(self.starts))

    def joint_errors(self) -> Array:
        """(F, J) metres of every joint of the pupil's: its own, else that of the nearest element above it."""
        at = {int(joint): element for element, joint in reversed(list(enumerate(self.joints.tolist())))}
        nearest: list[int] = []
        for joint, parent in enumerate(self.pupil.skeleton.parents.tolist()):
            above = nearest[parent] if parent >= 0 else self.elements.index("hips")
            nearest.append(at.get(joint, above))
        return self.errors[:, nearest]


def beside(
    pupil: Motion,
    master: Motion,
    spans: Sequence[tuple[float, float]],
    master_spans: Sequence[tuple[float, float]],
    pairs: Array,
) -> Beside:
    """The master's motion beside the pupil's.

    Parameters
    ----------
    pupil, master : the motions.
    spans, master_spans : S pairs of seconds, the segments of each in the order of the pupil's time.
    pairs : (S, T) moments of the master's segments, see :func:`onbeat.recognition.pupil.pairing`.

    Raises
    ------
    MetricError
        If there is no segment, or they are not as many.
    BodyError
        If a body lacks a role that every body needs.
    """
    if not len(spans) or not len(spans) == len(master_spans) == len(pairs):
        raise MetricError(
            f"{len(spans)} segments, {len(master_spans)} of the master's and {len(pairs)} pairings; as many of each "
            "are needed, one at least"
        )
    first, last = min(a for a, _ in spans), max(b for _, b in spans)
    times = first + np.arange(max(2, int((last - first) * pupil.fps + 1e-6) + 1)) / pupil.fps
    shown = pupil.at(times)
    of, inside = _segment_of(times, spans)
    guide = master.at(_times_of_master(times, of, spans, master_spans, pairs)).replace(fps=pupil.fps)
    ghost, own = _placed(guide, shown)
    joints = dict(zip(own[1].points, own[1].joints.tolist(), strict=True))
    ends = shown.positions[:, own[0].joints], ghost.positions[:, [joints[name] for name in own[0].points]]
    errors = np.where(inside[:, None], np.linalg.norm(ends[0] - ends[1], axis=-1), np.nan)
    return Beside(shown, ghost, own[0].points, own[0].joints, errors, np.array([a for a, _ in spans]) - first)


def _segment_of(times: Times, spans: Sequence[tuple[float, float]]) -> tuple[Ints, Bools]:
    """(F,) the segment that each time belongs to, the last that has begun; and whether it is inside of it."""
    bounds = np.asarray(spans, np.float64)
    of = np.clip(np.searchsorted(bounds[:, 0], times + 1e-9, side="right") - 1, 0, len(bounds) - 1)
    return of, np.asarray(times <= bounds[of, 1] + 1e-9)


def _times_of_master(
    times: Times, of: Ints, spans: Sequence[tuple[float, float]], master: Sequence[tuple[float, float]], pairs: Array
) -> Times:
    """(F,) seconds of the master's motion, smooth inside each segment."""
    last = pairs.shape[1] - 1
    found = np.empty(len(times))
    for segment, ((start, end), (from_, to)) in enumerate(zip(spans, master, strict=True)):
        here = of == segment
        late = gaussian_filter1d(pairs[segment] - np.arange(last + 1), _SMOOTHING, mode="nearest")
        late[[0, -1]] = 0.0
        shares = np.clip((times[here] - start) / (end - start), 0.0, 1.0) * last
        found[here] = from_ + (shares + np.interp(shares, np.arange(last + 1), late)) / last * (to - from_)
    return found


def _placed(guide: Motion, shown: Motion) -> tuple[Motion, list[PoseVectors]]:
    """The guide in the other's size, on its ground, below its hips and facing as it does; and both as vectors."""
    sizes = [one.size for one in pose_vectors([shown, guide])]
    guide = scaled(guide, sizes[0] / sizes[1])
    own = pose_vectors([shown, guide])
    yaw = rot.yaw(facing(own[0].frames) - facing(own[1].frames))
    ground = [_ground(motion, vectors) for motion, vectors in zip((shown, guide), own, strict=True)]
    away = guide.root_positions - own[1].origins
    root = own[0].origins + rot.rotate(yaw, away)
    root[:, 2] = guide.root_positions[:, 2] - ground[1] + ground[0]
    rotations = guide.rotations.copy()
    rotations[:, 0] = rot.continuous(rot.normalise(rot.multiply(yaw, rotations[:, 0])))
    return guide.replace(rotations=rotations, root_positions=root), own


def _ground(motion: Motion, own: PoseVectors) -> float:
    """Metres, the lowest that the feet are."""
    feet = [joint for name, joint in zip(own.points, own.joints.tolist(), strict=True) if name in _FEET]
    return float(motion.positions[:, feet, 2].min())
