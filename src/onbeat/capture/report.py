"""What is told about a fit: how far off the markers are, what was filled, what was left out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Bools, Positions
from onbeat.capture.gaps import Filled
from onbeat.capture.model import Model, Pose
from onbeat.motion.markers import Markers

_FAR_MM, _DOUBTFUL_MM = 30.0, 20.0
_BLIND = 0.5


class Residuals(NamedTuple):
    """How far the model's markers are from those seen.

    Parameters
    ----------
    distances : (F, M) metres, NaN where a marker is not seen.
    """

    distances: Array

    @property
    def overall(self) -> float:
        """The root mean square in mm; 0 where nothing is seen."""
        return _rms_mm(self.distances)

    def each(self, sites: Mapping[str, Sequence[str]]) -> dict[str, float]:
        """The root mean square of each site's markers in mm, the largest first."""
        all_ = {"+".join(labels): _rms_mm(self.distances[:, k]) for k, labels in enumerate(sites.values())}
        return dict(sorted(all_.items(), key=lambda item: -item[1]))


def _rms_mm(distances: Array) -> float:
    known = distances[np.isfinite(distances)]
    return float(np.sqrt(np.mean(known**2)) * 1000) if known.size else 0.0


def residuals(model: Model, pose: Pose, seen: Positions) -> Residuals:
    """Distances between the markers seen (F, M, 3) and the model's, in blocks of frames."""
    parts = [
        np.linalg.norm(model.placed(pose.chosen(slice(at, at + 2000))).markers - seen[at : at + 2000], axis=-1)
        for at in range(0, len(seen), 2000)
    ]
    return Residuals(np.concatenate(parts))


def tell_fit(
    markers: Markers, sites: Mapping[str, Sequence[str]], filled: Filled, support: Array, off: Residuals
) -> tuple[str, ...]:
    """The lines of the report."""
    used = {label for labels in sites.values() for label in labels}
    unused = [label for label in markers.names if label not in used]
    lines = [f"{len(sites)} of {len(markers.names)} labels used, {off.overall:.1f} mm off (RMS)"]
    if off.overall > _DOUBTFUL_MM:
        lines.append("that is far for a body: are the labels right, and left and right?")
    if unused:
        some = ", ".join(unused[:12]) + (f" and {len(unused) - 12} more" if len(unused) > 12 else "")
        lines.append(f"not used, as no place on the body is known for them: {some}")
    looked = support >= _BLIND
    for k, labels in enumerate(sites.values()):
        missing = ~np.isfinite(off.distances[:, k]) & looked
        if missing.any():
            lines.append(_gap_line("+".join(labels), missing, k, filled, markers.fps))
    for label, mm in off.each(sites).items():
        if mm > _FAR_MM:
            lines.append(f"{label} is {mm:.0f} mm off (RMS): is it the marker its label says?")
    return (*lines, *_blind_lines(support, markers.fps))


def _gap_line(label: str, missing: Bools, k: int, filled: Filled, fps: float) -> str:
    """How the frames in which a marker is missing were filled, while most of the others are seen."""
    curve, neighbours, jumps = (each[:, k] & missing for each in (filled.by_curve, filled.by_neighbours, filled.jumps))
    ways = {"by its own path": curve, "by the markers of its bone": neighbours}
    ways["by the fitted body"] = missing & ~curve & ~neighbours
    how = ", ".join(f"{frames.sum() / fps:.2f} s {way}" for way, frames in ways.items() if frames.any())
    jumped = f" ({jumps.sum() / fps:.2f} s of it seen where it cannot be)" if jumps.any() else ""
    return f"{label}: {missing.sum() / fps:.2f} s of {len(missing) / fps:.2f} s unseen{jumped}; filled {how}"


def _blind_lines(support: Array, fps: float) -> list[str]:
    """Stretches in which less than half of the markers are seen."""
    blind = np.concatenate(([False], support < _BLIND, [False])).astype(np.int8)
    edges = np.flatnonzero(np.diff(blind)).reshape(-1, 2).tolist()
    return [
        f"{first / fps:.2f} s to {end / fps:.2f} s: less than half of the markers are seen; the pose is held or guessed"
        for first, end in edges
    ]
