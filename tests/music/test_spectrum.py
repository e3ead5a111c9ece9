"""Spectra of streams, and bands."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.music.spectrum import SpectrumStream, bin_frequencies, log_bands


def spectra(samples: np.ndarray, sizes: list[int]) -> np.ndarray:
    stream = SpectrumStream(64, 20)
    parts = [stream.push(part) for part in np.split(samples, np.cumsum(sizes))]
    return np.concatenate([*parts, stream.finish()])


def test_blocks_do_not_matter() -> None:
    samples = np.random.default_rng(0).standard_normal(1003).astype(np.float32)
    whole = spectra(samples, [])
    assert whole.shape == (51, 33)
    np.testing.assert_array_equal(whole, spectra(samples, [1, 10, 333, 64]))


@pytest.mark.parametrize("count", [1, 19, 20, 21, 63, 64, 65])
def test_short_sounds_have_a_frame_each_hop(count: int) -> None:
    assert len(spectra(np.ones(count, np.float32), [])) == -(-count // 20)


def test_full_scale_sine_has_power_one_at_its_frequency() -> None:
    stream = SpectrumStream(256, 64)
    power = stream.push(np.sin(2 * np.pi * 1000.0 * np.arange(4096) / 8000).astype(np.float32))[10]
    assert bin_frequencies(256, 8000)[power.argmax()] == pytest.approx(1000.0)
    assert power.max() == pytest.approx(1.0, rel=1e-3)


def test_frames_are_centred() -> None:
    impulse = np.zeros(1000, np.float32)
    impulse[400] = 1.0
    assert spectra(impulse, []).sum(axis=1).argmax() == 20


def test_bands_peak_at_their_centres() -> None:
    frequencies = np.arange(0.0, 4000.0, 1.0)
    bands = log_bands(frequencies, 100.0, 1600.0, 12)
    np.testing.assert_allclose(frequencies[bands.argmax(axis=0)], 100.0 * 2.0 ** (np.arange(49) / 12), atol=0.51)
    assert log_bands(np.arange(0.0, 4000.0, 50.0), 100.0, 1600.0, 12).max(axis=0).min() > 0.0
