"""The form of the embedded song: which sections, how many bars, and when each beat falls."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.errors import AudioError

LEAD = 0.35  # seconds of silence before the first beat
RING = 1.9  # seconds at least for the last chord to ring
_NAMES = ("intro", "verse", "chorus", "break", "chorus", "outro")
_FORMS = (  # bars of each of _NAMES, shortest song first
    (0, 0, 0, 0, 1, 0),
    (0, 0, 0, 0, 2, 1),
    (0, 0, 0, 0, 4, 1),
    (2, 0, 0, 0, 4, 1),
    (2, 4, 0, 0, 4, 1),
    (2, 4, 0, 2, 4, 1),
    (2, 8, 0, 2, 4, 1),
    (2, 8, 4, 2, 4, 1),
    (2, 8, 4, 2, 8, 1),
    (4, 8, 4, 2, 8, 1),
    (4, 8, 8, 2, 8, 1),
    (4, 8, 8, 4, 8, 2),
)
_INTENSITY = {"intro": 0.35, "verse": 0.6, "chorus": 0.9, "break": 0.2, "outro": 0.4}


class Section(NamedTuple):
    """A section of the song: its name, when it starts and ends [s], and how intense it is, 0…1."""

    name: str
    start: float
    end: float
    intensity: float


class Part(NamedTuple):
    """A section in bars: its name, its first bar, its number of bars, and how intense it is, 0…1."""

    name: str
    first: int
    bars: int
    intensity: float


def form(bars: int) -> tuple[Part, ...]:
    """Lay sections out over a number of bars: the largest known form that fits, the rest to outro and intro.

    Examples
    --------
    >>> [f"{part.name} {part.bars}" for part in form(25)]
    ['intro 2', 'verse 8', 'chorus 4', 'break 2', 'chorus 8', 'outro 1']
    """
    known = max((lengths for lengths in _FORMS if sum(lengths) <= bars), key=sum)
    spare = bars - sum(known)
    pairs, spare = divmod(spare, 16)  # long songs have more verses and choruses before the break
    known = list(known)
    for slot, more in ((4, 8), (3, 4), (5, 1)):  # then a longer last chorus, a longer break, a longer outro
        if spare >= more:
            known[slot] += more
            spare -= more
    known[0] += spare
    plan = [*zip(_NAMES[:3], known[:3], strict=True), *[("verse", 8), ("chorus", 8)] * pairs]
    plan += zip(_NAMES[3:], known[3:], strict=True)
    parts: list[Part] = []
    first = 0
    for index, (name, length) in enumerate(plan):
        intensity = 1.0 if index == len(plan) - 2 else _INTENSITY[name]
        if length or name == "outro":
            parts.append(Part(name, first, length, intensity))
        first += length
    return tuple(parts)


@dataclass(frozen=True, eq=False)
class Grid:
    """When each beat falls: the beats [s] up to and with the last chord's, and the meter."""

    beats: Times
    meter: int

    @property
    def bars(self) -> int:
        """Whole bars before the last chord."""
        return (len(self.beats) - 1) // self.meter

    def time(self, beat: float | Array) -> Array:
        """Seconds of a beat number, which may lie between beats; beyond the ends at the tempo there."""
        before, after = np.diff(self.beats)[[0, -1]]
        beats = np.concatenate([[self.beats[0] - before], self.beats, [self.beats[-1] + after * 8]])
        numbers = np.concatenate([[-1.0], np.arange(len(self.beats)), [len(self.beats) + 7.0]])
        return np.asarray(np.interp(beat, numbers, beats))


def lay_grid(seconds: float, tempo: float, meter: int, drift: float) -> Grid:
    """Fit whole bars into ``seconds``, the tempo drifting as ``tempo·(1 − drift·cos 2πu)``, u = 0…1 along the song.

    Raises
    ------
    AudioError
        If not even one bar and a last chord fit, or tempo, meter or drift are not those of a dance.
    """
    if not (40 <= tempo <= 240 and meter in (3, 4) and 0 <= drift <= 0.1):
        raise AudioError(
            f"tempo {tempo:g}, meter {meter}, drift {drift:g}: expected a tempo of 40 to 240 beats per minute, "
            "a meter of 3 or 4 and a drift of 0 to 0.1"
        )
    bars = int((seconds - LEAD - RING) / (meter * 60.0 / tempo)) if np.isfinite(seconds) else 0
    if bars < 1:
        least = np.ceil((LEAD + RING + meter * 60.0 / tempo) * 10.0) / 10.0
        raise AudioError(f"a song of {seconds:g} s is too short for one bar and an end; ask for {least:.1f} s or more")
    count = bars * meter
    along = (np.arange(count) + 0.5) / count
    lengths = 1.0 / (1.0 - drift * np.cos(2.0 * np.pi * along))
    lengths *= 60.0 / tempo / lengths.mean()
    return Grid(LEAD + np.concatenate([[0.0], np.cumsum(lengths)]), meter)


def sections(parts: tuple[Part, ...], grid: Grid, seconds: float) -> tuple[Section, ...]:
    """The sections in seconds; the first takes the silence before it, the last the ring after it."""
    starts = [0.0] + [float(grid.beats[part.first * grid.meter]) for part in parts[1:]]
    ends = [*starts[1:], seconds]
    return tuple(
        Section(part.name, start, end, part.intensity) for part, start, end in zip(parts, starts, ends, strict=True)
    )
