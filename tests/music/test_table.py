"""A song as a table."""

from __future__ import annotations

import numpy as np

from onbeat.music.song import Song
from onbeat.music.table import bar_positions, to_csv


def song(downbeats: list[float], meter: int = 3) -> Song:
    beats = 0.5 * np.arange(1, 8)
    return Song(4.0, 120.0, meter, beats, downbeats, np.linspace(0, 1, 7), [0.0], [0.5])


def test_positions_count_from_the_downbeats() -> None:
    assert bar_positions(song([1.0, 2.5])).tolist() == [3, 1, 2, 3, 1, 2, 3]
    assert bar_positions(song([])).tolist() == [1, 2, 3, 1, 2, 3, 1]


def test_csv_has_a_line_a_beat() -> None:
    lines = to_csv(song([1.0, 2.5])).decode().splitlines()
    assert lines[0] == "time,beat,chord_change"
    assert lines[1] == "0.5000,3,0.0000"
    assert lines[-1] == "3.5000,3,1.0000"
    assert len(lines) == 8
