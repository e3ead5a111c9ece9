"""The key of a song: which of the 24 profiles of tones its chroma is like."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array
from onbeat.music.harmony.names import TONES

# How well each tone fits into a key, as listeners rated it (Krumhansl & Kessler 1982): from the tonic up.
MAJOR = (6.35, 2.23, 3.48, 2.33, 4.38, 4.09, 2.52, 5.19, 2.39, 3.66, 2.29, 2.88)
MINOR = (6.33, 2.68, 3.52, 5.38, 2.60, 3.53, 2.54, 4.75, 3.98, 2.69, 3.34, 3.17)
UNSURE = 0.7  # correlation below which a song has no key: a single tone has 0.68


def find_key(chroma: Array) -> str:
    """``G:minor``: the key whose profile correlates best with the chroma (12,) of a song; empty where none does.

    >>> find_key(np.array([3.0, 0.0, 1.0, 0.0, 2.0, 1.0, 0.0, 2.0, 0.0, 1.0, 0.0, 1.0]))
    'C:major'
    >>> find_key(np.zeros(12))
    ''
    """
    if chroma.std() < 1e-9:
        return ""
    profiles = np.array([np.roll(profile, tone) for profile in (MAJOR, MINOR) for tone in range(12)])
    likeness = [float(np.corrcoef(profile, chroma)[0, 1]) for profile in profiles]
    best = int(np.argmax(likeness))
    return f"{TONES[best % 12]}:{'minor' if best >= 12 else 'major'}" if likeness[best] > UNSURE else ""
