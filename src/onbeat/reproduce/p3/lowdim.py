"""Dances in few dimensions (keyposes 2009, Sec. 4): both spaces, judged, and what the paper says of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Times
from onbeat.keyposes.held_out import Taught
from onbeat.keyposes.judging import SPACES
from onbeat.keyposes.lowdim import LowDimensional
from onbeat.keyposes.space import KeyposeSpace, uniform_times
from onbeat.keyposes.unnatural import Unnatural
from onbeat.reproduce.p3.people import DIMS
from onbeat.reproduce.result import Claim

PHASES = (0.0, 0.25, 0.5, 0.75)
"""Of uniform sampling: any one may by chance hit the keyposes."""


@dataclass(frozen=True, eq=False)
class Spaces:
    """Some people's dance in both spaces, and how unnatural each motion is in them, as it plays.

    Parameters
    ----------
    found : the spaces.
    unnatural : by space, of each motion.
    numbered : whether keyposes of one number are the same pose of the dance, whoever dances.
    """

    found: LowDimensional
    unnatural: Mapping[str, tuple[Unnatural, ...]]
    numbered: bool = True

    @classmethod
    def of(cls, found: LowDimensional, *, numbered: bool = True) -> Spaces:
        """Judge every motion in both spaces."""
        return cls(
            found,
            {
                space: tuple(found.unnatural(which, space, played=True) for which in range(len(found.motions)))
                for space in SPACES
            },
            numbered,
        )

    def worst(self, kind: str, ours: str = "keyposes", theirs: str = "uniform") -> tuple[int, int] | None:
        """Motion and frame at which one space is most unnatural in a way, and the other not at all; None if nowhere."""
        best, at = 0.0, None
        for which, (mine, other) in enumerate(zip(self.unnatural[ours], self.unnatural[theirs], strict=True)):
            amount = np.where(mine.postures, 0.0, getattr(other, kind))
            frame = int(amount.argmax())
            if amount[frame] > best:
                best, at = float(amount[frame]), (which, frame)
        return at

    def share(self, space: str, kind: str) -> float:
        """Share of all frames that are unnatural in a way: "through", "beyond"."""
        return float(np.mean(np.concatenate([getattr(one, kind) for one in self.unnatural[space]]) > 0))

    def alone(self, ours: str, theirs: str) -> float:
        """Share of the frames in which only the second of two spaces makes an unnatural posture."""
        pairs = zip(self.unnatural[ours], self.unnatural[theirs], strict=True)
        return float(np.mean(np.concatenate([other.postures & ~mine.postures for mine, other in pairs])))


def grouped(found: LowDimensional, space: str, phase: float = 0.0) -> float:
    """The share of the poses' spread in three dimensions that lies between their numbers in the cycle (η²).

    1 where all people's poses of a number are one point, near 0 where numbers tell nothing.
    """
    least = min(len(one.keyposes) for one in found.taught)
    poses = [one.vectors.at(_times(one, space, phase))[:least] for one in found.taught]
    made = found.spaces[space] if not phase else KeyposeSpace.of(np.concatenate(poses))
    places = np.array([made.project(own, DIMS) for own in poses])  # (people, numbers, 3)
    centre = places.mean(axis=(0, 1))
    return float(np.square(places.mean(axis=0) - centre).sum() * len(places) / np.square(places - centre).sum())


def _times(one: Taught, space: str, phase: float) -> Times:
    return one.keyposes if space == "keyposes" else uniform_times(one.start, one.end, len(one.keyposes), phase)


POINT = 0.01
"""By how much one share of the variance has to be larger to be called so."""
ALIKE = (
    " People who dance one choreography to one beat are in nearly the same pose at any moment of it, so that any "
    "moments group them."
)


def lowdim_claims(spaces: Spaces) -> tuple[Claim, ...]:
    """What the paper says of both spaces, and whether it holds."""
    found = spaces.found
    ours, theirs = (found.spaces[space].cumulative[found.dims - 1] for space in SPACES)
    uniform = float(np.mean([grouped(found, "uniform", phase) for phase in PHASES]))
    keyposes = grouped(found, "keyposes")
    alone = spaces.alone("keyposes", "uniform"), spaces.alone("uniform", "keyposes")
    rebuilt = found.frames.ratio[:, found.dims - 1]
    grouping = keyposes > uniform + 0.05
    return (
        Claim(
            "Keyposes of several people lie in groups by their number, poses of uniform sampling do not.",
            grouping if spaces.numbered else None,
            f"{keyposes:.1%} of the spread is between the numbers for keyposes, {uniform:.1%} for uniform sampling."
            + (ALIKE if spaces.numbered and not grouping else "")
            + ("" if spaces.numbered else " Whether these numbers mean the same poses is not known."),
            ("Figs. 7 and 8",),
        ),
        Claim(
            "In three dimensions keyposes have more of the variance than uniform sampling.",
            bool(ours > theirs + POINT),
            f"{ours:.1%} and {theirs:.1%}, each of its own poses.",
            ("Fig. 11",),
        ),
        Claim(
            "Motions by keyposes keep more of the dance than those by uniform sampling.",
            bool((rebuilt < 0.98).all()),
            f"Their error on unseen frames is {rebuilt[0]:.2f} times uniform sampling's over all frames, "
            f"{rebuilt[1]:.2f} times at rest, {rebuilt[2]:.2f} times on keyposes. Of all frames those taken at equal "
            "distances are the fairer sample.",
            ("Sec. 4.3, errors",),
        ),
        Claim(
            "Uniform sampling makes unnatural postures where keyposes do not.",
            alone[0] > alone[1],
            f"In {alone[0]:.1%} of the frames; the other way round in {alone[1]:.1%}.",
            ("Sec. 4.3, postures",),
        ),
    )
