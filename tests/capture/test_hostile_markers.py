from __future__ import annotations

import warnings

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from capture.marked import dancing, marked
from onbeat.capture import fit_body, marker_body_frames
from onbeat.errors import BodyError
from onbeat.motion import Markers

WHOLE = marked(dancing(0.5, 30.0), noise_m=0.001)


@given(st.data())
@settings(max_examples=25, deadline=None)
def test_whatever_is_seen_a_body_is_fitted_or_refused(data: st.DataObject):
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32 - 1)))
    left_out = data.draw(st.sets(st.sampled_from(WHOLE.names), max_size=12))
    names = [name for name in WHOLE.names if name not in left_out]
    positions = WHOLE.chosen(names).positions.copy()
    frames = data.draw(st.integers(1, len(positions)))
    positions = positions[:frames] + rng.normal(scale=data.draw(st.sampled_from([0.0, 0.01, 0.3])), size=3)
    positions[rng.random(positions.shape[:2]) < data.draw(st.sampled_from([0.0, 0.3, 0.9]))] = np.nan
    wild = rng.random(positions.shape[:2]) < data.draw(st.sampled_from([0.0, 0.1]))
    positions[wild] = rng.normal(scale=data.draw(st.sampled_from([1.0, 100.0])), size=(int(wild.sum()), 3))
    markers = Markers(names, positions, data.draw(st.sampled_from([0.01, 30.0, 1e5])))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for found in (fit_body, marker_body_frames):
            try:
                result = found(markers)
            except BodyError:
                continue
            turns = result.motion.rotations if found is fit_body else result[0]
            assert np.isfinite(turns).all()
            assert np.allclose(np.linalg.norm(turns, axis=-1), 1)
