"""Fig. 1 of 2007: where a hand goes at the normal and at a faster speed, seen from the dancer's own front."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array, frozen
from onbeat.motion import Body
from onbeat.motion import rotations as rot
from onbeat.motion.body import body_frames
from onbeat.reproduce.p2.takes import Takes
from onbeat.retime.takes import Take, rhythm_of
from onbeat.viewer.plots.files import new_figure
from onbeat.viewer.plots.observe import GRID, KEYPOSE, LOW, MIDDLE

FASTER = 1.3
"""The speed of Fig. 1."""
DENSITY = 32
"""Points a beat."""
SMOOTHING = 1 / 16
"""Beats over which the noise of capture is smoothed, on musical time and so alike at both speeds."""
AWAY = 0.25
"""Beats from a keypose past which a moment is another one."""
ROOM = 0.06
"""Metres about what is shown."""
BODY = "#dfe4ea"


class View(NamedTuple):
    """From where a body is looked at: which of its own axes goes across the picture."""

    title: str
    across: str
    axis: int
    sign: float

    def flat(self, places: Array) -> tuple[Array, Array]:
        """Places (N, 3) in the picture: across it and up."""
        return self.sign * places[:, self.axis], places[:, 2]


VIEWS = (View("from the front", "to the dancer’s left [m]", 0, -1.0), View("from the left", "to the back [m]", 1, -1.0))


@dataclass(frozen=True, eq=False)
class Paths:
    """Where the left hand goes in takes of one speed.

    Parameters
    ----------
    speed : of all.
    beats : (G,) from the first on.
    places : (N, G, 3) metres in the body-centre frame: to the body's right, to its front, up from the hips.
    """

    speed: float
    beats: Array
    places: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "places", frozen(self.places))

    @property
    def mean(self) -> Array:
        """(G, 3) of all takes."""
        return self.places.mean(axis=0)

    @property
    def length(self) -> float:
        """Metres that the mean path is long."""
        return float(np.linalg.norm(np.diff(self.mean, axis=0), axis=1).sum())


def hand_paths(takes: Takes, speed: float) -> Paths:
    """The left hand's paths at a speed, over the beats that all takes share."""
    own = takes.at(speed)
    last = takes.cycle or min(_last(take) for take in takes.takes)
    beats = np.arange(DENSITY * last + 1) / DENSITY
    return Paths(speed, beats, np.stack([_path(take, beats) for take in own]))


def _last(take: Take) -> int:
    return int(np.searchsorted(take.beats, (len(take.motion) - 0.5) / take.motion.fps)) - 1


def _path(take: Take, beats: Array) -> Array:
    body = Body.of(take.motion.skeleton)
    moments = take.motion.at(np.clip(rhythm_of(take).inverse(beats), 0.0, take.motion.times[-1]))
    frames, waist = body_frames(moments, body)
    seen = rot.rotate(rot.inverse(frames), moments.positions[:, body["left_wrist"]] - waist)
    return gaussian_filter1d(seen, SMOOTHING * DENSITY, axis=0, mode="nearest")


@dataclass(frozen=True)
class Compared:
    """The hand at two speeds.

    Parameters
    ----------
    length : the faster path's length by the normal one's.
    at_keyposes, between : metres between the two paths at keyposes, and away from them; NaN without known ones.
    smaller : the faster path's extent by the normal one's, root mean square about the middle.
    """

    length: float
    at_keyposes: float
    between: float
    smaller: float


def compared(normal: Paths, faster: Paths, keyposes: Array | None) -> Compared:
    """How the mean paths of two speeds differ."""
    apart = np.linalg.norm(normal.mean - faster.mean, axis=1)
    extents = [
        float(np.sqrt(np.square(one.mean - one.mean.mean(axis=0)).sum(axis=1).mean())) for one in (normal, faster)
    ]
    ratio, smaller = faster.length / normal.length, extents[1] / extents[0]
    if keyposes is None or not len(keyposes):
        return Compared(ratio, float("nan"), float("nan"), smaller)
    nearest = np.abs(normal.beats[:, None] - keyposes).min(axis=1)
    at = float(np.interp(keyposes, normal.beats, apart).mean())
    return Compared(ratio, at, float(apart[nearest > AWAY].mean()), smaller)


def hand_figure(normal: Paths, faster: Paths, take: Take, keyposes: Array | None) -> Any:
    """Both mean paths from two sides, single takes thin behind, and the body above the hips in the first keypose."""
    figure = new_figure((10.0, 5.7))
    body, bones = _body(take, 0.0 if keyposes is None else float(keyposes[0]))
    shown = np.concatenate([body[body[:, 2] >= 0], *(paths.places.reshape(-1, 3) for paths in (normal, faster))])
    for axes, view in zip(figure.subplots(1, 2, sharey=True), VIEWS, strict=True):
        for a, b in bones:
            line = view.flat(body[[a, b]])
            axes.plot(*line, color=BODY, lw=9, solid_capstyle="round", zorder=0)
        for paths, colour in ((normal, LOW), (faster, MIDDLE)):
            _drawn(axes, view, paths, colour, keyposes)
        _framed(axes, view, shown)
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False)
    return figure


def _drawn(axes: Any, view: View, paths: Paths, colour: Any, keyposes: Array | None) -> None:
    for one in paths.places:
        axes.plot(*view.flat(one), color=colour, lw=0.5, alpha=0.4, zorder=1)
    axes.plot(*view.flat(paths.mean), color=colour, lw=2.0, zorder=3, label=f"{paths.speed:g}×")
    if keyposes is not None:
        at = np.stack([np.interp(keyposes, paths.beats, channel) for channel in paths.mean.T], axis=1)
        style = {"ms": 6.5, "mfc": colour, "mec": KEYPOSE, "mew": 1.3, "zorder": 4}
        axes.plot(*view.flat(at), "o", label=f"{paths.speed:g}×, at a keypose", **style)


def _framed(axes: Any, view: View, shown: Array) -> None:
    """The same square about the paths in both views, the shoulders in it."""
    across, up = view.flat(shown)
    middle, high, low = (across.min() + across.max()) / 2, up.max(), up.min()
    half = max(np.ptp(across), high - low) / 2 + ROOM
    axes.set_xlim(middle - half, middle + half)
    axes.set_ylim((low + high) / 2 - half, (low + high) / 2 + half)
    axes.set_box_aspect(1)
    axes.set_title(view.title, fontsize=9)
    axes.set_xlabel(view.across)
    axes.set_ylabel("above the hips [m]")
    axes.label_outer()
    axes.grid(color=GRID, lw=0.5)


def _body(take: Take, beat: float) -> tuple[Array, list[tuple[int, int]]]:
    """The joints (J, 3) of the body in its own frame at a beat, and which of them bones are between."""
    moment = take.motion.at(np.clip(rhythm_of(take).inverse(np.array([beat])), 0.0, take.motion.times[-1]))
    frames, waist = body_frames(moment, Body.of(take.motion.skeleton))
    parents = take.motion.skeleton.parents.tolist()
    bones = [(joint, parent) for joint, parent in enumerate(parents) if parent >= 0]
    return rot.rotate(rot.inverse(frames), moment.positions - waist[:, None])[0], bones
