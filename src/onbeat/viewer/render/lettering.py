"""Short lines of text on a picture."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from onbeat._shapes import Array
from onbeat.viewer.figure import Colour


@lru_cache(maxsize=512)
def _coverage(text: str, height: int) -> Array:
    """0…1: how much of each pixel a line of text covers; the font is the one that comes with matplotlib."""
    canvas = FigureCanvasAgg(Figure(figsize=((len(text) + 2) * height / 100, height * 1.5 / 100), dpi=100))
    canvas.figure.patch.set_alpha(0.0)
    canvas.figure.text(0.02, 0.5, text, fontsize=height * 0.72, family="DejaVu Sans", va="center")
    canvas.draw()
    covered = np.asarray(canvas.buffer_rgba())[..., 3] / 255.0
    used = np.flatnonzero(covered.any(0))
    return covered[:, used[0] : used[-1] + 1] if len(used) else covered[:, :1]


def write_text(picture: np.ndarray, text: str, left: int, top: int, height: int, colour: Colour) -> None:
    """Write a line of text of about ``height`` pixels into a picture (H, W, 3) uint8; what lies outside is cut off."""
    covered = _coverage(text, height)
    part = picture[max(top, 0) : top + covered.shape[0], max(left, 0) : left + covered.shape[1]]
    mix = covered[: part.shape[0], : part.shape[1], None]
    part[...] = np.round(part * (1 - mix) + np.asarray(colour) * mix).astype(np.uint8)
