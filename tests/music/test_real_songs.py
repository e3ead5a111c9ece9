"""The default method on pieces with known beats: a guard against getting worse; ``benchmarks/beats.py`` measures."""

from __future__ import annotations

from pathlib import Path

import mir_eval
import numpy as np
import pytest

from onbeat.music import listen

PIECES = ("mma_tango124", "mma_late_pop126", "mma_slowrock76", "mma_accel90_150", "msx_harp_harmony", "loop_amen")


@pytest.mark.data
def test_steady_pieces_are_tracked(data: Path) -> None:
    lags, scores = [], []
    for name in PIECES:
        beats = np.loadtxt(data / "music_beats" / f"{name}.beats")[:, 0]
        song = listen(data / "music_beats" / f"{name}.ogg", seconds=30.0)
        beats = beats[beats < 30.0]
        scores.append(mir_eval.beat.f_measure(mir_eval.beat.trim_beats(beats), mir_eval.beat.trim_beats(song.beats)))
        nearest = np.abs(song.beats[:, None] - beats).argmin(axis=1)
        lags.append(np.median(song.beats - beats[nearest]))
    assert min(scores) > 0.97
    assert abs(np.median(lags)) < 0.008
