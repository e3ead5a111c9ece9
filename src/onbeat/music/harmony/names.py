"""Which chord sounds from each beat to the next: major and minor triads, by templates and the likeliest sequence."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Bools

TONES = ("C", "C#", "D", "Eb", "E", "F", "F#", "G", "Ab", "A", "Bb", "B")
NO_CHORD = "N"
TRIADS = {"maj": (0, 4, 7), "min": (0, 3, 7)}
OVERTONES = ((0, 1.0), (0, 0.6), (7, 0.36), (0, 0.22), (4, 0.13))  # semitones above a tone, in one octave; how strong
BASS_SHARE = 0.25  # what the bass says of the root, beside the triad
UNSURE = 0.55  # likeness of a triad at which it is as likely that no chord sounds
SHARPNESS = 12.0  # log odds per unit of likeness
CHANGE, CHANGE_AT_BAR = -3.0, -1.0  # log chance that another chord begins at a beat; at a downbeat
FAINT = 0.05  # of the usual sum of tones, under which nothing sounds


def chord_templates() -> Array:
    """Chroma (24, 12) of the triads and their overtones, mean 0 and length 1: twelve major, twelve minor, from C."""
    rows: list[Array] = []
    for steps in TRIADS.values():
        chroma = np.zeros(12)
        for step in steps:
            for above, strength in OVERTONES:
                chroma[(step + above) % 12] += strength
        rows += [np.roll(chroma, root) for root in range(12)]
    return _centred(np.array(rows))


def _centred(chroma: Array) -> Array:
    rest = chroma - chroma.mean(axis=-1, keepdims=True)
    return rest / np.maximum(np.linalg.norm(rest, axis=-1, keepdims=True), 1e-9)


def chord_likeness(chroma: Array) -> Array:
    """Correlation of each slice of chroma (B, 2, 12; bass, rest) with the 24 triads, and the bass with their root."""
    whole = _centred(chroma.sum(axis=1)) @ chord_templates().T
    bass = _centred(chroma[:, 0])
    return (1.0 - BASS_SHARE) * whole + BASS_SHARE * np.concatenate([bass, bass], axis=1)


def name_chords(chroma: Array, downbeats: Bools) -> list[str]:
    """The likeliest sequence of chords (Viterbi), which change at downbeats rather than at other beats.

    Parameters
    ----------
    chroma : (B, 2, 12) from each beat to the next, C first; the bass and the rest.
    downbeats : (B,) whether a bar begins there.

    Returns
    -------
    B names as ``C:maj``, ``A:min`` or ``N`` (Harte 2010).

    Examples
    --------
    >>> chroma = np.zeros((2, 2, 12))
    >>> chroma[:, 1, [9, 0, 4]] = 1.0
    >>> name_chords(chroma, np.array([True, False]))
    ['A:min', 'A:min']
    """
    if not len(chroma):
        return []
    total = chroma.sum(axis=(1, 2))
    heard = SHARPNESS * np.pad(chord_likeness(chroma) - UNSURE, ((0, 0), (0, 1)))
    heard[total <= FAINT * np.median(total), :-1] = -2.0 * SHARPNESS
    path = _likeliest(heard, np.where(downbeats, CHANGE_AT_BAR, CHANGE))
    names = [f"{tone}:{triad}" for triad in TRIADS for tone in TONES]
    return [*map([*names, NO_CHORD].__getitem__, path)]


def _likeliest(heard: Array, change: Array) -> list[int]:
    """The best path over states that are kept, or left for any other at the cost of the beat."""
    score, came = heard[0], np.zeros(heard.shape, np.int64)
    states = np.arange(heard.shape[1])
    for beat in range(1, len(heard)):
        best = int(score.argmax())
        moved = score[best] + change[beat]
        came[beat] = np.where(score >= moved, states, best)
        score = np.maximum(score, moved) + heard[beat]
    path = [int(score.argmax())]
    for beat in range(len(heard) - 1, 0, -1):
        path.append(int(came[beat, path[-1]]))
    return path[::-1]
