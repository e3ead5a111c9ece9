"""A song as a table."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from onbeat.music.song import Section, Song
from onbeat.music.table import bar_positions, to_csv


def song(downbeats: list[float], meter: int = 3) -> Song:
    beats = 0.5 * np.arange(1, 8)
    return Song(4.0, 120.0, meter, beats, downbeats, np.linspace(0, 1, 7), [0.0], [0.5])


def test_positions_count_from_the_downbeats() -> None:
    assert bar_positions(song([1.0, 2.5])).tolist() == [3, 1, 2, 3, 1, 2, 3]
    assert bar_positions(song([])).tolist() == [1, 2, 3, 1, 2, 3, 1]


def test_csv_has_a_line_a_beat() -> None:
    lines = to_csv(song([1.0, 2.5])).decode().splitlines()
    assert lines[0] == "time,beat,chord_change,bar,strength,confidence,tempo,chord,section"
    assert lines[1] == "0.5000,3,0.0000,0,1.0000,,120.00,,"
    assert lines[-1] == "3.5000,3,1.0000,2,1.0000,,120.00,,"
    assert len(lines) == 8


def test_csv_has_what_is_known() -> None:
    known = replace(
        song([1.0, 2.5]),
        confidence=np.full(7, 0.5),
        chord_root=["N", *["A:min"] * 6],
        sections=[Section(0.0, 2.5, "intro"), Section(2.5, 4.0, "main")],
    )
    lines = to_csv(known).decode().splitlines()
    assert lines[1] == "0.5000,3,0.0000,0,1.0000,0.5000,120.00,N,intro"
    assert lines[4] == "2.0000,3,0.5000,1,1.0000,0.5000,120.00,A:min,intro"
    assert lines[5].endswith(",A:min,main")
