"""What was shown lately, and what showing it again costs: a price that fades, so that the dance does not loop."""

from __future__ import annotations

from collections import deque

import numpy as np

from onbeat._shapes import Float32, Ints
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary

PRICE = 1.5
"""What a second costs that was shown a moment ago, in units of a stop on its beat."""
FADES = 60.0
"""Seconds in which the price falls to 1/e of it."""
MIRRORED = 0.4
"""What the mirror image of what was shown costs, as a share of the price."""
KEPT = 60.0
"""Seconds that can be taken back."""


class Recent:
    """When each frame of a library was shown last.

    Parameters
    ----------
    library : the clips that are danced.
    price : see ``PRICE``; 0 for a dance that may repeat itself.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> clip = SimpleNamespace(poses=np.zeros((4, 1)), source=0, mirrored=False)
    >>> recent = Recent(SimpleNamespace(clips=[clip]))
    >>> recent.show(np.array([1, 2]))
    >>> (recent.prices() * GRID).round(1).tolist()
    [0.0, 1.5, 1.5, 0.0]
    """

    def __init__(self, library: MoveLibrary, price: float = PRICE) -> None:
        self.price, self.now = price, 0.0
        self._twins = mirror_images(library)
        self._shown = np.full(len(self._twins), -np.inf)
        self._log = deque[tuple[int, float]](maxlen=round(KEPT * GRID))

    def show(self, frames: Ints) -> None:
        """Frames (n,) are shown next, one after the other."""
        for frame in frames.tolist():
            self._log.append((frame, float(self._shown[frame])))
            self._shown[frame] = self.now
            self.now += 1 / GRID

    def take_back(self, to: int) -> None:
        """The dance goes on at frame ``to``: what was to be shown from there on is not, if it is known."""
        places = [place for place, (frame, _) in enumerate(self._log) if frame == to]
        if not places or to == self._log[-1][0] + 1:
            return
        while len(self._log) > places[-1]:
            frame, before = self._log.pop()
            self._shown[frame] = before
            self.now -= 1 / GRID

    def prices(self) -> Float32:
        """(N,) what showing each frame costs now, float32."""
        fade = self.price / GRID * np.exp((self._shown - self.now) / FADES)
        twins = np.where(self._twins >= 0, MIRRORED * fade[self._twins], 0.0)
        return np.maximum(fade, twins).astype(np.float32)


def mirror_images(library: MoveLibrary) -> Ints:
    """(N,) the frame that shows each frame's mirror image, −1 where the library has none."""
    starts = np.concatenate(([0], np.cumsum([len(clip.poses) for clip in library.clips])))
    twins = np.full(int(starts[-1]), -1, np.int64)
    kinds: dict[tuple[int, int, bool], list[int]] = {}
    for number, clip in enumerate(library.clips):
        kinds.setdefault((clip.source, len(clip.poses), clip.mirrored), []).append(number)
    for (source, length, mirrored), numbers in kinds.items():
        others = kinds.get((source, length, not mirrored), [])
        for number, other in zip(numbers, others, strict=False):
            twins[starts[number] : starts[number] + length] = starts[other] + np.arange(length)
    return twins
