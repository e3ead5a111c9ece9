"""Dancing without a choreography: what comes next is chosen from a motion graph, on the beats to come."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Float32, Times
from onbeat.live.choice.improviser import Chosen, Improviser
from onbeat.live.choice.pickers import Choice, Piece
from onbeat.live.choice.timeline import Ahead

DOWNBEAT = 1.0
OTHER = 0.85
"""What stops on downbeats and on other beats are worth."""
NEAR = 0.12
"""Seconds from a beat, within which a stop is put on it."""
BEGIN = 2.0
"""Seconds that a beginning lasts at least."""
BEFORE = 0.5
"""Seconds before, whose beats still count for the stops that a join changes."""
NAME = "improvised"


class Improvised:
    """Dances the moves of a library as they fit the music.

    Parameters
    ----------
    improviser : who searches.
    names : of the library's clips, by their place.
    resting : (D,) the pose vector of the body at ease, near which a dance begins.
    """

    def __init__(self, improviser: Improviser, names: tuple[str, ...], resting: Float32 | None = None) -> None:
        self._improviser, self._clips, self._resting = improviser, names, resting
        self._at: tuple[int, float] | None = None
        self._since_join = 0.0
        self._asked = False

    @property
    def names(self) -> tuple[str, ...]:
        """The only thing that can be asked for."""
        return (NAME,)

    def ask(self, name: str) -> bool:
        """Begin anew, anywhere."""
        self._asked = name in ("", NAME)
        return self._asked

    def begin(self, at: float, ahead: Ahead) -> Choice:
        """The best beginning: from rest near a pose at ease, else anywhere."""
        self._at, self._since_join = None, 0.0
        beats, weights = _beats(at, ahead)
        anywhere, self._asked = self._asked, False
        if anywhere:
            chosen = self._improviser.choose(None, 0.0, beats, weights, ahead.intensity, BEGIN)
        else:
            chosen = self._improviser.starts(beats, weights, ahead.intensity, BEGIN, pose=self._resting)
        return self._choice(chosen, at, ahead)

    def go_on(self, at: float, ahead: Ahead, seconds: float) -> Choice:
        """The best stretches from where the dance is."""
        beats, weights = _beats(at, ahead)
        chosen = self._improviser.choose(self._at, self._since_join, beats, weights, ahead.intensity, seconds)
        return self._choice(chosen, at, ahead)

    def _choice(self, chosen: Chosen, at: float, ahead: Ahead) -> Choice:
        pieces = tuple(Piece(part.clip, part.from_s, part.to_s) for part in chosen.stretches)
        self._remember(pieces)
        return Choice(pieces, _anchored(chosen, ahead, ahead.times - at), self._clips[pieces[-1].clip])

    def _remember(self, pieces: tuple[Piece, ...]) -> None:
        for piece in pieces:
            goes_on = self._at is not None and self._at[0] == piece.clip and abs(self._at[1] - piece.from_s) < 1e-6
            self._since_join = piece.lasts + (self._since_join if goes_on else 0.0)
            self._at = piece.clip, piece.to_s


def _beats(at: float, ahead: Ahead) -> tuple[Times, Array]:
    """Beats after a second of the timeline, and shortly before it, and what they are worth."""
    near = ahead.times > at - BEFORE
    return ahead.times[near] - at, np.where(ahead.positions[near] == 1, DOWNBEAT, OTHER)


def _anchored(chosen: Chosen, ahead: Ahead, beats: Times) -> tuple[tuple[int, float], ...]:
    """Each beat in what was chosen with the stop that is near it, else with its own second."""
    lasts = sum(part.to_s - part.from_s for part in chosen.stretches)
    out = list[tuple[int, float]]()
    for k, beat in enumerate(beats.tolist()):
        if not 0 < beat <= lasts:
            continue
        near = chosen.stops[np.abs(chosen.stops - beat) <= NEAR] if len(chosen.stops) else chosen.stops
        second = float(near[np.abs(near - beat).argmin()]) if len(near) else beat
        out.append((ahead.first + k, second))
    return tuple(out)
