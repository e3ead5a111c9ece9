"""The stages of a dance's job, and how long each takes beside the others."""

from __future__ import annotations

_DANCED = {"listening": 1.0, "moves": 1.0, "searching": 4.0, "dancing": 1.0, "warping": 1.0, "measuring": 1.0}
_FASTER = {"retiming": 3.0}
_ON_ROBOT = {"retarget": 6.0, "retime": 3.0, "legs": 1.0, "balance": 4.0}


def stages_of_dancing(robot: str | None, speed: float) -> dict[str, float]:
    """The stages in which a song is danced to: by a character, by none, at the song's speed or another.

    Examples
    --------
    >>> list(stages_of_dancing(None, 1.2))[-2:]
    ['measuring', 'retiming']
    """
    return _DANCED | (stages_of_again(robot) if made_again(robot, speed) else {})


def stages_of_again(robot: str | None) -> dict[str, float]:
    """The stages in which a dance is put in another time, or on a robot."""
    return _FASTER if robot is None else _ON_ROBOT


def made_again(robot: str | None, speed: float) -> bool:
    """Whether the character's dance at the song's own speed is only what another is made of."""
    return robot is not None or speed != 1.0
