"""Whether the feet of a dance stand when they stand.

People notice at once a foot that bears weight and slides, a leg pulled straight to reach its place, and a foot that
snaps. The dance is measured inside the windows around its joins, elsewhere, and against its source clips: dancers do
slide and pivot, so only the surplus is a fault.

Conventions
-----------
``contacts`` are (F, 2) booleans, true where the left or right foot bears on the floor (:mod:`onbeat.motion.contacts`);
this module does not guess them. Give a dance the contacts of the frames it is made of, where they are known: contacts
found on the dance itself leave out a foot that slides too fast to be taken for standing. The floor is level. Speeds are
over ``SPAN`` seconds before and after each frame, so that the rate of frames changes nothing; accelerations are read as
in :mod:`onbeat.metrics.smoothness`.

Metrics
-------
* :func:`contact_speeds` : skate, the full tangential speed of a foot in contact, both horizontal components. A foot
  that rolls over its ball or turns on its heel does not skate: the slower one of ankle and toe counts.
* :func:`support_speeds` : the floor speed of the slower foot, whoever says what is a contact. Mostly one foot stands,
  so a body that slides as a whole cannot hide by not calling it contact.
* :func:`leg_extensions` : hip to ankle over the length of thigh and shin. Above 1 a leg is torn, at 1 it is straight:
  a leg that cannot reach its place shows as one of them.
* :func:`foot_accelerations` : of ankles and toes in m/s², in contact or not: feet that are put right too fast.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from onbeat._shapes import Array, Bools, Times
from onbeat.errors import MetricError
from onbeat.metrics.smoothness import derivative
from onbeat.metrics.windows import WINDOW, near_joins, ratio, statistic
from onbeat.motion.body import Body, chain_length
from onbeat.motion.motion import Motion

SPAN = 1 / 30
"""Seconds before and after a frame over which a foot's speed is read."""
STRAIGHT = 0.999
"""A leg longer than this part of its full length is straight."""
_SIDES = ("left", "right")


def validate(motion: Motion, contacts: Bools) -> None:
    """Raise a ``MetricError`` unless contacts are booleans (F, 2) of the motion's frames."""
    if contacts.shape != (len(motion), 2) or contacts.dtype != np.bool_:
        raise MetricError(
            f"contacts are {contacts.dtype} of shape {contacts.shape}; bool of shape ({len(motion)}, 2), one column "
            "a foot, is needed"
        )


def contact_speeds(motion: Motion, contacts: Bools, body: Body | None = None) -> Array:
    """(F, 2) m/s along the floor of the left and right foot, the slower of ankle and toe; nan where not in contact."""
    validate(motion, contacts)
    body = Body.of(motion.skeleton) if body is None else body
    return np.where(contacts, _feet_speeds(motion, body), np.nan)


def support_speeds(motion: Motion, body: Body | None = None) -> Array:
    """(F,) m/s along the floor of the slower foot, the slower of ankle and toe, in contact or not."""
    return _feet_speeds(motion, Body.of(motion.skeleton) if body is None else body).min(axis=1)


def _feet_speeds(motion: Motion, body: Body) -> Array:
    return np.stack([_floor_speeds(motion, _foot_joints(body, side)).min(axis=1) for side in _SIDES], axis=1)


def _floor_speeds(motion: Motion, joints: list[int]) -> Array:
    """(F, len(joints)) m/s along the floor, over ``SPAN`` seconds either way as far as the motion goes."""
    if len(motion) < 2:
        return np.zeros((len(motion), len(joints)))
    before = np.maximum(motion.times - SPAN, 0.0)
    after = np.minimum(motion.times + SPAN, motion.times[-1])
    ways = [
        np.hypot(*(np.interp(after, motion.times, path) - np.interp(before, motion.times, path) for path in paths))
        for paths in motion.positions[:, joints, :2].transpose(1, 2, 0)
    ]
    return np.stack(ways, axis=1) / (after - before)[:, None]


def _foot_joints(body: Body, side: str) -> list[int]:
    return [body[f"{side}_{role}"] for role in ("ankle", "toe") if f"{side}_{role}" in body]


def leg_extensions(motion: Motion, body: Body | None = None) -> Array:
    """(F, 2) distance from hip to ankle over the leg's length, left and right; 1 is straight, above 1 torn."""
    body = Body.of(motion.skeleton) if body is None else body
    extensions: list[Array] = []
    for side in _SIDES:
        hip, ankle = body[f"{side}_hip"], body[f"{side}_ankle"]
        reach = np.linalg.norm(motion.positions[:, ankle] - motion.positions[:, hip], axis=-1)
        extensions.append(reach / max(chain_length(body.skeleton, hip, ankle), 1e-9))
    return np.stack(extensions, axis=1)


def foot_accelerations(motion: Motion, body: Body | None = None) -> tuple[Times, Array]:
    """Seconds (N,) and the acceleration (N, joints) in m/s² of ankles and, where the body has them, toes."""
    body = Body.of(motion.skeleton) if body is None else body
    joints = [joint for side in _SIDES for joint in _foot_joints(body, side)]
    return derivative(motion.positions[:, joints], motion.fps, 2)


def evaluate(
    motion: Motion,
    contacts: Bools,
    joins: Array,
    source: Sequence[tuple[Motion, Bools]] = (),
    window: float = WINDOW,
) -> dict[str, float | None]:
    """Skate, extension and acceleration of the feet inside the windows around joins, elsewhere and in the source.

    Parameters
    ----------
    motion : the dance.
    contacts : (F, 2) where its feet bear on the floor.
    joins : (K,) seconds of its joins, or (K, 2) windows; none means all of it is elsewhere.
    source : the clips it is made of with their contacts, or the stretches of them that it shows.
    window : seconds either side of a join.

    Returns
    -------
    For each place ``joins``, ``elsewhere`` and ``source``: ``skate_<place>`` and ``skate_<place>_p95`` (median and 95th
    percentile, m/s), ``support_<place>`` (mean, m/s) and ``acceleration_<place>`` (mean, m/s²). ``skate_ratio``,
    ``skate_p95_ratio``, ``support_ratio`` and ``acceleration_ratio``: joins over source, or over elsewhere where no
    source is given. ``extension_max``, ``extension_source_max``, ``over_reach_m`` (metres beyond the leg),
    ``straight_part`` and ``straight_source_part`` (of all leg-frames). None where there is nothing to measure.
    """
    speeds, support = contact_speeds(motion, contacts), support_speeds(motion)
    inside = near_joins(motion.times, joins, window)
    times, accelerations = foot_accelerations(motion)
    jolts = near_joins(times, joins, window)
    places = {
        "joins": (speeds[inside], support[inside], accelerations[jolts]),
        "elsewhere": (speeds[~inside], support[~inside], accelerations[~jolts]),
        "source": (
            _pool([contact_speeds(clip, touching) for clip, touching in source]),
            _pool([support_speeds(clip) for clip, _ in source]),
            _pool([foot_accelerations(clip)[1] for clip, _ in source]),
        ),
    }
    result: dict[str, float | None] = {}
    for place, (skate, slower, acceleration) in places.items():
        result[f"skate_{place}"] = statistic(skate, "median")
        result[f"skate_{place}_p95"] = statistic(skate, "p95")
        result[f"support_{place}"] = statistic(slower, "mean")
        result[f"acceleration_{place}"] = statistic(acceleration, "mean")
    against = "source" if source else "elsewhere"
    for name, suffix in (("skate", ""), ("skate", "_p95"), ("support", ""), ("acceleration", "")):
        joined, other = result[f"{name}_joins{suffix}"], result[f"{name}_{against}{suffix}"]
        result[f"{name}{suffix}_ratio"] = ratio(joined, other)
    return result | _reach(motion, [clip for clip, _ in source])


def _pool(arrays: list[Array]) -> Array:
    return np.concatenate([a.ravel() for a in arrays]) if arrays else np.zeros(0)


def _reach(motion: Motion, source: Sequence[Motion]) -> dict[str, float | None]:
    body = Body.of(motion.skeleton)
    extension = leg_extensions(motion, body)
    original = _pool([leg_extensions(clip) for clip in source])
    return {
        "extension_max": float(extension.max()),
        "extension_source_max": statistic(original, "max"),
        "over_reach_m": max(float(extension.max()) - 1.0, 0.0) * body.leg_length,
        "straight_part": float((extension > STRAIGHT).mean()),
        "straight_source_part": float((original > STRAIGHT).mean()) if original.size else None,
    }
