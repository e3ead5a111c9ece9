"""The pattern generator that the learned activation is trained with: its laws."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def pattern(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(str(ROOT))
    return pytest.importorskip("training.pattern")


@pytest.fixture
def song(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(str(ROOT))
    return pytest.importorskip("training.song")


def test_the_same_seed_gives_the_same_notes(pattern: ModuleType) -> None:
    one, two = pattern.compose(3), pattern.compose(3)
    assert one.notes == two.notes
    assert one.strokes == two.strokes
    np.testing.assert_array_equal(one.beats, two.beats)
    assert pattern.compose(4).notes != one.notes


def test_every_style_has_bars_of_its_meter_and_sounds(pattern: ModuleType) -> None:
    meters = set()
    for seed, style in enumerate(pattern.STYLES):
        song = pattern.compose(seed, style=style.name)
        assert len(song.notes) + len(song.strokes) > 0, style.name
        assert (np.diff(np.flatnonzero(song.downbeats)) == style.meter).all()
        assert song.downbeats[0]
        for line in (*(p for choices in style.drums.values() for p in choices), *style.bass, *style.chords):
            assert len(line) in (0, style.meter * style.div), (style.name, line)
        meters.add(style.meter)
    assert meters == {2, 3, 4, 5, 6, 7}


def test_tempi_stay_in_range_and_cover_it(pattern: ModuleType) -> None:
    tempi = []
    for seed in range(120):
        steps = np.diff(pattern.compose(seed).beats)
        assert (steps > 60.0 / 246.0).all()
        assert (steps < 60.0 / 37.0).all()
        tempi.append(60.0 / np.median(steps))
    assert min(tempi) < 60.0
    assert max(tempi) > 200.0


def test_strokes_without_swing_and_jitter_fall_on_steps(pattern: ModuleType) -> None:
    rng = np.random.default_rng(0)
    style = next(one for one in pattern.STYLES if one.name == "disco")
    song = pattern.Song(style, rng, 20.0)
    song.jitter = 0.0
    song.grid.swing = 0.5
    song.drum_parts = {"K": ("X...X...X...X...", 36, 1.0, 0.0)}
    pattern.play_drums(song, range(song.grid.bars), False)
    times = np.array([time for time, _, _ in song.performance.strokes])
    np.testing.assert_allclose(times, song.grid.beats[: len(times)], atol=1e-9)


def test_swing_delays_off_beats_only(song: ModuleType) -> None:
    grid = song.Grid(np.arange(9.0), 4, 2, 2.0 / 3.0)
    np.testing.assert_allclose(grid.time(np.array([0.0, 0.5, 1.0, 1.5])), [0.0, 2.0 / 3.0, 1.0, 5.0 / 3.0])
