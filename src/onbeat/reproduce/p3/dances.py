"""The dances in which keyposes are looked for: five of the embedded troupe, as many keyposes each as the paper's five.

The troupe's choreography says on which beats it rests, as the dance masters' books do. What is danced is rehearsed: the
dancer comes early or late to every keypose, and the capture is noisy. Real dances are files beside which their keyposes
are marked.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from onbeat._shapes import Ints, Times, frozen
from onbeat.examples.choreography import LEAD
from onbeat.examples.dancers import DANCERS, Dancer
from onbeat.examples.dances import DANCES, perform_dance
from onbeat.examples.performer import Performance, perform
from onbeat.examples.rehearsal import rehearse
from onbeat.examples.repertoire import ARM_CIRCLES, HIP_CIRCLES, TURN
from onbeat.keyposes.extract import beats_inside
from onbeat.keyposes.marks import read_marks
from onbeat.motion import Motion
from onbeat.music import listen
from onbeat.music.beat_files import read_beats
from onbeat.reproduce.data import Data

CYCLES = 3
"""Of each dance; the paper has "several dancing cycles"."""
JITTER = 0.06
"""Seconds by which a keypose is early or late at most."""
MILL_DANCE = (HIP_CIRCLES, TURN, ARM_CIRCLES)
"""Another dance of ten keyposes, for the paper has two; sixteen beats."""
BESIDE = {"folk dance": "Aizu-bandaisan", "harvest dance": "Jongara", "river dance": "Theodori",
          "mill dance": "Sasara", "festival dance": "Donpan"}  # fmt: skip
"""Which of the paper's dances each of ours stands beside: that of as many keyposes."""
MARKS, SOUNDS = ".keyposes.csv", (".wav", ".flac", ".ogg", ".mp3")
"""What lies beside a real dance: its keyposes' seconds, and ``.beats`` or a song."""


@dataclass(frozen=True, eq=False)
class Danced:
    """A dance by somebody, of which it is known where its keyposes are.

    Parameters
    ----------
    dance, person : their names.
    motion : what is danced.
    beats : (B,) seconds.
    truth : (K,) seconds of the keyposes.
    first, end : the beats from which on and before which it is danced; before and after the dancer stands.
    cycle : beats after which it repeats.
    """

    dance: str
    person: str
    motion: Motion
    beats: Times
    truth: Times
    first: int
    end: int
    cycle: int

    def __post_init__(self) -> None:
        for name in ("beats", "truth"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @cached_property
    def true_beats(self) -> Ints:
        """(K,) the beat of each keypose, the nearest one."""
        return np.abs(self.truth[:, None] - self.beats[None]).argmin(axis=1)

    @property
    def cycles(self) -> list[tuple[int, int]]:
        """From which beat to before which each whole cycle is."""
        return [(at, at + self.cycle) for at in range(self.first, self.end - self.cycle + 1, self.cycle)]


def embedded_dances(
    seed: int, dancers: Sequence[Dancer] = DANCERS, cycles: int = CYCLES, names: Sequence[str] = tuple(BESIDE)
) -> list[Danced]:
    """Every dance by every dancer, rehearsed; the same seed gives the same.

    Examples
    --------
    >>> one = embedded_dances(0, DANCERS[:1], 1)
    >>> [(each.dance, len(each.truth)) for each in one][-2:], one[0].cycles, one[0].true_beats.tolist()
    ([('mill dance', 10), ('festival dance', 33)], [(2, 14)], [2, 3, 4, 6, 7, 8, 10, 12])
    """
    rng = np.random.default_rng(seed)
    return [
        _danced(dance, rehearse(_performed(dancer, dance, cycles, rng), rng, JITTER), cycles)
        for dance in names
        for dancer in dancers
    ]


def _performed(dancer: Dancer, dance: str, cycles: int, rng: np.random.Generator) -> Performance:
    if dance in DANCES:
        return perform_dance(dancer, dance, 1.0, cycles, rng)
    return replace(perform(dancer, MILL_DANCE * cycles, 1.0, 1, rng), task=dance)


def _danced(dance: str, clip: Performance, cycles: int) -> Danced:
    length = sum(figure.beats for figure in DANCES.get(dance, MILL_DANCE))
    first = int(LEAD)
    end = first + cycles * length
    return Danced(dance, clip.person, clip.motion, clip.beats, clip.keyposes, first, end, length)


def marked_dances(data: Data) -> list[Danced]:
    """Those of the given files beside which keyposes are marked (``NAME.keyposes.csv``) and beats or a song lie."""
    found: list[Danced] = []
    for path in data.motion_files():
        marks, beats = path.with_name(path.stem + MARKS), beats_beside(path)
        if marks.is_file() and beats is not None:
            motion = data.motion(path)
            truth = read_marks(marks, (len(motion) - 1) / motion.fps)
            inside = beats_inside(beats, motion)
            at = np.abs(truth[:, None] - inside[None]).argmin(axis=1)
            first, end = int(at.min()), int(at.max()) + 1
            found.append(Danced(path.stem, path.stem, motion, inside, truth, first, end, end - first))
    return found


def beats_beside(path: Path) -> Times | None:
    """The beats of a motion file: ``NAME.beats``, or heard in a song beside it; None where there is neither."""
    told = path.with_suffix(".beats")
    if told.is_file():
        return read_beats(told).times
    song = next((found for ending in SOUNDS if (found := path.with_suffix(ending)).is_file()), None)
    return None if song is None else listen(song).beats
