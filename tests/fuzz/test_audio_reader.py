"""Damaged sound files give sound or one clear sentence, never anything else."""

from __future__ import annotations

import contextlib
import warnings
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import soundfile
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from onbeat.errors import AudioError
from onbeat.music.audio import AudioWarning, read_audio


@cache
def whole(folder: Path, ending: str) -> bytes:
    path = folder / f"whole.{ending}"
    soundfile.write(path, 0.1 * np.random.default_rng(0).standard_normal(8000), 8000)
    return path.read_bytes()


@pytest.mark.parametrize("ending", ["wav", "flac", "ogg"])
@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_damage(tmp_path: Path, ending: str, data: st.DataObject) -> None:
    content = bytearray(whole(tmp_path, ending))
    for _ in range(data.draw(st.integers(0, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    content = content[: data.draw(st.integers(0, len(content)))]
    path = tmp_path / f"damaged.{ending}"
    path.write_bytes(bytes(content))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", AudioWarning)
        with contextlib.suppress(AudioError):
            assert np.isfinite(read_audio(path, rate=8000).samples).all()
