"""Where the floor is under a moving body, and putting the body on it."""

from __future__ import annotations

from onbeat.motion.body import Body
from onbeat.motion.motion import Motion
from onbeat.motion.retarget import feet_in_air, floor_height

UNDER, OVER = -0.03, 0.08
"""Metres between which the lowest joint of standing feet is on the floor: joints are above the sole by some of it."""
LYING = 0.2
"""Metres over the floor up to which the lowest joint of a body may be that lies, or stands on its hands."""
SOLE = 0.03
"""Metres of a foot's lowest joint above the sole, where a body has to be put on the floor."""


def is_on_floor(motion: Motion, body: Body | None = None) -> bool:
    """Whether the feet stand on z = 0, or the body lies on it whose feet never stand, as far as joints can tell."""
    return UNDER <= floor_height(motion, body) <= (LYING if feet_in_air(motion, body) else OVER)


def on_floor(motion: Motion, body: Body | None = None) -> Motion:
    """The motion with its floor at z = 0; unchanged where it stands there already.

    Joints of feet are above their soles, by how much no file tells: a motion that was captured on a floor at 0 is so
    left alone, and another is moved until the lowest joint of its standing feet is :data:`SOLE` above it.

    Raises
    ------
    BodyError
        If the body has no legs that are known.
    """
    if is_on_floor(motion, body):
        return motion
    return motion.replace(root_positions=motion.root_positions - [0.0, 0.0, floor_height(motion, body) - SOLE])
