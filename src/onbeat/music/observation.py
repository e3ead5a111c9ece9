"""How much each moment sounds like a beat: the observation of the beat tracker, as log odds.

A learned activation a(t) can stand in for what is here by ``log(a / (1 − a))``: anything above 0 at beats and below it
elsewhere will do. The constants were chosen with songs of a procedural band and
with annotated recordings in view, so the figures on those recordings are somewhat hopeful.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array

SOFT = 1.5  # onset strength, of root mean square 1, at which the activation is a half
EMPTY = 0.3  # activation at which a moment is as likely a beat as not
GAIN = 8.0  # log odds per unit of activation
HARMONY_GAIN = 2.0  # log odds per unit of new harmony, of root mean square 1
NO_HARMONY = 0.9  # new harmony that says nothing either way


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


def beat_log_odds(strength: Array, new_harmony: Array) -> Array:
    """Log odds (N,) that a beat lies at each frame, from onset strength and new harmony (N,), each of unit power.

    New harmony keeps slow songs whose eighths are as loud as their beats from being heard twice as fast.
    """
    return GAIN * (activation(strength) - EMPTY) + HARMONY_GAIN * (new_harmony - NO_HARMONY)
