"""Pictures of a dancer in few dimensions: the worst posture beside the original, and one moment by dimensions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from onbeat._shapes import Array
from onbeat.keyposes.judging import SPACES
from onbeat.keyposes.lowdim import LowDimensional
from onbeat.motion import Motion
from onbeat.viewer.figure import Figure, ground_height
from onbeat.viewer.render.camera import Size, follow
from onbeat.viewer.render.lettering import write_text
from onbeat.viewer.render.raster import render_frame
from onbeat.viewer.render.stage import Stage
from onbeat.viewer.sheet import write_png

CAPTION, GAP = 40, 12
"""Pixels above a picture that tell how its moment was picked, and between two pictures."""
TITLES = {"keyposes": "the keypose space", "uniform": "uniform sampling"}
SIDE = 1.35
"""Radians off the front from where the second row of pictures is taken."""


def worst_posture(found: LowDimensional, ours: str = "keyposes", theirs: str = "uniform") -> tuple[int, int] | None:
    """Motion and frame that are most unnatural in one space and not in the other; None where there is none."""
    best, worst = 0.0, None
    for which in range(len(found.motions)):
        mine, other = (found.unnatural(which, space, played=True) for space in (ours, theirs))
        amount = np.where(mine.postures, 0.0, _amount(other.through, other.beyond))
        frame = int(amount.argmax())
        if amount[frame] > best:
            best, worst = float(amount[frame]), (which, frame)
    return worst


def most_different(found: LowDimensional, ours: str = "keyposes", theirs: str = "uniform") -> tuple[int, int]:
    """Motion and frame at which one space is further off the original than the other is, by most."""
    best, at = -np.inf, (0, 0)
    for which, vectors in enumerate(found.vectors):
        mine, other = (np.linalg.norm(found.poses(which, name) - vectors.values, axis=1) for name in (ours, theirs))
        frame = int((other - mine).argmax())
        if other[frame] - mine[frame] > best:
            best, at = float(other[frame] - mine[frame]), (which, frame)
    return at


def write_lowdim_pictures(folder: Path, found: LowDimensional) -> list[str]:
    """Draw the pictures to a folder; their names.

    ``unnatural.png`` where one space makes an unnatural posture and the other does not, else ``postures.png`` of the
    moments at which they differ most; ``dimensions.png``. The first shows both sides: a moment picked against uniform
    sampling and one picked against keyposes.
    """
    worst = [worst_posture(found, *spaces) for spaces in (SPACES, SPACES[::-1])]
    name = "unnatural.png" if any(worst) else "postures.png"
    write_png(folder / name, both_sides(found, worst if any(worst) else None))
    write_png(folder / "dimensions.png", dimensions_picture(found, 0, telling_frame(found, 0)))
    return [name, "dimensions.png"]


def both_sides(
    found: LowDimensional, unnatural: Sequence[tuple[int, int] | None] | None, size: Size = (300, 380)
) -> np.ndarray:
    """Two pictures of postures beside each other, each with how it was picked: against uniform sampling, and keyposes.

    Parameters
    ----------
    found : the motions.
    unnatural : motion and frame of the worst posture of uniform sampling and of keyposes, see :func:`worst_posture`;
        None where there is none, and that is written. Without it the moments are those of :func:`most_different`.
    size : of each picture in them.
    """
    sides: list[np.ndarray] = []
    for number, spaces in enumerate((SPACES, SPACES[::-1])):
        other, of = (TITLES[name] for name in spaces)
        picked = most_different(found, *spaces) if unnatural is None else unnatural[number]
        if picked is None:
            blank = np.full((2 * size[1], 3 * size[0], 3), 255, np.uint8)
            sides.append(_captioned(blank, f"none where {of} alone is unnatural"))
            continue
        how = f"most unnatural, {other} not" if unnatural else f"farthest from the original compared with {other}"
        sides.append(_captioned(posture_picture(found, *picked, size), f"picked where {of} is {how}"))
    return np.hstack((sides[0], np.full((len(sides[0]), GAP, 3), 255, np.uint8), sides[1]))


def _captioned(picture: np.ndarray, words: str) -> np.ndarray:
    band = np.full((CAPTION, picture.shape[1], 3), 255, np.uint8)
    write_text(band, words, 10, 8, 20, (60, 66, 74))
    return np.vstack((band, picture))


def _amount(through: Array, beyond: Array) -> Array:
    """How unnatural: 3 cm through a bone count as 10° beyond a joint's range."""
    return np.maximum(np.maximum(through / 0.03, beyond / 0.17), 0.0)


def posture_picture(found: LowDimensional, which: int, frame: int, size: Size = (300, 380)) -> np.ndarray:
    """Figs. 13 and 14: keyposes, original and uniform sampling at one moment, from the front and from the side.

    Returns
    -------
    (2 * height, 3 * width, 3) uint8.
    """
    moments = [
        found.motion(which, "keyposes")[frame : frame + 1],
        found.motions[which][frame : frame + 1],
        found.motion(which, "uniform")[frame : frame + 1],
    ]
    titles = ("keyposes", "original", "uniform")
    rows = [_row(moments, found.motions[which], titles if side < 1 else (), size, side) for side in (0.3, SIDE)]
    return np.vstack(rows)


def dimensions_picture(found: LowDimensional, which: int, frame: int, size: Size = (300, 380)) -> np.ndarray:
    """Fig. 10: one moment in 1, 2, 3 and 4 dimensions of the keypose space, and the original."""
    most = min(4, len(found.spaces["keyposes"]))
    moments = [found.motion(which, "keyposes", dims)[frame : frame + 1] for dims in range(1, most + 1)]
    titles = [f"{dims} dimension{'s' * (dims > 1)}" for dims in range(1, most + 1)]
    moments.append(found.motions[which][frame : frame + 1])
    return _row(moments, found.motions[which], (*titles, "original"), size, 0.3)


def telling_frame(found: LowDimensional, which: int) -> int:
    """A frame in the middle of a person's cycle's most outstretched keypose."""
    one = found.taught[which]
    reach = np.linalg.norm(one.vectors.at(one.keyposes) - found.spaces["keyposes"].mean, axis=1)
    return min(round(float(one.keyposes[reach.argmax()]) * one.vectors.fps), len(one.vectors) - 1)


def _row(
    moments: list[Motion], original: Motion, titles: tuple[str, ...] | list[str], size: Size, side: float
) -> np.ndarray:
    figure = Figure.of(original.skeleton)
    ground = ground_height(figure, original)
    paths = [follow(moment, figure, ground, size=size, smoothing=0.0, side=side, elevation=0.12) for moment in moments]
    distance = max(float(path.distances[0]) for path in paths)
    pictures: list[np.ndarray] = []
    for number, (moment, path) in enumerate(zip(moments, paths, strict=True)):
        # The same camera for all, that of the first: what differs is the posture.
        camera = replace(paths[0], distances=np.full(1, distance), targets=path.targets)[0]
        picture = render_frame(moment.positions[0], figure, camera, size, Stage.lit_from(path.azimuth, ground, fine=3))
        if number < len(titles):
            write_text(picture, titles[number], 10, 8, 18, (90, 96, 104))
        pictures.append(picture)
    return np.hstack(pictures)
