"""How well a body fits markers: ``python benchmarks/marker_fit.py FILES...`` (C3D or TRC), one row a file.

Beside the fit stands what joint centres alone give, without a fitted body: by how much the bones between them change
their length. Knees and elbows bend the right way where the shin points behind the thigh, the forearm before the arm.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from onbeat.capture import Fit, fit_body
from onbeat.capture.body import template
from onbeat.capture.centres import guess
from onbeat.capture.placed import by_site, place_markers
from onbeat.errors import OnbeatError
from onbeat.motion import Markers
from onbeat.motion import rotations as rot

_BONES = (("UpLeg", "Leg"), ("Leg", "Foot"), ("Arm", "ForeArm"), ("ForeArm", "Hand"))
_COLUMNS = (
    "file", "markers", "frames", "s", "seen %", "RMS mm", "p95 mm", "bones ± mm", "centres alone ± mm",
    "bend right %", "lowest toe m", "jitter fit/markers", "CPU s",
)  # fmt: skip


def main(files: list[Path]) -> None:
    table = Table(*_COLUMNS, box=None, pad_edge=False)
    for file in files:
        try:
            table.add_row(*row(file))
        except OnbeatError as error:
            table.add_row(file.name, str(error)[:90])
    Console(width=200).print(table)


def row(file: Path) -> list[str]:
    """All figures of one file."""
    markers = read(file)
    begun = time.process_time()
    fit = fit_body(markers)
    seconds = time.process_time() - begun
    seen = fit.support > 0.5
    placed, _ = place_markers(markers)
    return [
        file.name,
        f"{len(fit.sites)}/{len(markers.names)}",
        str(len(markers)),
        f"{markers.duration:.1f}",
        f"{fit.support.mean():.0%}",
        f"{fit.residual_mm:.1f}",
        f"{percentile(fit, 95):.1f}",
        f"{spread_of_bones(fit):.1e}",
        f"{spread_of_centres(placed):.1f}",
        f"{bends_right(fit)[seen].mean():.1%}",
        f"{lowest_toe(fit, seen):.3f}",
        f"{jitter(fit, placed):.2f}",
        f"{seconds:.1f}",
    ]


def read(file: Path) -> Markers:
    """The markers of a file, by the reader of its kind."""
    if file.suffix.lower() == ".trc":
        from onbeat.formats.trc.read import read_trc

        return read_trc(file)
    from onbeat.formats.c3d.read import read_c3d

    return read_c3d(file)


def percentile(fit: Fit, part: float) -> float:
    """A percentile over the markers of how far each is off, in mm."""
    return float(np.percentile(list(fit.worst.values()), part))


def spread_of_bones(fit: Fit) -> float:
    """The largest standard deviation of a fitted bone's length in the world, in mm."""
    p, parents = fit.motion.positions, fit.motion.skeleton.parents
    return float(np.linalg.norm(p[:, 1:] - p[:, parents[1:]], axis=-1).std(axis=0).max() * 1000)


def spread_of_centres(placed: Markers) -> float:
    """The mean standard deviation of the distances between joint centres taken alone, in mm."""
    centres = guess(by_site(placed), template()).centres
    pairs = [(side + top, side + end) for side in ("Left", "Right") for top, end in _BONES]
    lengths = [np.linalg.norm(centres[a] - centres[b], axis=-1) for a, b in pairs]
    return float(np.mean([np.nanstd(each) for each in lengths]) * 1000)


def bends_right(fit: Fit) -> np.ndarray:
    """(F,) part of knees and elbows that do not bend backwards by more than 6°."""
    skeleton, local = fit.motion.skeleton, fit.motion.rotations
    good = []
    for side, sign in (("Left", -1.0), ("Right", 1.0)):
        shin = rot.rotate(local[:, skeleton.index(f"{side}Leg")], np.array([0, 0, -1.0]))
        forearm = rot.rotate(local[:, skeleton.index(f"{side}ForeArm")], np.array([sign, 0, 0]))
        good += [shin[:, 1] < 0.1, forearm[:, 1] > -0.1]
    return np.mean(good, axis=0)


def lowest_toe(fit: Fit, seen: np.ndarray) -> float:
    """How high the lower of both toes' joints usually is at its lowest: the fifth percentile, in metres."""
    p, skeleton = fit.motion.positions, fit.motion.skeleton
    toes = [p[seen, skeleton.index(f"{side}ToeBase"), 2] for side in ("Left", "Right")]
    return float(np.percentile(np.min(toes, axis=0), 5))


def jitter(fit: Fit, placed: Markers) -> float:
    """Mean acceleration from frame to frame of limbs' joints as a part of that of the markers beside them."""
    p, skeleton, ratios = fit.motion.positions, fit.motion.skeleton, []
    for side in ("left", "right"):
        for site, joint in (("ankle", "Foot"), ("knee", "Leg"), ("elbow", "ForeArm")):
            name = next((n for n in (f"{side}_{site}_lateral", f"{side}_{site}") if n in placed.names), None)
            if name is not None:
                there = np.diff(placed.positions[:, placed.index(name)], 2, axis=0)
                seen = np.isfinite(there).all(axis=1)
                here = np.diff(p[:, skeleton.index(side.capitalize() + joint)], 2, axis=0)
                ratios.append(np.linalg.norm(here[seen], axis=1).mean() / np.linalg.norm(there[seen], axis=1).mean())
    return float(np.mean(ratios))


if __name__ == "__main__":
    main([Path(argument) for argument in sys.argv[1:]])
