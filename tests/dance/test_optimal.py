from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from onbeat.dance.frames import lay_frames
from onbeat.dance.optimal import HOLD, Problem, ValueToGo, best_path, joins_from, score_path
from onbeat.dance.score import FINE, Music
from onbeat.dance.seams import Seams
from onbeat.dance.too_long import too_long
from onbeat.errors import PlanError
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary
from walkable import clip, graph, random_problem


def music(frames: int, beats: list[int], off_beat: float = 0.5) -> Music:
    """A song whose beats lie on song frames: a stop earns ½ there and costs ½ elsewhere."""
    worth = np.full((frames + 2 * Music.PAD) * FINE, -off_beat, np.float32)
    worth[(np.array(beats, int) + Music.PAD) * FINE] = 1 - off_beat
    return Music(worth, np.zeros(frames, np.float32), frames)


def two_clips(hold: int = 3, cost: float = 0.1, seams: Seams | None = None) -> Problem:
    """Two clips of 20 frames, each with a stop at frame 5; one join, from frame 8 of the first to 2 of the second."""
    clips = (clip(20, [5 / GRID], source=0), clip(20, [5 / GRID], source=1))
    library = MoveLibrary(clips, graph([20, 20], [(8, 22)]))
    laid = lay_frames(library, (1.0,))
    return Problem(library.graph, laid, music(12, [2, 8]), np.array([cost], np.float32), seams, hold)


def test_a_join_is_taken_where_it_pays() -> None:
    """The first clip, begun at 3, stops at song frame 2; the join at 5 brings the second clip's stop to 8."""
    path = best_path(ValueToGo(two_clips()))
    assert path.times.tolist() == [0, 5]
    assert path.entries.tolist() == [3, 22]
    assert path.score == pytest.approx(0.5 + 0.5 - 0.1)


def test_a_join_is_left_where_it_does_not_pay() -> None:
    path = best_path(ValueToGo(two_clips(cost=0.6)))
    assert path.times.tolist() == [0]
    assert path.score == pytest.approx(0.5)


def test_a_hold_keeps_the_dance_from_the_next_join() -> None:
    """There and back again in five frames, if it may."""
    library = MoveLibrary(
        (clip(30, [5 / GRID, 15 / GRID]), clip(20, [5 / GRID], source=1)), graph([30, 20], [(8, 32), (37, 10)])
    )
    problem = Problem(library.graph, lay_frames(library, (1.0,)), music(20, [2, 8, 15]), np.full(2, 0.1, np.float32))
    free = best_path(ValueToGo(replace(problem, hold=5)))
    assert free.times.tolist() == [0, 5, 10]
    assert free.score == pytest.approx(1.5 - 0.2)
    assert best_path(ValueToGo(replace(problem, hold=6))).score < free.score - 0.1


def test_what_a_join_does_to_stops_is_earned() -> None:
    made = Seams(np.array([0, 1], np.int32), np.array([2 * FINE], np.int32), np.ones(1, np.float32))
    without, problem = two_clips(), two_clips(seams=made)
    for t in (4, 6, 8):
        gained = score_path(problem, [0, t], [8 - t, 22]) - score_path(without, [0, t], [8 - t, 22])
        assert gained == pytest.approx(0.5 if t + 2 == 8 else -0.5)


def test_hold_is_the_stretch_between_joins_by_default() -> None:
    problem = two_clips()
    assert Problem(problem.graph, problem.frames, problem.music, problem.join_costs).hold == HOLD == 24


def test_joins_too_near_a_clips_end_lead_nowhere() -> None:
    problem = two_clips(hold=3)
    assert joins_from(problem, 8, 1)[0].tolist() == [22]
    assert joins_from(replace(problem, hold=16), 8, 1)[0].tolist() == [22]
    assert joins_from(replace(problem, hold=17), 8, 1)[0].tolist() == []


@pytest.mark.parametrize(
    ("times", "entries", "message"),
    [
        ([0, 4], [3, 22], "no join from frame 7 to 22"),
        ([0, 4], [4, 23], "no join from frame 8 to 23"),
        ([0], [12], "the clip ends before 12 frames after frame 12"),
    ],
)
def test_score_refuses_what_is_no_path(times: list[int], entries: list[int], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        score_path(two_clips(), times, entries)


def test_score_refuses_joins_too_soon_after_each_other() -> None:
    library = MoveLibrary((clip(20, []), clip(20, [], source=1)), graph([20, 20], [(8, 22), (24, 3)]))
    laid, costs = lay_frames(library, (1.0,)), np.zeros(2, np.float32)
    problem = Problem(library.graph, laid, music(12, []), costs, hold=2)
    assert score_path(problem, [0, 4, 6], [4, 22, 3]) == 0.0
    with pytest.raises(ValueError, match="joins at song frames 4 and 6: at least 3 must be danced"):
        score_path(replace(problem, hold=3), [0, 4, 6], [4, 22, 3])


def test_a_song_longer_than_any_dance_is_refused() -> None:
    problem = replace(two_clips(), music=music(40, []))
    with pytest.raises(PlanError, match=r"longest dance .* lasts 0\.8 s, and the song 1\.3 s"):
        ValueToGo(problem)


@pytest.mark.parametrize("rows", [None, 8])
def test_the_longest_dance_that_is_told_can_be_danced(rows: int | None) -> None:
    with pytest.raises(PlanError):
        ValueToGo(replace(two_clips(), music=music(27, [])), rows)
    assert len(best_path(ValueToGo(replace(two_clips(), music=music(26, [])), rows)).times) == 2
    # Of clips of three and more seconds what is told is advised, too: 2.66 s are 2.6.
    assert too_long(80, 200).endswith("add clips, or dance to 2.6 --seconds at most")
    assert too_long(26, 40).endswith("add clips")


def test_the_last_frames_of_a_clip_can_end_the_song() -> None:
    path = best_path(ValueToGo(replace(two_clips(), music=music(20, []))))
    assert path.entries.tolist() in ([0], [20])


def test_the_same_problem_gives_the_same_path() -> None:
    problem = random_problem(np.random.default_rng(11), frames=20)
    one, other = best_path(ValueToGo(problem)), best_path(ValueToGo(replace(problem)))
    assert one.times.tobytes() == other.times.tobytes()
    assert one.entries.tobytes() == other.entries.tobytes()


def test_best_from_a_given_start_dances_it_for_the_hold() -> None:
    rng = np.random.default_rng(12)
    tried = 0
    while tried < 20:
        problem = random_problem(rng, frames=12)
        try:
            value = ValueToGo(problem)
        except PlanError:
            continue
        starts = np.flatnonzero(problem.frames.left > 12)
        if not len(starts):
            continue
        start = int(rng.choice(starts))
        path = best_path(value, start=start)
        assert path.entries[0] == start
        assert np.all(path.times[1:] >= problem.hold)
        assert path.score <= value.optimum + 1e-3
        tried += 1
