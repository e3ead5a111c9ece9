"""When each foot rests in a dance, and where it has to take a small step to get from one clip to the next."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Ints, Positions, Times
from onbeat.dance.blend import Windows

FARTHEST = 0.12
"""Metres: feet of the two clips of a join that rest farther apart than this do not meet; the foot steps across."""
PARTED = 0.5
"""Part of a window in whose middle a foot is in the air if it cannot rest through the join."""
LIFT, HIGHEST = 0.3, 0.05
"""A step is lifted by this part of its length, up to so many metres."""


@dataclass(frozen=True)
class Steps:
    """Contacts and steps of F frames.

    Parameters
    ----------
    contacts : (F, 2) true where the left, right foot rests on the floor.
    lifts : (F, 2) metres by which the foot is lifted for a step that neither clip makes.
    """

    contacts: Bools
    lifts: Array


def steps_between(contacts: Bools, soles: Positions, moves: Ints, windows: Windows, times: Times) -> Steps:
    """The clips' contacts, less the middle of windows through which a foot cannot rest.

    It cannot where it rests on one side of the join only (it must have left the floor before, or come to it after, not
    at a stroke), or where the two clips rest it too far apart; then it is lifted across.

    Parameters
    ----------
    contacts : (F, 2) true where the left, right foot rests in the clip each frame shows.
    soles : (F, 2, 3) metres, where those clips have the feet.
    moves : (F,) the move each frame shows.
    windows : of the joins.
    times : (F,) seconds.
    """
    out, lifts = contacts.copy(), np.zeros(contacts.shape)
    for frame in (np.flatnonzero(np.diff(moves)) + 1).tolist():
        join = int(moves[frame - 1])
        part = (times - windows.centres[join]) / (PARTED * windows.spans[join])  # -0.5 to 0.5 inside
        near = np.abs(part) < 0.5
        apart = np.linalg.norm((soles[frame] - soles[frame - 1])[:, :2], axis=-1)
        both = contacts[frame - 1] & contacts[frame]
        across = both & (apart > FARTHEST)
        out[np.ix_(near, across | (contacts[frame - 1] != contacts[frame]))] = False
        rise = (1 - 4 * part[near] ** 2) ** 2
        lifts[np.ix_(near, across)] = rise[:, None] * np.minimum(LIFT * apart[across], HIGHEST)
    return Steps(out, lifts)
