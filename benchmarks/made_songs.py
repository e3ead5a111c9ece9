"""Songs by the embedded band at any course of tempo, whose beats are known."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from onbeat.examples.arrangement import LEAD, RING, Grid, form
from onbeat.examples.harmony import choose_progressions
from onbeat.examples.mixing import master
from onbeat.examples.score import write_score
from onbeat.examples.song import perform

RATE = 44100
Tempo = Callable[[float], float]
"""Beats per minute at a second."""


def beats_at(tempo: Tempo, seconds: float, meter: int = 4) -> np.ndarray:
    """Beats of whole bars that fit into so many seconds."""
    beats = [LEAD]
    while beats[-1] + 60 / tempo(beats[-1]) < seconds - RING:
        middle = beats[-1] + 30 / tempo(beats[-1])
        beats.append(beats[-1] + 60 / tempo(middle))
    return np.array(beats[: (len(beats) - 1) // meter * meter + 1])


def made_song(tempo: Tempo, seconds: float, seed: int = 0, meter: int = 4) -> tuple[np.ndarray, np.ndarray]:
    """Mono samples at 44.1 kHz and the beats in seconds."""
    rng = np.random.default_rng([seed, 7])
    grid = Grid(beats_at(tempo, seconds, meter), meter)
    score = write_score(grid, form(grid.bars), choose_progressions(rng), rng)
    samples = master(perform(score, seconds, seed).mix(np.random.default_rng([seed, 2])), fade=1.6)
    return samples.mean(axis=1).astype(np.float32), np.array(score.grid.beats)


def steady(bpm: float) -> Tempo:
    """One tempo."""
    return lambda second: bpm


def ramp(bpm: float, share: float, begin: float, lasts: float) -> Tempo:
    """From one tempo to another that is a share of it faster, evenly."""
    return lambda second: bpm * (1 + share * np.clip((second - begin) / lasts, 0, 1))


def steps(bpm: float, share: float, every: float) -> Tempo:
    """A step by a share up, and down again, in turn."""
    return lambda second: bpm * (1 + share * (int(second / every) % 2))
