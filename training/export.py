"""Trained weights into the package, and a few frames of what they say, by which the tests compare numpy with torch.

Usage: ``python -m training.export OFFLINE.pt[,OTHER.pt] CAUSAL.pt[,OTHER.pt] REPOSITORY``; of several, their
mean.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import torch

from onbeat.files import write_atomically
from onbeat.music.levels import loud_level, loud_level_so_far, relative, with_rises
from training.model import Activation, weights_of

FRAMES = 420
KEPT = 20


def golden_bands() -> np.ndarray:
    """Noise with a beat: (FRAMES, 64) log10 power."""
    rng = np.random.default_rng(0)
    bands = rng.normal(-5.0, 0.4, (FRAMES, 64))
    bands[::50] += 1.5
    return bands.astype(np.float16)


def spoken(model: Activation, bands: np.ndarray, rate: float) -> np.ndarray:
    """Log odds (N, 2) by torch."""
    level = (loud_level_so_far if model.causal else loud_level)(bands.max(axis=1).astype(np.float32), rate)
    features = with_rises(relative(bands, level), np.zeros((2, bands.shape[1]), np.float32))
    with torch.no_grad():
        return model(torch.from_numpy(np.ascontiguousarray(features.swapaxes(0, 1))[None]))[0].numpy()


def mean_of(states: list[dict[str, torch.Tensor]]) -> dict[str, torch.Tensor]:
    """The mean of weights along one training: as good as a slower end of it."""
    return {name: torch.stack([state[name] for state in states]).mean(dim=0) for name in states[0]}


def archived(arrays: dict[str, np.ndarray]) -> bytes:
    """The arrays as an npz without a clock in it."""
    import io

    buffer = io.BytesIO()
    np.savez(buffer, **arrays)
    return buffer.getvalue()


def main() -> None:
    """Write ``activation_weights.npz`` and the golden frames."""
    weights: dict[str, np.ndarray] = {}
    golden: dict[str, np.ndarray] = {"bands": golden_bands()}
    for name, path in zip(("offline", "causal"), sys.argv[1:3], strict=True):
        model = Activation(name == "causal")
        model.load_state_dict(mean_of([torch.load(one, weights_only=True) for one in path.split(",")]))
        model.eval()
        weights |= {f"{name}_{key}": value for key, value in weights_of(model).items()}
        golden[name] = spoken(model, golden["bands"], 100.0)[-KEPT:]
    root = Path(sys.argv[3])
    write_atomically(root / "src" / "onbeat" / "music" / "activation_weights.npz", archived(weights))
    write_atomically(root / "tests" / "music" / "activation_golden.npz", archived(golden))


if __name__ == "__main__":
    main()
