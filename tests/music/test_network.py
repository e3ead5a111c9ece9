"""The arithmetic of the network, on weights whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.music import network
from onbeat.music.activation import network as stored
from onbeat.music.network import elu, front, logits


def only_a_tap(tap: int, layer: int) -> dict[str, np.ndarray]:
    """Weights whose first output adds what one tap of one layer sees of the only channel."""
    weights = {
        "wide": np.zeros((4, 5, 1, 1), np.float32),
        "wide_bias": np.zeros((4, 1), np.float32),
        "mix": np.zeros((4, 1, 1), np.float32),
        "mix_bias": np.zeros((4, 1), np.float32),
        "last": np.array([[1.0, 0.0]], np.float32),
        "last_bias": np.array([0.0, 7.0], np.float32),
    }
    weights["wide"][layer, tap] = 1.0
    weights["mix"][layer] = 1.0
    return weights


@pytest.mark.parametrize(("causal", "back"), [(False, 2), (True, 4)])
@pytest.mark.parametrize("layer", [0, 3])
@pytest.mark.parametrize("tap", [0, 2, 4])
def test_taps_look_where_they_should(causal: bool, back: int, layer: int, tap: int) -> None:
    click = np.zeros((100, 1), np.float32)
    click[50] = 1.0
    odds = logits(click, only_a_tap(tap, layer), causal)
    seen = np.zeros(100)
    seen[50] += 1.0
    seen[50 + (back - tap) * 2**layer] += 1.0
    np.testing.assert_allclose(odds[:, 0], seen)
    assert (odds[:, 1] == 7.0).all()


@pytest.mark.parametrize("causal", [False, True])
def test_chunks_do_not_matter(monkeypatch: pytest.MonkeyPatch, causal: bool) -> None:
    weights = stored("causal" if causal else "offline")
    features = np.random.default_rng(0).random((500, 2, 64)).astype(np.float32)
    whole = logits(front(features, weights, causal), weights, causal)
    monkeypatch.setattr(network, "CHUNK", 77)
    np.testing.assert_allclose(logits(front(features, weights, causal), weights, causal), whole, atol=1e-4)


def test_elu_is_smooth_at_nothing() -> None:
    np.testing.assert_allclose(elu(np.array([-1e-4, 0.0, 1e-4], np.float32)), [-1e-4, 0.0, 1e-4], atol=1e-8)
