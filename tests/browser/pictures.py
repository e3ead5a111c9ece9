"""Pictures of pages, held against references that somebody has looked at and found good.

A reference is a page that stands still, in a window of a given size, with given fonts. Two pictures are compared by the
mean colours of squares, each of which may be a little aside: edges and letters that are drawn a little otherwise do not
count, and what is missing, elsewhere or of another colour does. ``ONBEAT_REFERENCES=write`` puts new pictures in place
of the references: look at them.
"""

from __future__ import annotations

import io
import os
import sys
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import get_data_path
from PIL import Image, ImageChops

REFERENCES = Path(__file__).with_name("references")
SQUARE = 8
"""Pixels of a square's side."""
ASIDE = (-2, -1, 0, 1, 2)
"""Pixels by which a square may be elsewhere."""
MEAN, WORST = 0.004, 0.11
"""Most that the squares of two pictures of one thing differ, of 1: on the whole, and one of them.

The same chromium draws the same (0.000), another renderer nearly (0.024), letters fitted to the pixels on pages
with a dancer within 0.1. A dancer that is a seventh darker: 0.125 and more; a button that is missing: 0.125; a line of
words: 0.17; a title 12 pixels aside: 0.44; all lanes: 0.57; another theme: a mean of 0.7.
"""
SIZE = (1280, 800)
FONTS = """<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "urn:fontconfig:fonts.dtd">
<fontconfig>
  <dir>{fonts}</dir>
  <cachedir>{cache}</cachedir>
  <match target="pattern"><edit name="family" mode="append"><string>DejaVu Sans</string></edit></match>
  <match target="font">
    <edit name="hinting" mode="assign"><bool>false</bool></edit>
    <edit name="rgba" mode="assign"><const>none</const></edit>
  </match>
</fontconfig>
"""
STILL = """async () => {
    document.activeElement?.blur();
    for (let i = 0; i < 3; i++) await new Promise(requestAnimationFrame);
}"""
AS_THE_MACHINE_HAS_IT = "try { localStorage.removeItem('onbeat live theme') } catch { /* it keeps nothing */ }"


def own_fonts(folder: Path) -> dict[str, str]:
    """The environment of a browser that knows only the fonts that matplotlib brings: the same on every machine."""
    config = folder / "fonts.conf"
    config.write_text(FONTS.format(fonts=Path(get_data_path()) / "fonts" / "ttf", cache=folder / "cache"))
    return {**os.environ, "FONTCONFIG_FILE": str(config)}


@dataclass(frozen=True)
class Distance:
    """How far apart two pictures are, and where most: the pixel at the middle of the worst square."""

    mean: float
    worst: float
    at: tuple[int, int]

    @property
    def near(self) -> bool:
        return self.mean <= MEAN and self.worst <= WORST

    def __str__(self) -> str:
        return f"mean {self.mean:.4f} (at most {MEAN}), worst {self.worst:.3f} at {self.at} (at most {WORST})"


def rounded(picture: Image.Image) -> Image.Image:
    """The picture with 64 levels of each colour: half as large a file, and nobody sees it."""
    return picture.convert("RGB").point([min(4 * round(level / 4), 255) for level in range(256)] * 3)


def squares(picture: Image.Image) -> np.ndarray:
    """Mean colours of squares (rows, columns, 3) in 0…1."""
    return np.asarray(picture.convert("RGB").reduce(SQUARE), np.float64) / 255


def distance(one: Image.Image, other: Image.Image) -> Distance:
    """How far apart two pictures of one size are."""
    if one.size != other.size:
        return Distance(1.0, 1.0, (0, 0))
    there = squares(other)
    moved = (ImageChops.offset(one, *by) for by in product(ASIDE, ASIDE))
    off = np.min([np.abs(squares(each) - there).max(axis=2) for each in moved], axis=0)
    row, column = np.unravel_index(off.argmax(), off.shape)
    middle = (int(column) * SQUARE + SQUARE // 2, int(row) * SQUARE + SQUARE // 2)
    return Distance(float(off.mean()), float(off.max()), middle)


class Pictures:
    """Takes pictures of pages and holds them against the references; those that differ are put into a test's folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._before: dict[Any, Any] = {}

    def look(self, page: Any, name: str, size: tuple[int, int] = SIZE, *, dark: bool = False) -> None:
        """The page looks as it did when somebody last looked at it; it stands still until the test is over."""
        self._before.setdefault(page, page.viewport_size)
        page.evaluate(AS_THE_MACHINE_HAS_IT)
        page.emulate_media(color_scheme="dark" if dark else "light", reduced_motion="reduce")
        page.set_viewport_size({"width": size[0], "height": size[1]})
        page.mouse.move(0, 0)
        page.evaluate(STILL)
        shown = page.screenshot(animations="disabled", caret="hide", scale="css")
        self.compare(rounded(Image.open(io.BytesIO(shown))), name)

    def end(self) -> None:
        """The pages are as they were; first their size, for small ones are sooner drawn again."""
        for page, size in self._before.items():
            page.set_viewport_size(size)
            page.emulate_media(color_scheme="light", reduced_motion="no-preference")

    def compare(self, picture: Image.Image, name: str) -> None:
        kept, new = REFERENCES / f"{name}.webp", self.folder / f"{name}.png"
        if os.environ.get("ONBEAT_REFERENCES") == "write":
            kept.parent.mkdir(exist_ok=True)
            picture.save(kept, lossless=True, quality=100, method=6)
            return
        if not sys.platform.startswith("linux"):
            return  # letters are drawn otherwise there, whatever their font
        assert kept.exists(), f"there is no reference {kept}: make it with ONBEAT_REFERENCES=write, and look at it"
        found = distance(picture, Image.open(kept))
        if not found.near:
            picture.save(new)
        assert found.near, f"{new} is not like {kept}: {found}. If it is right, ONBEAT_REFERENCES=write keeps it"
