"""P3: keyposes, how they are found, a few dimensions of them, and who dances what (2009), done again."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace

from onbeat.errors import OnbeatError
from onbeat.examples.dancers import DANCERS
from onbeat.keyposes.candidates import Thresholds
from onbeat.keyposes.extract import Keyposes, Reading
from onbeat.keyposes.lowdim import LowDimensional, people_told
from onbeat.reproduce.data import Data
from onbeat.reproduce.p3.dances import Danced, embedded_dances, marked_dances
from onbeat.reproduce.p3.energy_figures import figure_3, figure_6, roughness, weight_claim
from onbeat.reproduce.p3.extraction import LEARNED, extract, extraction_claims, table_1
from onbeat.reproduce.p3.files import UntoldWarning, one_dance, segments_in, takes_of, untold
from onbeat.reproduce.p3.lowdim import Spaces, lowdim_claims
from onbeat.reproduce.p3.lowdim_parts import lowdim_parts
from onbeat.reproduce.p3.people import of_dances, of_takes
from onbeat.reproduce.p3.recognition import DRAWS, known_in_files, recognised, recognition_claims, recognition_tables
from onbeat.reproduce.p3.thresholds import globally_learned, swept, threshold_claims, threshold_figure
from onbeat.reproduce.paper import Step
from onbeat.reproduce.result import Claim, PaperResult, Part
from onbeat.reproduce.study.plans import PAGE, SEQUENCES, study_page
from onbeat.reproduce.study.table import study_table

CITATION = (
    "The University of Tokyo, IPSJ SIG Technical Report, Vol. 2009-CVIM-167, No. 2, 9 June 2009 (the title is in our "
    "words)"
)
QUICK = 4
"""Dancers of a first look."""
PAPER_DATA = (
    "Five Japanese folk dances, of Aizu-bandaisan several cycles by eight people (five women, three men), captured at "
    "120 frames a second; beats estimated from the music; keyposes by the dance masters' books. 34 visitors of an open "
    "campus were asked what looks right."
)
MADE = (
    "The dances are made, not captured: a motor model dances a choreography by eight bodies and styles. It rests in "
    "its keyposes because it is told to, so that they are easier to find than a person's.",
    "The beats are those it was danced to, not estimated ones. Keyposes come up to 60 ms early or late, and every "
    "frame is noisy, as in rehearsal.",
    "Our own energy, its thresholds and our recogniser were developed with this troupe at hand; the method as "
    "published was not. On recorded dances all do worse: see docs/keyposes.md.",
    "The paper does not tell its smoothing, nor the units of T1 and T2; here they are an eighth of a beat, and the "
    "mean energy.",
    "Figs. 1, 2 and 15 are drawings of the method without results, and are not drawn again; Fig. 12, a picture of what "
    "people were asked, is the page study.html. How long a probe took (70 and 40 s) tells of machines and is left out.",
    "Of each dancer's cycles the middle one is taken for few dimensions, not one drawn by chance; keyposes are those "
    "found, as in the paper.",
    "How unlike one cycle of a dancer is to the next decides how well dancers are told apart (Tables 3 to 5), and is "
    "not known of the paper's people. It is a number here, “unlike themselves”: from 0, where all cycles of a dancer "
    "are alike, to 1, where they differ as one dancer does from another. “Learned” is onbeat's own recogniser.",
)


@dataclass(frozen=True, eq=False)
class Made:
    """What comes out of one section of the paper."""

    parts: tuple[Part, ...]
    claims: tuple[Claim, ...]
    files: tuple[tuple[str, bytes], ...] = ()


class Keyposes2009:
    """The paper of 2009; see :class:`onbeat.reproduce.paper.Paper`."""

    key = "P3"
    title = "Keyposes in human motion: how to find them, what they are good for, and who dances them"

    def reproduce(self, data: Data, step: Step) -> PaperResult:
        """All tables and figures, of the embedded troupe or of files of one's own.

        Raises
        ------
        OnbeatError
            If songs are given, of which nothing is heard here, or the files do not suit.
        """
        if data.songs:
            raise OnbeatError(
                f"P3 hears no songs: leave out {data.songs[0]}; beats lie beside a motion, NAME.beats or NAME.wav"
            )
        told, made = _of_the_troupe(data, step) if data.embedded else _of_files(data, step)
        return PaperResult(
            self.key,
            self.title,
            CITATION,
            PAPER_DATA,
            *told,
            tuple(claim for one in made for claim in one.claims),
            tuple(part for one in made for part in one.parts),
            tuple(file for one in made for file in one.files),
        )


PAPER = Keyposes2009()

Told = tuple[str, tuple[str, ...]]
"""What it was done on, and what of that is not the paper's."""


def _of_the_troupe(data: Data, step: Step) -> tuple[Told, list[Made]]:
    dancers = DANCERS[:QUICK] if data.quick else DANCERS
    dances = embedded_dances(data.seed, dancers)
    extraction = _extraction(dances, _part_of(step, 0.0, 0.5))
    step(0.5, "few dimensions")
    lowdim = _lowdim(of_dances(dances).spaces(), data.seed)
    recognising = recognised(data.seed, _part_of(step, 0.6, 1.0), 1 if data.quick else DRAWS)
    ours = "A first look only, with fewer people and draws. " if data.quick else ""
    ours += (
        f"The embedded troupe: five dances of as many keyposes as the paper's, three cycles each, by "
        f"{people_told(len(dancers))}; six pieces of the folk dance by eight people in five cycles for recognition."
    )
    recognition = Made(recognition_tables(recognising), recognition_claims(recognising))
    return (ours, MADE), [extraction, lowdim, recognition]


def _of_files(data: Data, step: Step) -> tuple[Told, list[Made]]:
    step(0.0, "reading takes")
    takes = takes_of(data)
    marked, people, segments = marked_dances(data), of_takes(takes), segments_in(takes)
    why = untold(one_dance(takes))
    if why:
        warnings.warn(UntoldWarning(why), stacklevel=2)
    made: list[Made] = []
    differs = ["The dances, bodies and people are others, and so are all numbers that depend on them."]
    if marked:
        made.append(_extraction(marked, _part_of(step, 0.0, 0.5)))
    else:
        differs.append("No file has marked keyposes beside it (NAME.keyposes.csv): no Table 1, no Figs. 3 to 6.")
    step(0.5, "few dimensions")
    made.append(_left_open(_lowdim(people.spaces(), data.seed, numbered=False), why))
    differs += [f"There are {why}."] if why else []
    step(0.8, "recognising")
    if segments is not None:
        table, claims = known_in_files(segments, data.seed)
        made.append(Made((table,), claims))
    else:
        differs.append("No two tasks by two people are there twice (task_person_take.bvh): no Tables 3 to 5.")
    named = ", ".join(people.names)
    ours = f"{len(takes)} files, {len(marked)} of them with marked keyposes; for few dimensions those of {named}."
    return (ours, tuple(differs)), made


def _left_open(made: Made, why: str) -> Made:
    """No claim is told where ``why`` says that these are not the paper's keyposes."""
    if not why:
        return made
    note = " But these keyposes are on no beats that were told."
    return replace(made, claims=tuple(replace(one, holds=None, found=one.found + note) for one in made.claims))


def _extraction(dances: list[Danced], step: Step) -> Made:
    """Table 1 and Figs. 3 to 6."""
    found = extract(dances, _part_of(step, 0.0, 0.7))
    step(0.7, "thresholds")
    some = list(dict.fromkeys(one.person for one in dances))[:QUICK]
    few = [one for one in dances if one.person in some]
    sweeps, weighed = swept(few, globally_learned(few)), roughness(dances)
    drawn = [
        figure_3(dances[0], _read(dances[0], method, found.thresholds[method][0]), number, words, how)
        for method, number, words, how in (
            ("as published", "Fig. 3", "as published", "The energy is the speed of the mean of all points."),
            (
                "ours",
                "Fig. 3, ours",
                "by root mean square",
                "The energy is the root mean square of the points' speeds.",
            ),
        )
    ]
    parts = (
        table_1(found), *drawn, threshold_figure(sweeps, "T1"), threshold_figure(sweeps, "T2"),
        figure_6(dances[0], weighed),
    )  # fmt: skip
    return Made(parts, (*extraction_claims(found), *threshold_claims(sweeps), weight_claim(weighed)))


def _read(danced: Danced, method: str, thresholds: Thresholds) -> Keyposes:
    return Reading(danced.motion, danced.beats, replace(LEARNED[method], thresholds=thresholds)).keyposes()


def _lowdim(found: LowDimensional, seed: int, *, numbered: bool = True) -> Made:
    """Figs. 7 to 14, Table 2, and the page of the study."""
    spaces = Spaces.of(found, numbered=numbered)
    page = study_page(found, seed, min(SEQUENCES, len(found.motions)))
    parts: list[Part] = list(lowdim_parts(spaces))
    unnatural = next(k for k, part in enumerate(parts) if part.number == "Fig. 13")  # what comes after Table 2
    parts.insert(unnatural, study_table(None))
    return Made(tuple(parts), lowdim_claims(spaces), ((PAGE, page),))


def _part_of(step: Step, start: float, end: float) -> Step:
    """A step of a part of the work, as a share of the whole."""
    return lambda share, what: step(start + share * (end - start), what)
