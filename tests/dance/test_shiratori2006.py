from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from onbeat.dance import shiratori2006
from onbeat.dance.frames import lay_frames
from onbeat.dance.optimal import Problem
from onbeat.dance.score import FINE, Music
from onbeat.dance.shiratori2006 import Components, components, shiratori2006_path
from onbeat.errors import PlanError
from onbeat.motion.features import hand_features, keyframe_component
from onbeat.moves.graph import GRID
from onbeat.moves.library import Clip, MoveLibrary
from onbeat.music.song import Song
from persons import person, swinging
from walkable import clip, graph


def song(chord_change: list[float]) -> Song:
    beats = 0.5 * np.arange(1, len(chord_change) + 1)
    return Song(4.0, 120.0, 4, beats, beats[:1], np.array(chord_change), np.array([0.0, 4.0]), np.array([0.0, 1.0]))


@pytest.fixture(scope="module")
def library() -> MoveLibrary:
    clips = [Clip.of(swinging(person(), 360, 60.0, seed), source=seed) for seed in (1, 2)]
    lengths = [len(clip.poses) for clip in clips]
    return MoveLibrary(tuple(clips), graph(lengths, [(60, lengths[0] + 60), (lengths[0] + 70, 70)]))


def test_motion_components_are_those_of_each_clip(library: MoveLibrary) -> None:
    parts = components(library, song([1.0]), 120)
    for number, own in enumerate(library.clips):
        run = slice(int(library.starts[number]), int(library.starts[number + 1]))
        times = np.arange(len(own.poses)) / GRID
        stops = hand_features(own.motion).stops
        np.testing.assert_allclose(parts.stop[run], keyframe_component(stops, times))
        np.testing.assert_array_equal(parts.motion[run], own.intensity)
    assert parts.stop.max() > 0.9


def test_beats_have_the_degree_of_their_chord_change(library: MoveLibrary) -> None:
    beat = components(library, song([0.3, 0.0, 1.0]), 120).beat
    assert np.flatnonzero(beat).tolist() == [15, 45]
    assert beat[[15, 45]].tolist() == [0.3, 1.0]


def test_without_chord_changes_all_beats_count(library: MoveLibrary) -> None:
    beat = components(library, song([0.0, 0.0]), 120).beat
    assert np.flatnonzero(beat).tolist() == [15, 30]
    assert beat[[15, 30]].tolist() == [1.0, 1.0]


def test_a_beat_at_the_songs_end_is_inside(library: MoveLibrary) -> None:
    assert components(library, song([1.0] * 8), 120).beat[-1] == 1.0


def fork(monkeypatch: pytest.MonkeyPatch) -> tuple[Problem, MoveLibrary]:
    """One clip that forks into a calm and a wild one, alike in rhythm; a third is wilder yet but off the beat."""
    library = MoveLibrary(
        tuple(clip(60, [], source=n) for n in range(4)), graph([60] * 4, [(20, 70), (20, 130), (20, 190)])
    )
    frames = 60
    music = Music(np.zeros((frames + 2 * Music.PAD) * FINE, np.float32), np.zeros(frames, np.float32), frames)
    problem = Problem(library.graph, lay_frames(library), music, np.zeros(3, np.float32), hold=10)
    stop, motion, beat = np.zeros(240), np.zeros(240), np.zeros(frames)
    beat[[5, 30]] = 1.0
    stop[[5, 80, 140]] = 2.0  # in the first clip, and ten frames after the joins to the calm and the wild one
    motion[60:120], motion[120:180], motion[180:240] = 0.5, 1.0, 3.0
    parts = Components(stop, motion, beat, np.ones(frames))
    monkeypatch.setattr(shiratori2006, "components", lambda *_: parts)
    return problem, library


def test_rhythm_comes_first_and_then_intensity(monkeypatch: pytest.MonkeyPatch) -> None:
    problem, library = fork(monkeypatch)
    path = shiratori2006_path(problem, library, song([1.0]))
    assert path.times.tolist() == [0, 20]
    assert path.entries.tolist() == [0, 130]


def test_intensity_wins_where_rhythm_says_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    problem, library = fork(monkeypatch)
    parts = shiratori2006.components(library, song([1.0]), 60)
    silent = replace(parts, beat=np.zeros(60))
    monkeypatch.setattr(shiratori2006, "components", lambda *_: silent)
    assert shiratori2006_path(problem, library, song([1.0])).entries[-1] >= 180


def test_it_needs_motion_at_its_own_rate(monkeypatch: pytest.MonkeyPatch) -> None:
    problem, library = fork(monkeypatch)
    with pytest.raises(PlanError, match="no rate of 1"):
        shiratori2006_path(replace(problem, frames=lay_frames(library, (0.87,))), library, song([1.0]))


def test_it_is_found_behind_other_rates(monkeypatch: pytest.MonkeyPatch) -> None:
    problem, library = fork(monkeypatch)
    laid = lay_frames(library, (0.87, 1.0))
    path = shiratori2006_path(replace(problem, frames=laid), library, song([1.0]))
    assert laid.rate[path.entries].tolist() == [1.0, 1.0]
    assert laid.base[path.entries].tolist() == [0, 130]
