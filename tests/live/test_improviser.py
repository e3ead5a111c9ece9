from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import PlanError
from onbeat.live.choice.improviser import Chosen, Improviser
from onbeat.metrics.beats import f_measure
from onbeat.moves.graph import GRID, STRETCH
from onbeat.moves.library import MoveLibrary

BEAT = 0.52


@pytest.fixture(scope="module")
def library(troupe: MoveLibrary) -> MoveLibrary:
    return MoveLibrary.of(troupe.clips[:6])


def dance(improviser: Improviser, seconds: float, phase: float = 0.0) -> list[Chosen]:
    """What is chosen to a steady beat."""
    at, since, end, out = None, 0.0, 0.0, list[Chosen]()
    while end < seconds:
        beats = np.arange(0.0, end + 12.0, BEAT) + phase - end
        chosen = improviser.choose(at, since, beats[beats > -0.6], None, 0.3, 2.0)
        for part in chosen.stretches:
            goes_on = at is not None and at[0] == part.clip and abs(at[1] - part.from_s) < 1e-9
            since = part.to_s - part.from_s + (since if goes_on else 0.0)
            at = part.clip, part.to_s
        end += chosen.lasts
        out.append(chosen)
    return out


def stops_of(dance: list[Chosen]) -> np.ndarray:
    begins = np.cumsum([0.0, *(chosen.lasts for chosen in dance)])
    return np.concatenate([begin + chosen.stops for begin, chosen in zip(begins, dance, strict=False)])


def shown_by(library: MoveLibrary, dance: list[Chosen]) -> np.ndarray:
    parts = [part for chosen in dance for part in chosen.stretches]
    return np.concatenate(
        [library.starts[p.clip] + np.arange(round(p.from_s * GRID), round(p.to_s * GRID)) for p in parts]
    )


def test_stops_come_on_the_beats(library: MoveLibrary) -> None:
    """And not on those half a beat away."""
    danced = dance(Improviser(library), 40.0)
    stops, beats = stops_of(danced), np.arange(0.0, 40.0, BEAT)
    assert (np.diff(stops) > 0).all()
    assert f_measure(stops, beats, 0.1) > 0.65
    assert f_measure(stops, beats + BEAT / 2, 0.1) < 0.35


def test_all_joins_are_the_graph_s_and_far_enough_apart(library: MoveLibrary) -> None:
    frames = shown_by(library, dance(Improviser(library), 60.0))
    graph = library.graph
    jumps = np.flatnonzero(np.diff(frames) != 1) + 1
    for k in jumps.tolist():
        left = frames[k - 1] + 1  # the frame that would have come
        assert frames[k] in graph.targets[graph.indptr[left] : graph.indptr[left + 1]]
    assert len(jumps) > 20
    assert np.diff(jumps).min() >= round(STRETCH * GRID)


def test_what_is_chosen_lasts_as_asked_and_is_worth_what_the_way_is_to_its_end(library: MoveLibrary) -> None:
    improviser = Improviser(library)
    first = improviser.choose(None, 0.0, np.arange(0.2, 8.0, BEAT), None, 0.0, 2.0)
    assert 2.0 - 1e-9 <= first.lasts < 3.5
    end = first.stretches[-1]
    late = improviser.choose((end.clip, end.to_s), 0.2, np.arange(0.2, 8.0, BEAT), None, 0.0, 4.0, 5.5)
    assert (late.stretches[0].clip, late.stretches[0].from_s) == (end.clip, end.to_s)
    assert late.stretches[0].to_s - late.stretches[0].from_s >= STRETCH - 0.2 - 1e-9
    assert 4.0 - 1e-9 <= late.lasts <= 5.5
    assert late.optimum > 0


def test_between_frames_the_dance_goes_on_where_it_is(library: MoveLibrary) -> None:
    improviser = Improviser(library)
    chosen = improviser.choose((2, 3.01), 5.0, np.arange(0.2, 8.0, BEAT), None, 0.0, 2.0)
    assert chosen.stretches[0].from_s == pytest.approx(3.01)
    first = chosen.stretches[0]
    own = library.clips[2].stops
    near = own[(own > 3.02) & (own < min(first.to_s - 0.5, 3.4))] - 3.01
    assert all(np.abs(chosen.stops - stop).min() < 0.005 for stop in near)


def test_the_same_calls_have_the_same_answers(library: MoveLibrary) -> None:
    frames = [shown_by(library, dance(Improviser(library, seed), 12.0)).tolist() for seed in (0, 0, 3)]
    assert frames[0] == frames[1] != frames[2]


def test_what_was_shown_lately_is_not_shown_again(library: MoveLibrary) -> None:
    unique = [
        len(np.unique(shown_by(library, dance(Improviser(library, price=price), 30.0)))) / GRID for price in (1.5, 0.0)
    ]
    assert unique[0] > 26.0 > unique[1] + 4.0


def test_what_was_cut_off_costs_nothing(library: MoveLibrary) -> None:
    """After a cut the same is chosen again."""
    beats, improviser = np.arange(0.2, 12.0, BEAT), Improviser(library)
    chosen = improviser.choose((1, 4.0), 5.0, beats, None, 0.0, 3.0)
    again = improviser.choose((1, 4.0), 5.0, beats, None, 0.0, 3.0)
    assert again.stretches == chosen.stretches


def test_a_start_is_near_the_pose_it_sets_out_from(library: MoveLibrary) -> None:
    pose = library.clips[4].poses[100]
    beats = np.arange(0.2, 8.0, BEAT)
    first = Improviser(library).starts(beats, None, 0.0, 2.0, pose=pose).stretches[0]
    near = library.clips[first.clip].poses[round(first.from_s * GRID)]
    anywhere = Improviser(library).choose(None, 0.0, beats, None, 0.0, 2.0).stretches[0]
    far = library.clips[anywhere.clip].poses[round(anywhere.from_s * GRID)]
    assert np.linalg.norm(near - pose) < min(0.6, np.linalg.norm(far - pose))


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"beats": np.array([0.5, np.nan])}, "numbers"),
        ({"beats": np.array([1.0, 0.5])}, "rise"),
        ({"beats": np.zeros((2, 2))}, "shape"),
        ({"weights": np.ones(3)}, "weights"),
        ({"at": (99, 1.0)}, "no second"),
        ({"at": (0, 1e9)}, "no second"),
        ({"at": (0, np.nan)}, "no second"),
        ({"seconds": 0.0}, "seconds is"),
        ({"seconds": np.nan}, "seconds is"),
        ({"ahead": 1e9}, "ahead is"),
        ({"danced_since_join": np.nan}, "danced_since_join"),
    ],
)
def test_what_cannot_be_is_told(improviser: Improviser, changed: dict[str, object], said: str) -> None:
    given = {"at": (0, 2.0), "danced_since_join": 1.0, "beats": np.arange(0.5, 6.0, 0.5), "weights": None}
    with pytest.raises(PlanError, match=said):
        improviser.choose(**{**given, **changed})


@pytest.fixture(scope="module")
def improviser(library: MoveLibrary) -> Improviser:
    return Improviser(library)


@pytest.mark.parametrize("intensity", [np.nan, np.inf, -1e9])
def test_without_beats_and_with_any_intensity_it_dances(improviser: Improviser, intensity: float) -> None:
    assert improviser.choose(None, 0.0, np.zeros(0), None, intensity, 2.0).lasts >= 2.0 - 1e-9
