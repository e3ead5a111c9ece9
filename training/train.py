"""Training: weighted cross-entropy on beats and downbeats, Adam with one cycle, two models by one code.

Usage: ``python -m training.train OUT.pt causal|offline MINUTES VALIDATION.npz CLIPS.npz [CLIPS.npz ...]``.
"""

# ruff: noqa: T201
from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
import torch
from torch.nn import functional

from onbeat.music.levels import loud_level, loud_level_so_far, relative, with_rises
from training.model import Activation

RATE = 22050 / 220
BATCH = 8
TARGET = {0: 1.0, 1: 0.5, -1: 0.5, 2: 0.15, -2: 0.15}


def features_of(bands: np.ndarray, causal: bool) -> np.ndarray:
    """(N, 2, B) float32 from log10 power."""
    tops = bands.max(axis=1).astype(np.float32)
    levels = relative(bands, (loud_level_so_far if causal else loud_level)(tops, RATE))
    return with_rises(levels, np.zeros((2, bands.shape[1]), np.float32))


def targets_of(beats: np.ndarray, downs: np.ndarray, frames: int) -> np.ndarray:
    """(N, 2): 1 at the frame of a beat, less beside it."""
    result = np.zeros((frames, 2), np.float32)
    for column, times in enumerate((beats, beats[downs])):
        at = np.round(times * RATE).astype(int)
        for shift, value in TARGET.items():
            place = at + shift
            place = place[(place >= 0) & (place < frames)]
            result[place, column] = np.maximum(result[place, column], value)
    return result


def read(path: str, causal: bool) -> tuple[np.ndarray, np.ndarray]:
    """Features (clips, frames, 2, bands) float16 and targets (clips, frames, 2)."""
    file = np.load(path)
    begins = np.concatenate([[0], file["ends"][:-1]])
    bands = file["bands"]
    features = np.stack([features_of(one, causal).astype(np.float16) for one in bands])
    stretches = [slice(b, e) for b, e in zip(begins, file["ends"], strict=True)]
    beats, downs = file["beats"], file["downs"]
    return features, np.stack([targets_of(beats[s], downs[s], bands.shape[1]) for s in stretches]).astype(np.float16)


def augmented(x: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Moved in pitch, tilted, with a stripe of bands missing."""
    move = int(rng.integers(-3, 4))
    x = np.roll(x, move, axis=-1)
    if move > 0:
        x[..., :move] = 0.0
    elif move < 0:
        x[..., move:] = 0.0
    if rng.random() < 0.5:
        tilt = rng.uniform(-0.4, 0.4) * np.linspace(-0.5, 0.5, x.shape[-1]) + rng.uniform(-0.15, 0.15)
        x[:, 0] = np.maximum(x[:, 0] + tilt.astype(np.float32), 0.0)
    if rng.random() < 0.3:
        begin = int(rng.integers(0, x.shape[-1]))
        x[..., begin : begin + int(rng.integers(4, 16))] = 0.0
    return x


def loss_of(logits: torch.Tensor, target: torch.Tensor) -> torch.Tensor:
    """Cross-entropy; a downbeat counts as much as a beat although it is rarer."""
    weight = 1.0 + 2.0 * target
    each = functional.binary_cross_entropy_with_logits(logits, target, weight=weight, reduction="none").mean(dim=(0, 1))
    return each[0] + 1.5 * each[1]


def main() -> None:
    """Train for some minutes, keep the best on the validation clips."""
    out, causal, minutes = Path(sys.argv[1]), sys.argv[2] == "causal", float(sys.argv[3])
    torch.manual_seed(0)
    torch.set_num_threads(int(sys.argv[4]))
    rng = np.random.default_rng(0)
    held, held_target = read(sys.argv[5], causal)
    parts = [read(path, causal) for path in sys.argv[6:]]
    data, target = np.concatenate([p[0] for p in parts]), np.concatenate([p[1] for p in parts])
    model = Activation(causal).to(memory_format=torch.channels_last)
    highest = 4e-3
    if out.with_suffix(".start.pt").exists():  # to go on from weights that are there
        model.load_state_dict(torch.load(out.with_suffix(".start.pt"), weights_only=True))
        highest = 2.5e-3
    print("parameters", sum(p.numel() for p in model.parameters()), "clips", len(data), flush=True)
    optimiser = torch.optim.AdamW(model.parameters(), lr=1e-3, weight_decay=1e-4)
    begun, best, epoch, step = time.monotonic(), np.inf, 0, 0
    while (done := (time.monotonic() - begun) / (60 * minutes)) < 1.0:
        model.train()
        total = 0.0
        order = rng.permutation(len(data))
        for begin in range(0, len(order) - BATCH + 1, BATCH):
            done = min((time.monotonic() - begun) / (60 * minutes), 1.0)
            pace = highest * (min(done / 0.1, 1.0) if done < 0.1 else 0.5 + 0.5 * np.cos(np.pi * (done - 0.1) / 0.9))
            for group in optimiser.param_groups:
                group["lr"] = max(pace, 2e-5)
            pick = order[begin : begin + BATCH]
            x = np.stack([augmented(data[one].astype(np.float32), rng) for one in pick])
            loss = loss_of(model(torch.from_numpy(x.swapaxes(1, 2))), torch.from_numpy(target[pick].astype(np.float32)))
            optimiser.zero_grad()
            loss.backward()
            torch.nn.utils.clip_grad_norm_(model.parameters(), 1.0)
            optimiser.step()
            total += float(loss.detach())
            step += 1
            if done >= 1.0:
                break
        epoch += 1
        model.eval()
        with torch.no_grad():
            values = [
                float(
                    loss_of(
                        model(torch.from_numpy(held[b : b + 20].astype(np.float32).swapaxes(1, 2))),
                        torch.from_numpy(held_target[b : b + 20].astype(np.float32)),
                    )
                )
                for b in range(0, len(held), 20)
            ]
        value = float(np.mean(values))
        torch.save(model.state_dict(), out)
        if value < best:
            best = value
            torch.save(model.state_dict(), out.with_suffix(".best.pt"))
        mean = total / max(len(order) // BATCH, 1)
        print(f"epoch {epoch} step {step} {60 * minutes * done:.0f} s: {mean:.4f} held {value:.4f}", flush=True)


if __name__ == "__main__":
    main()
