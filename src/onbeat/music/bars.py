"""Which beats are downbeats: the most likely meter and bar phase, from chord changes and the bass drum at the beats.

The weights are a logistic regression on songs of a procedural band; which cues are used was chosen with annotated
recordings in view, too.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import maximum_filter1d

from onbeat._shapes import Array, Bools, Float32, Ints
from onbeat.music.harmony.chords import fold_octaves

METERS = (2, 3, 4, 5, 6, 7)
METER_PRIOR = (0.02, 0.12, 0.8, 0.03, 0.02, 0.01)
PRIOR_BEATS = 160.0  # after so many the prior on meters counts once more: a longer song says the same again
BREAK = 0.002  # chance, at each bar, that another bar length follows or the bar starts anew
# The cues: distance of the harmony one beat and two beats before and after, accent in the lowest band.
CUE_WEIGHTS = np.array([0.40, 0.76, 1.02])
CUE_SCALES = np.array([0.15, 0.14, 2.1])  # least deviation taken for a signal: a drum solo has no harmony
BIAS = -0.5  # log odds of a beat with mean cues, over those of any beat
# The same beside the learned activation: by how much it finds a downbeat likelier than a beat. A regression on songs of
# the pattern generator in ``training/``, halved, for what is heard from beat to beat is not independent.
LEARNED_WEIGHT, BESIDE_WEIGHTS, BESIDE_BIAS = 0.56, np.array([0.14, 0.19, 0.1]), 0.44
NEAR = 3  # frames around a beat in which the learned activation is looked for


def harmony_distance(chroma: Array, span: int) -> Array:
    """One minus the cosine between the chroma of ``span`` beats from each beat on and of as many before: (B,).

    >>> harmony_distance(np.array([[1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), 1).tolist()
    [0.0, 0.0, 1.0]
    """
    sums = np.concatenate([np.zeros((1, chroma.shape[1])), np.cumsum(chroma, axis=0)])
    beat = np.arange(len(chroma))
    after = sums[np.minimum(beat + span, len(chroma))] - sums[beat]
    before = sums[beat] - sums[np.maximum(beat - span, 0)]
    lengths = np.linalg.norm(after, axis=1) * np.linalg.norm(before, axis=1)
    alike = (after * before).sum(axis=1) / np.maximum(lengths, 1e-9)
    return np.where(lengths > 1e-9, 1.0 - alike, 0.0)


def learned_downbeats(log_odds: Float32, beats: Ints) -> Array:
    """By how much each beat is likelier a downbeat than a beat (B,), from the learned log odds of both (N, 2)."""
    highest = maximum_filter1d(log_odds, 2 * NEAR + 1, axis=0)[np.clip(beats, 0, len(log_odds) - 1)]
    return (highest[:, 1] - highest[:, 0]).astype(np.float64)


def downbeat_log_odds(slices: Array, bass_accent: Array, learned: Array | None = None) -> Array:
    """How much more each beat sounds like a downbeat than like another beat: (B,) log likelihood ratios.

    Parameters
    ----------
    slices : (B, semitones) what sounds from each beat to the next.
    bass_accent : (B,) onset strength of the lowest band at each beat.
    learned : (B,) of :func:`learned_downbeats`, where there is a learned activation.
    """
    if not len(slices):
        return np.zeros(0)
    chroma = fold_octaves(slices)
    cues = np.stack([harmony_distance(chroma, 1), harmony_distance(chroma, 2), bass_accent], axis=1)
    scaled = np.clip((cues - cues.mean(axis=0)) / np.maximum(cues.std(axis=0), CUE_SCALES), -3.0, 3.0)
    if learned is None:
        return scaled @ CUE_WEIGHTS + BIAS
    return scaled @ BESIDE_WEIGHTS + LEARNED_WEIGHT * learned + BESIDE_BIAS


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
    downbeats, meter, _ = likeliest_bars(log_odds)
    return downbeats, meter


def likeliest_bars(log_odds: Array) -> tuple[Bools, int, float]:
    """As :func:`find_downbeats`, and the score: how much likelier those bars are than beats without bars (log)."""
    if not len(log_odds):
        return np.zeros(0, np.bool_), 4, 0.0
    meters, positions, change = _states()
    prior = np.log(np.array([METER_PRIOR[METERS.index(int(meter))] / meter for meter in meters]))
    usual = np.log(np.array(METER_PRIOR))[meters - METERS[0]] / PRIOR_BEATS
    heard = np.where(positions == 0, log_odds[:, None], 0.0) + usual
    score = prior + heard[0]
    came = np.zeros(heard.shape, np.int64)
    for beat in range(1, len(heard)):
        options = score[:, None] + change
        came[beat] = options.argmax(axis=0)
        score = options.max(axis=0) + heard[beat]
    state, highest = int(score.argmax()), float(score.max())
    path = [state]
    for beat in range(len(heard) - 1, 0, -1):
        state = int(came[beat, state])
        path.append(state)
    chain = np.array(path[::-1])
    return positions[chain] == 0, int(np.bincount(meters[chain]).argmax()), highest
