"""``pupil.png``: a pupil's body coloured by how far it is from a master's, part by part, and where it is farthest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from onbeat._shapes import Array, Ints
from onbeat.motion import Motion
from onbeat.recognition.ghost import Beside
from onbeat.viewer.figure import Figure, ground_height
from onbeat.viewer.plots.heat import colours, scale_end
from onbeat.viewer.render.camera import Camera, CameraPath, Size, distance_needed, follow
from onbeat.viewer.render.raster import render_frame
from onbeat.viewer.render.stage import Stage

MOMENTS = 3
"""How many of the moments are drawn at which the pupil is farthest off."""
_MASTER = (154, 163, 178)
_APART = 0.62  # of the body's height or width, from the pupil to the master beside it
_BODY: Size = (440, 640)
_PAIR: Size = (480, 360)


def write_pupil_figure(path: Path, found: Beside, elements: Sequence[str], centimetres: Array, title: str = "") -> None:
    """Draw it to a PNG, SVG or PDF file.

    Parameters
    ----------
    path : the file.
    found : the pupil's motion beside the master's.
    elements, centimetres : what is listed, E names and (E,) the distance of each.
    title : above it.

    Raises
    ------
    OnbeatError
        If the ending is none of these.
    """
    from onbeat.viewer.plots.files import new_figure, save_figure

    most = scale_end(100.0 * found.errors)
    figure = new_figure((11.0, 7.4))
    grid = figure.add_gridspec(2, 3, height_ratios=(1.5, 1.0))
    _picture(figure.add_subplot(grid[0, 0]), _whole(found, most), "the whole dance")
    _bars(figure.add_subplot(grid[0, 1:]), elements, centimetres, most)
    for column, frame in enumerate(worst(found)):
        label = f"{frame / found.pupil.fps:.2f} s: {_farthest(found, frame)}"
        _picture(figure.add_subplot(grid[1, column]), _pair(found, frame, most), label)
    figure.suptitle(title, fontsize=12, parse_math=False)
    save_figure(figure, path)


def worst(found: Beside) -> list[int]:
    """The frames, in order, at which the pupil is farthest off, none near another."""
    mean = np.nan_to_num(np.square(found.errors).mean(axis=1), nan=-1.0)
    apart = max(1, len(mean) // (3 * MOMENTS))
    kept: list[int] = []
    for frame in np.argsort(-mean, kind="stable").tolist():
        if all(abs(frame - other) >= apart for other in kept):
            kept.append(frame)
        if len(kept) == MOMENTS:
            break
    return sorted(kept)


def _farthest(found: Beside, frame: int) -> str:
    at = int(np.nanargmax(found.errors[frame]))
    return f"{found.elements[at].replace('_', ' ')} {100 * found.errors[frame, at]:.0f} cm"


def _picture(axes: Any, picture: np.ndarray, label: str) -> None:
    axes.imshow(picture)
    axes.set_axis_off()
    axes.set_title(label, fontsize=9)


def _bars(axes: Any, elements: Sequence[str], centimetres: Array, most: float) -> None:
    order = np.argsort(centimetres, kind="stable")
    tints = colours(centimetres[order] / most) / 255.0
    axes.barh(np.arange(len(order)), centimetres[order], color=tints, height=0.78)
    axes.set_yticks(np.arange(len(order)), [elements[int(i)].replace("_", " ") for i in order], fontsize=7.5)
    axes.set_xlabel(f"cm from the master (root of the mean square); colours from 0 to {most:g} cm")
    axes.set_xlim(left=0.0)
    axes.margins(y=0.01)
    axes.spines[["top", "right"]].set_visible(False)


def _whole(found: Beside, most: float) -> np.ndarray:
    """The pupil as it is when nearest to its own mean pose, coloured by the mean of all moments."""
    levels = np.sqrt(np.nanmean(np.square(found.joint_errors()), axis=0))
    inside = np.flatnonzero(np.isfinite(found.errors).all(axis=1))
    places = found.pupil.positions[inside] - found.pupil.positions[inside, :1]
    frame = int(inside[np.square(places - places.mean(axis=0)).sum(axis=(1, 2)).argmin()])
    return _drawn([(found.pupil, levels, 0.0)], frame, most, _BODY)


def _pair(found: Beside, frame: int, most: float) -> np.ndarray:
    levels = found.joint_errors()[frame]
    return _drawn([(found.pupil, levels, 0.5), (found.master, None, -0.5)], frame, most, _PAIR)


def _drawn(bodies: Sequence[tuple[Motion, Array | None, float]], frame: int, most: float, size: Size) -> np.ndarray:
    """Bodies side by side, coloured by (J,) metres, or grey; seen from the first one's front."""
    first = bodies[0][0][frame : frame + 1]
    shape = Figure.of(first.skeleton)
    ground = ground_height(shape, bodies[0][0])
    camera = follow(first, shape, ground, size=size, smoothing=0.0, side=0.3)
    right = np.array([-np.sin(camera.azimuth), np.cos(camera.azimuth), 0.0])
    low, high = shape.bounds(first.positions[0])
    step = _APART * float((high - low).max()) * right
    places = np.concatenate([motion.positions[frame] + side * step for motion, _, side in bodies])
    figure = _joined([(Figure.of(motion.skeleton), levels) for motion, levels, _ in bodies], most)
    return render_frame(
        places, figure, _framed(camera, figure, places, size), size, Stage.lit_from(camera.azimuth, ground, fine=3)
    )


def _framed(camera: CameraPath, figure: Figure, places: Array, size: Size) -> Camera:
    """The camera as far off as all bodies need."""
    low, high = figure.bounds(places)
    middle = (low + high) / 2
    still = replace(camera, targets=middle[None], distances=np.zeros(1))
    needed = distance_needed(places[None], figure, still, size[0] / size[1]) * 1.08
    return replace(still, distances=needed)[0]


def _joined(bodies: Sequence[tuple[Figure, Array | None]], most: float) -> Figure:
    """Several figures as one, the joints of each after those of the one before."""
    joints: list[Ints] = []
    tints: list[Array] = []
    first = 0
    for figure, levels in bodies:
        joints.append(figure.joints + first)
        first += int(figure.joints.max()) + 1 if levels is None else len(levels)
        grey = np.tile(np.array(_MASTER, np.float64), (len(figure.joints), 1))
        tints.append(grey if levels is None else _tints(figure, levels, most))
    figures = [figure for figure, _ in bodies]
    count = sum(len(figure.joints) for figure in figures)
    adjacent, at = np.zeros((count, count), np.bool_), 0
    for figure in figures:
        adjacent[at : at + len(figure.joints), at : at + len(figure.joints)] = figure.adjacent
        at += len(figure.joints)
    reach, radii = (np.concatenate([getattr(figure, name) for figure in figures]) for name in ("reach", "radii"))
    return Figure(np.concatenate(joints), reach, radii, np.concatenate(tints), adjacent)


def _tints(figure: Figure, levels: Array, most: float) -> Array:
    """(N, 3) the colour of each capsule, by the mean of its joints."""
    ends = levels[figure.joints]
    part = np.clip(figure.reach, 0.0, 1.0).mean(axis=1)
    return colours(100.0 * (ends[:, 0] * (1 - part) + ends[:, 1] * part) / most).astype(np.float64)
