"""Markers in, a motion out: one skeleton fitted to all frames (global optimisation, Lu and O'Connor 1999)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Ints
from onbeat.capture.body import Template, template
from onbeat.capture.calibrate import SCALE_SIGMA, Calibration, Prior, calibrate
from onbeat.capture.centres import Guess, guess
from onbeat.capture.follow import follow
from onbeat.capture.gaps import fill_gaps
from onbeat.capture.model import Model
from onbeat.capture.placed import by_site, clusters, place_markers
from onbeat.capture.report import residuals, tell_fit
from onbeat.capture.sites import SITES
from onbeat.capture.toes import bend_toes
from onbeat.errors import BodyError
from onbeat.motion.markers import Markers
from onbeat.motion.motion import Motion
from onbeat.motion.skeleton import Skeleton

COARSE_S = 0.1
"""Seconds between the frames that are solved from scratch; the others begin between them."""
WORST_MM = 100.0
"""A fit farther off is not one."""
CHOSEN = 100
"""Frames from which the body is measured."""


@dataclass(frozen=True)
class Fit:
    """A body fitted to markers.

    Parameters
    ----------
    motion : as many frames as the markers, at their rate.
    residual_mm : root of the mean squared distance between markers seen and the model's.
    worst : the same of each marker used, in mm, the largest first.
    support : (F,) part of the markers used that are seen, 0…1; where it is low the pose is a guess.
    sites : the labels used of each site.
    report : what was filled, left out and guessed, a line each.
    """

    motion: Motion
    residual_mm: float
    worst: Mapping[str, float]
    support: Array
    sites: Mapping[str, tuple[str, ...]]
    report: tuple[str, ...]

    @property
    def trusted(self) -> tuple[int, int]:
        """The first frame in which half of the markers are seen, and the frame after the last; all if there is none."""
        good = np.flatnonzero(self.support >= 0.5)
        return (int(good[0]), int(good[-1]) + 1) if len(good) else (0, len(self.support))


def fit_body(
    markers: Markers,
    sites: Mapping[str, Sequence[str]] | None = None,
    progress: Callable[[float], None] | None = None,
    symmetric: bool = True,
) -> Fit:
    """Fit a skeleton of constant bones to markers.

    Gaps are filled (:func:`onbeat.capture.gaps.fill_gaps`); the joints' centres are guessed by anatomy; bone lengths
    and the markers' places are found on chosen frames; then the poses of all frames are those whose markers are
    nearest, with weak habits (hinges, neighbouring frames) where no marker tells.

    Parameters
    ----------
    markers : labelled as Vicon, Helen Hayes, OptiTrack or joints are.
    sites : labels by site where they are named otherwise (:func:`onbeat.capture.labels.find_sites`).
    progress : is told the part done, 0…1.
    symmetric : bones of left and right alike.

    Raises
    ------
    BodyError
        If the labels do not tell a whole body (pelvis, shoulders, elbows, wrists, knees and ankles are needed), the
        size is no human's, or no body fits.
    """
    placed, found = place_markers(markers, sites)
    names = placed.names
    filled = fill_gaps(placed, clusters(names))
    body = template(symmetric)
    coarse = _coarse_frames(len(markers), markers.fps)
    first = guess(by_site(filled.markers, coarse), body)
    model = _calibrated(filled.markers, coarse, first, body)
    pose = follow(model, filled.markers, coarse, first.pose, progress)
    motion = Motion(model.skeleton, pose.rotations, pose.root, markers.fps, markers.name)
    if not any(name.endswith("_toe_tip") for name in names):
        motion = bend_toes(motion)
    off = residuals(model, pose, np.where(filled.jumps[..., None], np.nan, placed.positions))
    if off.overall > WORST_MM:
        worst = ", ".join(f"{label} ({mm:.0f} mm)" for label, mm in list(off.each(found).items())[:5])
        raise BodyError(
            f"{markers.name or 'the markers'}: no body has its markers so: the best fit is {off.overall:.0f} mm off "
            f"(RMS), most at {worst}; are the labels right, and left and right?"
        )
    support = placed.seen.mean(axis=1)
    return Fit(motion, off.overall, off.each(found), support, found, tell_fit(markers, found, filled, support, off))


def _coarse_frames(count: int, fps: float) -> Ints:
    step = max(1.0, COARSE_S * fps)
    frames = np.round(np.arange(0, count - 1 + 1e-6, step)).astype(np.int64)
    return np.unique(np.append(frames, count - 1))


def _calibrated(markers: Markers, coarse: Ints, first: Guess, body: Template) -> Model:
    """The model with its measured body."""
    names = markers.names
    skeleton = body.scaled(first.scales, first.offsets)
    places = np.array([first.places[name] for name in names])
    like = Model(skeleton, _joints(skeleton, names, "segment"), _joints(skeleton, names, "anchor"), places)
    chosen = _chosen_frames(markers.seen[coarse])
    spread = np.array([SITES[name].spread for name in names])
    prior = Prior(first.scales, _scale_sigma(body, names), places, spread)
    found: Calibration = calibrate(
        body, first.offsets, like, prior, markers.positions[coarse[chosen]], first.pose.chosen(chosen)
    )
    return Model(body.scaled(found.scales, first.offsets), like.segments, like.anchors, found.places)


def _joints(skeleton: Skeleton, names: Sequence[str], which: str) -> Ints:
    joints = [getattr(SITES[name], which) for name in names]
    return np.array([skeleton.index(joint) for joint in joints], np.int64)


def _scale_sigma(body: Template, names: Sequence[str]) -> Array:
    """How far the scales may go: the pelvis stays as its spines tell it."""
    sure = {"left_asis", "right_asis"} <= set(names)
    return np.array([0.01 if group.endswith("pelvis") and sure else SCALE_SIGMA for group in body.groups])


def _chosen_frames(seen: Bools) -> Ints:
    """Up to 100 frames spread evenly over those in which nearly all markers are seen."""
    count = seen.sum(axis=1)
    good = np.flatnonzero(count >= np.quantile(count, 0.9) * 0.9)
    return np.unique(good[np.linspace(0, len(good) - 1, min(CHOSEN, len(good))).round().astype(np.int64)])
