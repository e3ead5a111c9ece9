"""Sound with faults at given seconds, as bad devices and cables give it: block by block of 10 ms."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
import soxr

Kind = Literal["gone", "silence", "nan", "inf", "dc", "clip", "mono", "6ch", "8k", "96k", "int16", "noise", "hum"]
RATES = {"8k": 8000, "96k": 96000}
HOP = 0.01  # [s]


@dataclass(frozen=True)
class Fault:
    """What is wrong from second ``start`` to second ``end``; several may be at once."""

    kind: Kind
    start: float
    end: float


def faulty(
    samples: np.ndarray, rate: int, faults: list[Fault], seed: int = 0
) -> Iterator[list[tuple[np.ndarray, int]]]:
    """For each 10 ms of samples (n,) or (n, channels): what a listener's ``read`` gives, a list of (block, rate)."""
    stereo = samples if samples.ndim == 2 else np.stack((samples, samples), axis=1)
    kinds = {fault.kind for fault in faults}
    at_rate = {kind: soxr.resample(stereo, rate, its) for kind, its in RATES.items() if kind in kinds}
    rng = np.random.default_rng(seed)
    for hop in range(int(len(stereo) / rate / HOP + 1e-9)):
        now = hop * HOP + 1e-9
        there = [fault.kind for fault in faults if fault.start <= now < fault.end]
        if "gone" in there:
            yield []
            continue
        kind = next((kind for kind in there if kind in RATES), None)
        sound, its = (at_rate[kind], RATES[kind]) if kind else (stereo, rate)
        begin, end = round(hop * HOP * its), round((hop + 1) * HOP * its)
        block = sound[begin:end].astype(np.float32)
        for kind in there:
            block = _spoiled(block, kind, now, its, rng)
        yield [(block, its)]


def _spoiled(block: np.ndarray, kind: Kind, now: float, rate: int, rng: np.random.Generator) -> np.ndarray:
    times = now + np.arange(len(block))[:, None] / rate
    if kind in ("nan", "inf"):
        block[rng.random(block.shape) < 0.3] = np.nan if kind == "nan" else np.inf
    changed = {
        "silence": lambda: 0.0 * block,
        "dc": lambda: block + np.float32(0.6),
        "clip": lambda: np.clip(30.0 * block, -1.0, 1.0),
        "mono": lambda: block.mean(axis=1),
        "6ch": lambda: np.concatenate((block, np.zeros((len(block), 4), np.float32)), axis=1),
        "int16": lambda: (32767 * np.clip(block, -1.0, 1.0)).astype(np.int16),
        "noise": lambda: 0.2 * rng.standard_normal(block.shape).astype(np.float32),
        "hum": lambda: np.broadcast_to(0.3 * np.sin(2 * np.pi * 50 * times), block.shape).astype(np.float32),
    }
    return changed[kind]() if kind in changed else block
