"""The paper of 2009, done again: what is counted is what is found, and other people's files go all the way."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from folk_dancers import dancers, spaces_of
from onbeat.errors import OnbeatError
from onbeat.examples.dancers import DANCERS
from onbeat.formats import write_motion
from onbeat.keyposes.candidates import Thresholds
from onbeat.keyposes.extract import Reading, find_keyposes
from onbeat.keyposes.unnatural import Unnatural
from onbeat.recognition.protocols import PAPER as COUNTED
from onbeat.recognition.protocols import PaperTables, Score
from onbeat.reproduce.data import Data
from onbeat.reproduce.p3 import recognition, thresholds
from onbeat.reproduce.p3.dances import BESIDE, CYCLES, Danced, embedded_dances, marked_dances
from onbeat.reproduce.p3.energy_figures import figure_3
from onbeat.reproduce.p3.extraction import TRUE, Extraction, extract, extraction_claims, table_1
from onbeat.reproduce.p3.files import Take, UntoldWarning, one_dance
from onbeat.reproduce.p3.keyposes import PAPER
from onbeat.reproduce.p3.lowdim import Spaces, grouped
from onbeat.reproduce.p3.recognition import recognised, recognition_claims, recognition_tables
from onbeat.reproduce.p3.thresholds import globally_learned, level_from, swept, threshold_claims, threshold_figure
from onbeat.reproduce.result import FigureResult, TableResult


def silent(share: float, what: str) -> None:
    assert 0.0 <= share <= 1.0


@pytest.fixture(scope="module")
def two() -> list[Danced]:
    """The folk dance by two dancers, two cycles."""
    return embedded_dances(0, DANCERS[:2], 2, ("folk dance",))


@pytest.fixture(scope="module")
def found(two: list[Danced]) -> Extraction:
    return extract(two, silent)


def test_each_dance_has_as_many_keyposes_as_the_papers_beside_it():
    made = embedded_dances(0, DANCERS[:1])
    for one in made:
        first, end = one.cycles[-1]
        in_cycle = ((one.true_beats >= first) & (one.true_beats < end)).sum()
        assert str(in_cycle) == TRUE[BESIDE[one.dance]].split(" / ")[1]
        assert len(one.cycles) == CYCLES
    assert [one.dance for one in made] == list(BESIDE)


def test_what_is_found_in_each_cycle_is_counted(two: list[Danced], found: Extraction):
    counts, true = found.per_cycle("ours", "folk dance")
    assert (counts.tolist(), true) == ([8, 8, 8, 8], 8)
    every = found.scores("every beat")
    assert (every.recall, every.precision) == (1.0, pytest.approx(8 / 12))
    without = replace(found, found={**found.found, "ours": tuple(beats[1:] for beats in found.found["ours"])})
    assert without.per_cycle("ours", "folk dance")[0].tolist() == [7, 8, 7, 8]
    row, overall = table_1(without).rows
    assert (row.paper, overall.paper) == ("8 / 8", None)
    assert row.others[0] == "7 / 8 · 94, 100"
    assert "all in 2 of 4 cycles" in row.note


def test_thresholds_are_learned_from_others(two: list[Danced], found: Extraction):
    late = replace(two[1], truth=two[1].truth + 0.27)  # half a beat: nothing of it is where the energy is low
    other = extract([two[0], late], silent)
    assert other.thresholds["ours"][1] == found.thresholds["ours"][1]
    assert other.thresholds["ours"][0] != found.thresholds["ours"][0]


def test_a_claim_holds_if_its_figures_do(found: Extraction):
    first, second = extraction_claims(replace(found, found={**found.found, "as published": found.found["ours"]}))
    assert first.holds
    assert second.holds
    first, second = extraction_claims(
        replace(found, found={**found.found, "as published": found.found["method of 2004"]})
    )
    assert not first.holds
    assert not second.holds


def test_curves_over_thresholds_are_level_where_they_are(two: list[Danced]):
    held = {"as published": [Thresholds(0.2, 2.0)], "ours": [Thresholds(0.4, 1.0)]}
    sweeps = swept(two[:1], held, np.array([0.0, 0.4, 1.0, 5.0, 10.0]))
    assert sweeps.floor == pytest.approx(8 / 12)
    curve = sweeps.curves["ours"]["T1"]
    assert np.diff(curve[:, 1]).min() >= 0  # a higher T1 lets more pass
    assert np.diff(sweeps.curves["ours"]["T2"][:, 1]).max() <= 0
    stepped = np.array([[0.1, 1.0], [0.5, 0.9], [0.6, 0.9], [0.62, 0.88], [0.6, 0.9]])
    steps = replace(sweeps, curves={**sweeps.curves, "as published": {"T1": stepped, "T2": stepped}})
    assert level_from(steps, "as published", "T1") == 2
    level, worst = threshold_claims(steps)
    assert level.holds  # from 1 on of 10
    assert not worst.holds
    assert "precision at T1 = 0.0 of 10%" in worst.found
    drawn = threshold_figure(sweeps, "T2")
    assert (drawn.number, drawn.svg[:5]) == ("Fig. 5", b"<?xml")


def test_curves_by_the_global_energy_alone_hold_what_was_learned_by_it_alone(
    two: list[Danced], monkeypatch: pytest.MonkeyPatch
):
    orders: list[str] = []

    def learned(dances: list[Danced], readings: list[Reading], told: object) -> tuple[Thresholds, ...]:
        orders.extend(reading.options.order for reading in readings)
        return (Thresholds(1.0, 1.0),) * len(dances)

    monkeypatch.setattr(thresholds, "learned", learned)
    assert list(globally_learned(two)) == ["as published", "ours"]
    assert orders == ["global"] * 4


def test_the_worst_posture_is_unnatural_in_one_space_alone():
    def judged(through: list[float], beyond: list[float]) -> Unnatural:
        zero = np.zeros(len(through))
        return Unnatural(np.array(through), np.array(beyond), zero, zero)

    calm = judged([-1.0, 0.2, -1.0], [-1.0, -1.0, -1.0])
    wild = judged([0.1, 0.3, -1.0], [-1.0, -1.0, 0.5])
    spaces = Spaces(spaces_of(2), {"keyposes": (calm, calm), "uniform": (calm, wild)})
    assert spaces.worst("through") == (1, 0)  # at 1 keyposes are unnatural, too
    assert spaces.worst("beyond") == (1, 2)
    assert spaces.worst("through", "uniform", "keyposes") is None
    assert spaces.alone("keyposes", "uniform") == pytest.approx(2 / 6)


def test_keyposes_of_one_number_lie_together():
    spaces = spaces_of(3)
    turned = [replace(one, keyposes=np.roll(one.keyposes, 3 * n)) for n, one in enumerate(spaces.taught)]
    assert grouped(spaces, "keyposes") > 0.9
    assert grouped(replace(spaces, taught=tuple(turned)), "keyposes") < 0.6


def test_dancers_who_are_always_alike_are_known_again_and_the_papers_epsilon_turns_most_of_them_away(
    monkeypatch: pytest.MonkeyPatch,
):
    # In place of ours, which takes long to learn: an ε that nothing is beyond.
    for name in ("ours", "ours_across"):
        monkeypatch.setattr(recognition, name, recognition.as_published(0.999))
    tables = recognition_tables(recognised(0, silent, 1, (0.0,)))
    rows = [row for table in tables for row in table.rows]
    assert [row.paper.split(" · ")[0] for row in rows if row.paper] == [f"{a} / {b}" for a, b in COUNTED.values()]
    assert [row.ours.split(" · ")[0] for row in rows[:4]] == ["48 / 48", "48 / 48", "24 / 24", "24 / 24"]
    known = rows[4]
    assert float(known.ours.split(" · ")[1][:-1]) < 60
    assert [row.others[0] for row in rows[2:5]] == ["0 / 24 · 0%", "0 / 24 · 0%", "12 / 12 · 100%"]


def test_a_claim_that_depends_on_the_dancers_is_left_open():
    def tables(share: float) -> PaperTables:
        return PaperTables(*(Score(round(48 * share), 48, share, share, share) for _ in range(6)))

    good, bad = (tables(1.0), tables(1.0)), (tables(0.2), tables(1.0))
    assert [claim.holds for claim in recognition_claims({0.0: [good], 1.0: [good]})] == [True] * 4
    assert [claim.holds for claim in recognition_claims({0.0: [bad], 1.0: [bad]})] == [False] * 4
    assert [claim.holds for claim in recognition_claims({0.0: [good], 1.0: [bad]})] == [None] * 4


def test_the_dance_that_most_people_dance_is_taken_once_of_each():
    motion = dancers(1)[0].motion
    names = ["bow_aiko_001", "walk_aiko_002", "walk_aiko_001", "walk_bruno_001"]
    takes = [Take(Path(name), motion, *name.split("_")[:2], int(name[-3:])) for name in names]
    assert [take.path.name for take in one_dance(takes)] == ["walk_aiko_002", "walk_bruno_001"]


def test_marks_and_beats_beside_a_file_are_its_truth(tmp_path: Path):
    clip = dancers(1)[0]
    for name in ("marked", "bare"):
        write_motion(clip.motion[:200], tmp_path / f"{name}.bvh")
    inside = clip.keyposes[clip.keyposes < 6.0]
    (tmp_path / "marked.keyposes.csv").write_text("".join(f"{time:.3f}\n" for time in inside))
    (tmp_path / "marked.beats").write_text("".join(f"{time:.3f}\n" for time in clip.beats))
    (one,) = marked_dances(Data((tmp_path,)))
    assert one.dance == "marked"
    assert np.abs(one.beats[one.true_beats] - inside).max() < 0.01
    assert one.cycles == [(int(one.true_beats[0]), int(one.true_beats[-1]) + 1)]


def test_files_go_all_the_way(tmp_path: Path):
    for clip in dancers(2):
        for task, start in (("high", 0), ("low", 200)):
            for take in (1, 2):
                name = f"{task}_{clip.person.lower()}_{take:03d}"
                write_motion(clip.motion[start + 7 * take : start + 150 + 7 * take], tmp_path / f"{name}.bvh")
    with pytest.warns(UntoldWarning, match=r"no beats beside low_aiko_001\.bvh and 1 more"):
        result = PAPER.reproduce(Data((tmp_path,)), silent)
    assert {claim.holds for claim in result.claims[:4]} == {None}
    numbers = [part.number for part in result.parts]
    assert {"Fig. 9", "Fig. 11", "Fig. 13", "Table 2", "Table 3"} <= set(numbers)
    assert len(set(numbers)) == len(numbers)
    assert result.our_data.startswith("8 files, 0 of them")
    assert "The tensor tells tasks that it knows (47 of 48)." in [claim.said for claim in result.claims]
    assert "no Table 1" in " ".join(result.differs)
    assert [name for name, _ in result.files] == ["study.html"]
    for part in result.parts:
        if isinstance(part, TableResult):
            assert part.rows
        else:
            assert isinstance(part, FigureResult)
            assert part.svg.rstrip().endswith(b"</svg>")


def test_a_dance_is_drawn_with_what_is_found_in_it(two: list[Danced]):
    drawn = figure_3(two[0], find_keyposes(two[0].motion, two[0].beats), "Fig. 3", "ours", "")
    assert drawn.remark.startswith("9 of 9 keyposes are found here, and 0 more")
    assert drawn.svg.count(b"<image") == 18  # the poses found, and those by the book


def test_songs_are_refused_for_they_would_not_be_heard():
    with pytest.raises(OnbeatError, match=r"leave out song\.wav"):
        PAPER.reproduce(Data(songs=(Path("song.wav"),)), silent)


def test_one_persons_files_span_no_space_of_several(tmp_path: Path):
    write_motion(dancers(1)[0].motion[:90], tmp_path / "bow_aiko_001.bvh")
    with pytest.raises(OnbeatError, match="aiko alone dances 'bow'"):
        PAPER.reproduce(Data((tmp_path,)), silent)
