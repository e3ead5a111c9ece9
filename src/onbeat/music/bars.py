"""Which beats are downbeats: the most likely meter and bar phase, from chord changes and accents at the beats."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Bools, Ints

METERS = (2, 3, 4, 5, 6, 7)
METER_PRIOR = (0.02, 0.12, 0.8, 0.03, 0.02, 0.01)
BREAK = 0.002  # chance, at each bar, that another bar length follows or the bar starts anew
USUAL_SHARE = 0.25  # of the beats are downbeats


def standardised(values: Array) -> Array:
    """Values with mean 0 and deviation 1, clipped to ±3."""
    return np.clip((values - values.mean()) / max(float(values.std()), 1e-9), -3.0, 3.0)


def downbeat_log_odds(cues: Array, weights: Array) -> Array:
    """Log odds that each beat is a downbeat: (B,), from cues (B, C) with how much each says (C,)."""
    columns = np.stack([standardised(column) for column in cues.T], axis=1)
    return columns @ weights + np.log(USUAL_SHARE / (1.0 - USUAL_SHARE))


def _states() -> tuple[Ints, Ints, Array]:
    """Meter and position in the bar of each state, and the log chance (from, to)."""
    meters = np.array([meter for meter in METERS for _ in range(meter)])
    positions = np.array([position for meter in METERS for position in range(meter)])
    starts = np.flatnonzero(positions == 0)
    chance = np.zeros((len(meters), len(meters)))
    for state, (meter, position) in enumerate(zip(meters, positions, strict=True)):
        if position + 1 < meter:
            chance[state, state + 1] = 1.0 - BREAK / meter
            chance[state, starts] += BREAK / meter * np.array(METER_PRIOR)
        else:
            chance[state, starts] += BREAK * np.array(METER_PRIOR)
            chance[state, state - position] += 1.0 - BREAK
    return meters, positions, np.log(np.maximum(chance, 1e-12))


def find_downbeats(log_odds: Array) -> tuple[Bools, int]:
    """Downbeats (B,) and the most frequent meter, by Viterbi over meter × position in the bar."""
    if not len(log_odds):
        return np.zeros(0, np.bool_), 4
    meters, positions, change = _states()
    prior = np.log(np.array([METER_PRIOR[METERS.index(int(meter))] / meter for meter in meters]))
    heard = np.where(positions == 0, -np.logaddexp(0.0, -log_odds)[:, None], -np.logaddexp(0.0, log_odds)[:, None])
    score = prior + heard[0]
    came = np.zeros(heard.shape, np.int64)
    for beat in range(1, len(heard)):
        options = score[:, None] + change
        came[beat] = options.argmax(axis=0)
        score = options.max(axis=0) + heard[beat]
    state = int(score.argmax())
    path = [state]
    for beat in range(len(heard) - 1, 0, -1):
        state = int(came[beat, state])
        path.append(state)
    chain = np.array(path[::-1])
    return positions[chain] == 0, int(np.bincount(meters[chain]).argmax())
