"""The learned activation in numpy and frame by frame: what torch says, whatever the blocks and the gain."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from onbeat.music import activation
from onbeat.music.activation import BANDS, CausalActivation, activation_log_odds, network

GOLDEN = Path(__file__).with_name("activation_golden.npz")


@pytest.fixture(scope="module")
def golden() -> dict[str, np.ndarray]:
    with np.load(GOLDEN, allow_pickle=False) as stored:
        return {name: stored[name] for name in stored.files}


def chance(odds: np.ndarray) -> np.ndarray:
    return 1.0 / (1.0 + np.exp(-odds.astype(np.float64)))


def noise(frames: int, seed: int = 1) -> np.ndarray:
    return np.random.default_rng(seed).normal(-5.0, 0.5, (frames, BANDS)).astype(np.float16)


def test_whole_songs_equal_torch(golden: dict[str, np.ndarray]) -> None:
    odds = activation_log_odds(golden["bands"], 100.0)[-len(golden["offline"]) :]
    np.testing.assert_allclose(odds, golden["offline"], atol=2e-5)


def test_frame_by_frame_equals_torch(golden: dict[str, np.ndarray]) -> None:
    heard = CausalActivation().push(golden["bands"].astype(np.float32))[-len(golden["causal"]) :]
    np.testing.assert_allclose(heard, chance(golden["causal"]), atol=1e-5)


def test_the_size_of_blocks_changes_no_bit() -> None:
    bands = noise(700).astype(np.float32)
    whole = CausalActivation().push(bands)
    for size in (1, 7, 64):
        stream = CausalActivation()
        parts = [stream.push(bands[at : at + size]) for at in range(0, len(bands), size)]
        assert np.concatenate(parts).tobytes() == whole.tobytes()


def test_what_comes_later_changes_nothing_before() -> None:
    bands = noise(300).astype(np.float32)
    other = bands.copy()
    other[200:] += 2.0
    np.testing.assert_array_equal(CausalActivation().push(bands)[:200], CausalActivation().push(other)[:200])


def test_chunks_of_features_do_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    bands = noise(2 * activation.CHUNKS // 5 + 99)
    whole = activation_log_odds(bands, 100.0)
    monkeypatch.setattr(activation, "CHUNKS", activation.CHUNKS // 5)
    np.testing.assert_allclose(activation_log_odds(bands, 100.0), whole, atol=1e-5)


def test_gain_does_not_matter(golden: dict[str, np.ndarray]) -> None:
    bands = golden["bands"].astype(np.float32)
    softer = activation_log_odds(bands - 2.0, 100.0)
    np.testing.assert_allclose(softer, activation_log_odds(bands, 100.0), atol=1e-3)


def test_a_beat_is_heard_where_a_drum_is() -> None:
    bands = np.full((1600, BANDS), -7.0, np.float32)
    beats = np.arange(40, 1580, 50)
    for back in range(12):
        bands[beats + back] = np.maximum(bands[beats + back], -2.0 - 0.3 * back)
    for odds in (activation_log_odds(bands, 100.0)[:, 0], CausalActivation().push(bands)[:, 0]):
        steady = odds[800:1500]
        assert {int(place) % 50 for place in 800 + np.argsort(steady)[-14:]} <= {38, 39, 40, 41, 42}


def test_fewer_bands_and_no_frames() -> None:
    assert activation_log_odds(np.zeros((0, BANDS), np.float16), 100.0).shape == (0, 2)
    assert CausalActivation().push(np.zeros((0, BANDS), np.float32)).shape == (0, 2)
    assert np.isfinite(activation_log_odds(noise(50)[:, :40], 100.0)).all()
    assert np.isfinite(CausalActivation().push(noise(50)[:, :40].astype(np.float32))).all()


def test_silence_says_no() -> None:
    silence = np.full((2000, BANDS), -10.0, np.float32)
    assert chance(activation_log_odds(silence, 100.0))[500:1500].max() < 0.5
    assert CausalActivation().push(silence)[500:].max() < 0.5


def test_the_weights_are_small_and_plain() -> None:
    path = files("onbeat.music").joinpath("activation_weights.npz")
    assert len(path.read_bytes()) < 1_000_000
    for name in ("offline", "causal"):
        assert all(value.dtype == np.float32 for value in network(name).values())
        assert sum(value.size for value in network(name).values()) < 60_000
