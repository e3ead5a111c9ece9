"""Whether a dance can be made as it is ordered, before its job begins: each field, and why not."""

from __future__ import annotations

import math

from onbeat.studio.answers import FieldError
from onbeat.studio.studio import METHODS, ROBOTS, NotHereError, Studio
from onbeat.studio.wire import DanceItem, DanceOrder, KeptStretch, SongItem

SHORTEST, LONGEST = 1.0, 1200.0
"""Seconds of a dance; the longest as of ``onbeat.dance.make``."""
SPEEDS = (0.25, 4.0)
HEAVIEST = 4.0
"""Times that the intensity may weigh more than it does by itself."""
MOST_KEPT = 200


def check_order(studio: Studio, told: DanceOrder) -> None:
    """Refuse an order that cannot be, by a :class:`FieldError` that names the field."""
    song = _song(studio, told)
    _check_stretch(told, song)
    library = studio.folder.document.libraries.get(told.library)
    if library is None or library.state in ("failed", "cancelled"):
        raise FieldError("library", f"no library {told.library[:40]!r} that can be danced with")
    if told.method not in (method.name for method in METHODS):
        known = ", ".join(method.name for method in METHODS)
        raise FieldError("method", f"no method {told.method[:40]!r}; there are {known}")
    if not 0 <= told.seed < 2**63:
        raise FieldError("seed", f"seed {told.seed}: give a whole number from 0 to 2^63 - 1")
    if not 0 <= told.intensity_weight <= HEAVIEST:
        raise FieldError("intensity_weight", f"λ {told.intensity_weight:g}: give 0 to {HEAVIEST:g}; 1 is as usual")
    if told.robot is not None:
        check_robot(told.robot)
    check_speed(told.speed)
    if len(told.keep) > MOST_KEPT:
        raise FieldError("keep", f"{len(told.keep)} stretches to keep; up to {MOST_KEPT} are taken")
    for stretch in told.keep:
        _check_kept(studio, told, stretch)


def check_speed(speed: float) -> None:
    """Refuse a speed at which nobody dances."""
    if not SPEEDS[0] <= speed <= SPEEDS[1]:
        raise FieldError("speed", f"speed {speed:g}: give {SPEEDS[0]:g} to {SPEEDS[1]:g}; 1.2 is a fifth faster")


def check_robot(robot: str) -> None:
    """Refuse a robot that is not known."""
    if robot not in (known.name for known in ROBOTS):
        raise FieldError("robot", f"no robot {robot[:40]!r}; there are {', '.join(known.name for known in ROBOTS)}")


def _song(studio: Studio, told: DanceOrder) -> SongItem:
    song = studio.folder.document.songs.get(told.song)
    if song is None or song.state in ("failed", "cancelled"):
        raise FieldError("song", f"no song {told.song[:40]!r} that can be danced to")
    return song


def _check_stretch(told: DanceOrder, song: SongItem) -> None:
    """The stretch has to lie in the song, where its length is known already."""
    length = song.duration if song.state == "ready" else math.inf
    told_length = "" if math.isinf(length) else f", which lasts {length:.1f} s"
    if not 0 <= told.start <= max(length - SHORTEST, 0.0):
        raise FieldError(
            "start", f"from {told.start:g} s: give a second of the song{told_length}, with {SHORTEST:g} s after it"
        )
    seconds = told.seconds if told.seconds is not None else length - told.start
    if not seconds >= SHORTEST:
        raise FieldError("seconds", f"{seconds:g} seconds: give {SHORTEST:g} or more")
    if LONGEST < seconds < math.inf:
        raise FieldError("seconds", f"{seconds / 60:.0f} minutes; a dance lasts at most {LONGEST / 60:.0f}")


def _check_kept(studio: Studio, told: DanceOrder, stretch: KeptStretch) -> None:
    """A stretch is kept of a dance to the same seconds of the same song, with the same library."""
    try:
        dance = studio.item("dances", stretch.dance, DanceItem)
    except NotHereError as error:
        raise FieldError("keep", str(error)) from None
    if dance.state != "ready":
        raise FieldError("keep", f"{dance.name} is not ready; keep stretches of a dance that is")
    if (dance.song, dance.start) != (told.song, told.start):
        raise FieldError(
            "keep", f"{dance.name} dances to another song or begins elsewhere; keep stretches of one that fits"
        )
    if dance.order.library != told.library:
        raise FieldError("keep", f"{dance.name} has other moves than those of {told.library}; choose its library")
    if not 0 <= stretch.from_s < stretch.to_s <= dance.seconds + 0.05:
        span = f"{stretch.from_s:g} to {stretch.to_s:g} s"
        raise FieldError("keep", f"{span} is no stretch of {dance.name}, which lasts {dance.seconds:.2f} s")
