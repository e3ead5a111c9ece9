"""Any bytes as a file of beats give beats or one clear sentence, never anything else."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from onbeat.errors import AudioError
from onbeat.music.beat_files import read_beats

LINES = st.lists(st.text('0123456789.,;\t -+eEnaif#[]{}":\\\n\r\u00b2\u0665', max_size=30), max_size=12).map("\n".join)


@pytest.mark.parametrize("ending", ["beats", "csv", "json"])
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.one_of(LINES.map(str.encode), st.binary(max_size=200)))
@example(b'{"beats": [1e400, 2]}')
@example(b"1e309\n2\n")
@example(b"\x00" * 40)
def test_any_bytes(tmp_path: Path, ending: str, data: bytes) -> None:
    path = tmp_path / f"a.{ending}"
    path.write_bytes(data)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            found = read_beats(path, 100.0)
        except AudioError as error:
            assert str(path) in str(error)  # noqa: PT017
        else:
            assert len(found.times) >= 2
            assert (np.diff(found.times) > 0.0).all()
            assert 0.0 <= found.times[0] <= found.times[-1] <= 100.0
