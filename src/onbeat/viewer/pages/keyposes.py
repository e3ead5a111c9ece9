"""``keyposes.html``: the player with the keyposes of a motion, to step from one to the next."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np

from onbeat._shapes import Bools, Float32, Times
from onbeat.keyposes.energy import RATE
from onbeat.keyposes.extract import Keyposes
from onbeat.keyposes.points import bridged
from onbeat.motion import Markers, Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.viewer.contract import EnergyData, pack_curve
from onbeat.viewer.keypose.poses import DOT, fitted
from onbeat.viewer.keypose.rows import downbeats_among, keypose_numbers
from onbeat.viewer.pages.content import page_data
from onbeat.viewer.pages.page import write_filled
from onbeat.viewer.shape import Capsule

CURVE_RATE = 40.0
"""Values per second of the energy curves."""


def write_keypose_page(
    path: Path,
    found: Keyposes,
    source: Motion | Markers,
    *,
    title: str = "",
    downbeats: Times | None = None,
    cycle: int | None = None,
    audio: tuple[Float32, int] | None = None,
) -> None:
    """Write the page: one file that opens without a server or a network.

    Parameters
    ----------
    path : the file.
    found : the keyposes.
    source : what they were found in; to markers a body is fitted where they tell one, else they are shown as dots.
    title : of the page.
    downbeats : seconds; those among the beats are drawn heavier.
    cycle : beats after which the dance repeats: keyposes on the same beat of it have one number.
    audio : samples (N, channels) in -1…1 on the motion's clock and their rate in Hz; None for a silent page.
    """
    shown = fitted(source)
    motion, shape = dotted(shown) if isinstance(shown, Markers) else (shown, None)
    beats = found.song_beats
    down = np.zeros(0) if downbeats is None else np.asarray(downbeats, np.float64)
    numbers = keypose_numbers(found.beats, beats, down, cycle)
    document = {"title": title or source.name, "method": found.method}
    data = page_data(motion, None, document, audio, found, numbers, shape)
    tempo = 60.0 / float(np.median(np.diff(beats)))
    told = [data.beats[k] for k in downbeats_among(beats, down).tolist()]
    write_filled(path, msgspec.structs.replace(data, downbeats=told, tempo=tempo, energy=_energy(found)))


def _energy(found: Keyposes) -> EnergyData:
    """Both curves, the local one empty where it is not known; what rests otherwise (hands) is marked on the upper."""
    energy = found.energy
    every = max(1, round(RATE / CURVE_RATE))
    most = max(float(energy.world[::every].max()), float(energy.local[::every].max(initial=0.0)), 1e-9)
    world, local = energy.world[::every] / most, energy.local[::every] / most
    marks = {name: times[~np.isnan(times)].round(4).tolist() for name, times in found.candidates.items()}
    others = sorted(time for name, times in marks.items() if name != "local" for time in times)
    rate = RATE / every
    return EnergyData(pack_curve(world, rate), pack_curve(local, rate), others, marks.get("local", []))


def dotted(markers: Markers) -> tuple[Motion, list[Capsule]]:
    """Markers as joints that move freely about their middle, and a ball for each."""
    seen: Bools = np.asarray(markers.seen.any(axis=0))
    paths, _ = bridged(markers.positions[:, seen], markers.fps)
    names = [name for name, is_seen in zip(markers.names, seen, strict=True) if is_seen]
    middle = "middle"
    while middle in names:
        middle += "_"
    count = len(names)
    skeleton = Skeleton((middle, *names), np.array([-1, *[0] * count]), np.zeros((count + 1, 3)))
    root = paths.mean(axis=1)
    free = np.concatenate([np.zeros((len(paths), 1, 3)), paths - root[:, None]], axis=1)
    still = np.tile(rot.IDENTITY, (len(paths), count + 1, 1))
    motion = Motion(skeleton, still, root, markers.fps, markers.name, free)
    return motion, [Capsule(k, k, DOT, DOT, "torso") for k in range(1, count + 1)]
