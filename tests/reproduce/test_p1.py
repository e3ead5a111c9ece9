"""The paper of 2006 done again on eight seconds of a plain song: what is told is what was danced."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import soundfile

from onbeat.errors import OnbeatError
from onbeat.examples import embedded_motions
from onbeat.metrics.beats import recall
from onbeat.moves.cache import build_from
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary
from onbeat.reproduce.data import Data
from onbeat.reproduce.p1 import music_to_dance as p1
from onbeat.reproduce.p1.choice import choice_before
from onbeat.reproduce.p1.claims import claims
from onbeat.reproduce.p1.dances import METHODS, Danced, Method, dance
from onbeat.reproduce.p1.songs import Tune, found, interval, tunes
from onbeat.reproduce.p1.tables import beat_table
from onbeat.reproduce.result import FigureResult, PaperResult, TableResult
from sounds import HEARD_RATE, beat_times, hat, kick, mix, piano


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> MoveLibrary:
    """Some clips of the troupe, without their mirror images: joining all takes long."""
    kept = tmp_path_factory.mktemp("library")
    return MoveLibrary.of(build_from(lambda: embedded_motions()[:4], "four", kept, mirror=False, workers=1).clips)


@pytest.fixture(scope="module")
def song(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A wave file of eight seconds, with its beats beside it."""
    folder = tmp_path_factory.mktemp("songs")
    rng, times = np.random.default_rng(1), beat_times(110.0, 8.0)
    band = [(time, kick()) for time in times] + [(time, hat(rng)) for time in times]
    band += [(time, piano(220.0 * 1.5 ** (k // 4 % 3))) for k, time in enumerate(times)]
    soundfile.write(folder / "plain.wav", mix(8.0, band).samples, HEARD_RATE)
    (folder / "plain.beats").write_text("\n".join(f"{time:.4f}" for time in times))
    return folder / "plain.wav"


@pytest.fixture(scope="module")
def heard(song: Path) -> Tune:
    """The song as it is heard."""
    (tune,) = tunes(Data(songs=(song,), quick=True), lambda share, what: None)
    return tune


@pytest.fixture(scope="module")
def danced(heard: Tune, library: MoveLibrary) -> Danced:
    """The dance to it as published."""
    return dance(heard, library, METHODS["published"], 0)


@pytest.fixture(scope="module")
def result(song: Path, library: MoveLibrary, heard: Tune, danced: Danced) -> PaperResult:
    """The whole paper on it; what is heard and danced already is not heard and danced again."""

    def again(tune: Tune, moves: MoveLibrary, method: Method, seed: int) -> Danced:
        return danced if method == METHODS["published"] else dance(tune, moves, method, seed)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(p1, "open_library", lambda data: library)
        patch.setattr(p1, "tunes", lambda data, step: [heard])
        patch.setattr(p1, "dance", again)
        return p1.PAPER.reproduce(Data(songs=(song,), quick=True), lambda share, what: None)


def test_beats_beside_a_song_are_taken_as_true(heard: Tune):
    assert heard.known == "annotated"
    assert interval(heard.truth.beats) == pytest.approx(60 / 110, abs=1e-3)
    assert found(heard, heard.ours) > 0.9
    moved = replace(heard.ours, beats=heard.ours.beats + 0.1)
    assert found(heard, moved) == 0.0


def test_a_song_that_is_not_there_is_refused(tmp_path: Path):
    with pytest.raises(OnbeatError, match=r"no song .*none\.wav"):
        tunes(Data(songs=(tmp_path / "none.wav",)), lambda share, what: None)
    with pytest.raises(OnbeatError, match="is a folder; give audio files"):
        p1.PAPER.reproduce(Data(songs=(tmp_path,)), lambda share, what: None)


def test_clips_that_are_not_there_are_said_before_songs_are_heard(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(p1, "tunes", lambda data, step: pytest.fail("songs were heard first"))
    with pytest.raises(OnbeatError, match="no file or folder"):
        p1.PAPER.reproduce(Data(motions=(tmp_path / "none",)), lambda share, what: None)


def test_a_claim_that_so_few_songs_cannot_tell_from_chance_is_left_open(danced: Danced):
    def followed(*values: float) -> list[Danced]:
        return [replace(danced, scores=danced.scores | {"intensity_pearson": value}) for value in values]

    def holds(both: list[Danced], rhythm: list[Danced]) -> bool | None:
        every = dict.fromkeys(METHODS, rhythm) | {"published": both}
        return claims([danced.tune], every)[-1].holds

    assert holds(followed(0.5, 0.4, -0.6), followed(0.1, 0.1, -0.2)) is None
    assert holds(followed(*[0.5] * 5), followed(*[0.1] * 5)) is True
    assert holds(followed(*[0.1] * 5), followed(*[0.5] * 5)) is False


def test_songs_that_are_tracked_are_danced_to_as_in_the_paper_and_all_where_none_is(heard: Tune):
    lost = replace(heard, published=replace(heard.published, beats=heard.published.beats + 0.15), title="lost")
    assert [tune.title for tune in p1.danced_to([lost, heard, lost, heard, heard], 2)] == ["plain", "plain"]
    assert len(p1.danced_to([lost, lost], 3)) == 2
    unknown = replace(lost, known="heard")
    assert p1.danced_to([unknown, heard], 3) == [unknown, heard]


def test_the_decision_that_is_drawn_is_the_one_that_was_taken(danced: Danced, library: MoveLibrary):
    made, seen = danced.dance, 0
    for move in range(1, min(len(made.plan.moves) - 1, 5)):
        choice = choice_before(made, library, move)
        following = made.plan.moves[move + 1]
        ahead = round(following.at_s * GRID) - choice.begin
        if 0 <= ahead < choice.paths.shape[1]:
            entry = int(library.starts[following.clip]) + round(following.from_s * GRID)
            assert choice.paths[choice.chosen][ahead] == entry
            seen += 1
        assert choice.chosen < choice.best <= 16
        assert (np.diff(choice.rhythm[: choice.best]) <= 1e-6).all()
        assert choice.intensity[choice.chosen] == choice.intensity[: choice.best].max()
    assert seen


def test_every_table_and_figure_is_there_in_order(result: PaperResult):
    numbers = [part.number for part in result.parts]
    figures = ["Fig. 2", "Fig. 5", "Fig. 6", "Fig. 7", "Fig. 8"]
    assert [number for number in numbers if number.startswith("Fig.")] == figures
    assert numbers.index("Fig. 5") < numbers.index("Table I") < numbers.index("Fig. 6")
    for part in result.parts:
        if isinstance(part, FigureResult):
            assert part.svg.startswith(b"<?xml")
            assert b"<dc:date>" not in part.svg


def test_the_papers_numbers_stand_beside_ours(result: PaperResult):
    table = next(part for part in result.parts if part.number == "Table I")
    assert isinstance(table, TableResult)
    printed = {row.label: row.paper for row in table.rows}
    assert printed["“Do Me”"] == "0.447 s (134)"
    assert printed["songs tracked"] == "10 of 13"
    plain = next(row for row in table.rows if row.label == "plain")
    assert (plain.paper, plain.others[1]) == (None, "0.545 s (110)")


def test_what_differs_is_told(result: PaperResult):
    told = " ".join(result.differs)
    assert "made, not captured" in told
    assert "composed" not in told  # the song was given
    assert "A first look" in result.our_data


def test_what_is_told_of_the_rhythm_is_measured_on_the_dance(danced: Danced, result: PaperResult):
    share = recall(danced.features.body_stops, danced.tune.truth.beats, 0.1)
    table = next(part for part in result.parts if part.number == "Sec. VI, rhythm")
    assert isinstance(table, TableResult)
    assert table.rows[0].ours == f"{share:.2f}"


def test_eq_12_counted_from_the_mean_is_another_dance_beside_the_one_as_printed(danced: Danced, result: PaperResult):
    table = next(part for part in result.parts if part.number == "Sec. VI, intensity")
    assert isinstance(table, TableResult)
    assert table.columns.index("… Eq. 12 from the mean") == 4
    speeds = next(row for row in table.rows if row.label.startswith("mean speed"))
    assert float(speeds.others[1]) <= float(speeds.ours) == pytest.approx(danced.scores["hand_speed"], abs=0.01)


def test_one_composed_song_is_a_table_too(heard: Tune):
    table = beat_table([replace(heard, known="composed")], composed=True)
    assert [row.paper for row in table.rows] == ["0.598 s (100)", "10 of 13"]


def test_the_same_figure_is_the_same_bytes(library: MoveLibrary, result: PaperResult):
    figure = next(part for part in result.parts if part.number == "Fig. 2")
    assert isinstance(figure, FigureResult)
    assert p1._figure_2(library).svg == figure.svg
