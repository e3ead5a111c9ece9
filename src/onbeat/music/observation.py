"""How much each moment sounds like a beat: the observation of the beat trackers, as log odds.

Onsets and harmony are always there and know no style; the learned activation knows what music does. They fail on
different pieces, so the default method weighs all three. The default's weights were chosen with songs of the pattern
generator of ``training/`` alone, played by timbres that the network never heard; those of the onsets by themselves with
songs of a procedural band and with annotated recordings in view.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Float32
from onbeat.music.harmony.chords import new_harmony
from onbeat.music.hearing import Hearing

SOFT = 1.5  # onset strength, of root mean square 1, at which the activation is a half
EMPTY = 0.3  # activation at which a moment is as likely a beat as not
GAIN = 8.0  # log odds per unit of activation, where onsets are all there is
HARMONY_GAIN = 2.0  # log odds per unit of new harmony, of root mean square 1, likewise
NO_HARMONY = 0.9  # new harmony that says nothing either way

LEARNED = 1.0  # per unit of the learned log odds
RARE = 0.5  # added to them: a beat is heard in few of the frames around it
ONSETS_BESIDE, HARMONY_BESIDE = 2.0, 1.0  # as GAIN and HARMONY_GAIN, beside the learned activation


def unit_power(values: Array) -> Array:
    """Values scaled to a root mean square of 1; silence stays silence."""
    return values / max(float(np.sqrt((values**2).mean())), 1e-9) if len(values) else values


def activation(strength: Array) -> Array:
    """Onset strength squashed to 0…1.

    >>> activation(np.array([0.0, 1.5])).tolist()
    [0.0, 0.5]
    """
    squared = strength**2
    return squared / (squared + SOFT**2)


def harmony_at_frames(hearing: Hearing) -> Array:
    """New harmony at the frames of the onsets (N,), of unit power."""
    harmony = new_harmony(hearing.tones, hearing.tone_rate)
    times = np.arange(len(hearing.bands)) / hearing.onset_rate
    return unit_power(np.interp(times, np.arange(len(harmony)) / hearing.tone_rate, harmony))


def onset_log_odds(strength: Array, harmony: Array) -> Array:
    """Log odds (N,) that a beat lies at each frame, from onset strength and new harmony (N,), each of unit power.

    New harmony keeps slow songs whose eighths are as loud as their beats from being heard twice as fast.
    """
    return GAIN * (activation(strength) - EMPTY) + HARMONY_GAIN * (harmony - NO_HARMONY)


def beat_log_odds(learned: Array | Float32, strength: Array, harmony: Array) -> Array:
    """Log odds (N,) as :func:`onset_log_odds`, with the learned activation's (N,) weighed in.

    >>> odds = beat_log_odds(np.array([-5.0, 3.0]), np.array([0.0, 3.0]), np.array([0.9, 0.9]))
    >>> odds.round(2).tolist()
    [-5.1, 4.5]
    """
    beside = ONSETS_BESIDE * (activation(strength) - EMPTY) + HARMONY_BESIDE * (harmony - NO_HARMONY)
    return LEARNED * learned.astype(np.float64) + RARE + beside
