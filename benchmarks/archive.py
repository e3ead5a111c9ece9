"""A synthetic archive of up to 50 hours: the embedded troupe with variations, each clip made when it is asked for.

``python benchmarks/archive.py FOLDER --hours 1`` writes it as files; the other benchmarks take pose vectors of it and
never write a motion. Clip k of a seed is the same each time and needs no other clip: it has one of ``PERFORMERS``
performers (a dancer of the troupe with other proportions and habits), three to nine figures in another order, some of
them new (hands, steps and trunk of different figures, hands at other places), a tempo, and a recorder's noise.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import count
from pathlib import Path

import numpy as np
from scipy.ndimage import gaussian_filter1d

from onbeat.examples.dancers import DANCERS, Dancer
from onbeat.examples.figures import PLACES, Figure
from onbeat.examples.performer import perform
from onbeat.examples.troupe import FIGURES, LIBRARY_BODY
from onbeat.formats import write_motion
from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.moves.poses import pose_vectors

FPS = 30.0
PERFORMERS = 40
SLOWEST, FASTEST = 0.8, 1.6
"""Times the troupe's tempo."""
NEW, MOVED = 0.6, 0.3
"""Share of figures that are new, and of their hands' places that are exchanged."""
SHAKE, SWAY, CORRELATED = 0.008, 0.002, 0.04
"""Radians in each joint and metres of the root by which a recorder is wrong, over so many seconds at a time."""
LONGEST = 50.0  # hours


@dataclass(frozen=True)
class Archive:
    """An archive without end, by its seed.

    Parameters
    ----------
    seed : other seeds, other clips.
    one_body : all performers borrow one body, so that no clip needs retargeting.
    seconds : clips are cut to so many seconds at most.
    noise : times the recorder's usual error.
    """

    seed: int = 0
    one_body: bool = False
    seconds: float = np.inf
    noise: float = 1.0

    def motion(self, k: int) -> Motion:
        """Clip k."""
        rng = np.random.default_rng([self.seed, 1, k])
        who = int(rng.integers(PERFORMERS))
        dancer, speed = self.performer(who), float(rng.uniform(SLOWEST, FASTEST))
        figures = [self._figure(rng) for _ in range(3 + min(int(rng.geometric(0.4)) - 1, 6))]
        order = [figure for figure in figures for _ in range(max(1, 8 // figure.beats))]
        motion = perform(dancer, order, speed, 1, rng, FPS).motion
        if len(motion) > self.seconds * FPS:
            size = round(self.seconds * FPS)
            first = int(rng.integers(len(motion) - size + 1))
            motion = motion[first : first + size]
        return self._noisy(motion, rng).replace(name=f"p{who:02}-{k:06}")

    def performer(self, who: int) -> Dancer:
        """A dancer of the troupe as another person."""
        rng = np.random.default_rng([self.seed, 0, who])
        dancer = DANCERS[who % len(DANCERS)]
        near = {name: getattr(dancer, name) * rng.uniform(0.75, 1.25) for name in ("softness", "overshoot", "bounce")}
        near |= {name: getattr(dancer, name) * rng.uniform(0.92, 1.08) for name in ("amplitude", "stride", "sway")}
        near |= {name: getattr(dancer, name) + rng.normal(0, 0.03) for name in ("bow", "lift")}
        build = replace(dancer.build, height=float(np.clip(dancer.build.height + rng.normal(0, 0.05), 1.5, 1.95)))
        name = f"p{who:02}"
        return replace(dancer, name=name, build=LIBRARY_BODY if self.one_body else build, **near)

    def _figure(self, rng: np.random.Generator) -> Figure:
        """A figure of the troupe, or a new one of the parts of three."""
        figure = FIGURES[int(rng.integers(len(FIGURES)))]
        if rng.random() > NEW:
            return figure
        alike = [other for other in FIGURES if other.beats == figure.beats]
        hands, trunk = (alike[int(rng.integers(len(alike)))] for _ in range(2))
        places = {beat: _moved(text, rng) for beat, text in hands.hands.items()}
        return replace(figure, hands=places, through=hands.through, trunk=trunk.trunk)

    def _noisy(self, motion: Motion, rng: np.random.Generator) -> Motion:
        if not self.noise:
            return motion
        joints = [j for j in range(len(motion.skeleton)) if not motion.skeleton.end_sites[j]]
        turned = np.array(motion.rotations)
        turned[:, joints] = rot.multiply(
            turned[:, joints], rot.exp(self.noise * SHAKE * _wander((len(motion), len(joints), 3), rng))
        )
        path = motion.root_positions + self.noise * SWAY * _wander((len(motion), 3), rng)
        return motion.replace(rotations=turned, root_positions=path)

    def poses(self, k: int) -> np.ndarray:
        """(n, D) float32 pose vectors of clip k."""
        return pose_vectors(self.motion(k))

    def clips(self, hours: float) -> Iterator[np.ndarray]:
        """Pose vectors clip by clip, the last one cut: exactly so many hours of frames."""
        left = round(hours * 3600 * FPS)
        for k in count():
            poses = self.poses(k)[:left]
            left -= len(poses)
            yield poses
            if left <= 0:
                return

    def write(self, folder: Path, hours: float, kind: str = "npz", at_most: int | None = None) -> list[Path]:
        """Write files until there are so many hours (or files), a folder for each performer."""
        files: list[Path] = []
        left = min(hours, LONGEST) * 3600
        for k in count():
            if left <= 0 or len(files) == at_most:
                return files
            motion = self.motion(k)
            left -= motion.duration
            path = folder / motion.name.split("-")[0] / f"{motion.name}.{kind}"
            path.parent.mkdir(parents=True, exist_ok=True)
            write_motion(motion, path)
            files.append(path)
        return files


def _moved(text: str, rng: np.random.Generator) -> str:
    """Places of two hands, some of them exchanged for others."""
    names = list(PLACES)
    hands = text.split(" | ")
    return " | ".join(names[int(rng.integers(len(names)))] if rng.random() < MOVED else hand for hand in hands)


def _wander(shape: tuple[int, ...], rng: np.random.Generator) -> np.ndarray:
    """Noise of variance 1 that is alike over ``CORRELATED`` seconds."""
    noise = gaussian_filter1d(rng.standard_normal(shape), CORRELATED * FPS, axis=0)
    return noise / np.sqrt(1 / (2 * np.sqrt(np.pi) * CORRELATED * FPS))


@dataclass(frozen=True)
class Poses:
    """Pose vectors of an archive, kept one after the other: ``.npy`` on disk, mapped."""

    rows: np.ndarray
    clip_of: np.ndarray

    @classmethod
    def of(cls, hours: float, seed: int, cache: Path, *, one_body: bool = True) -> Poses:
        """Of so many hours; made once for each folder, by at most a clip in memory."""
        base = cache / f"poses-{hours:g}h-seed{seed}-{'one' if one_body else 'own'}"
        rows, clips = base.with_suffix(".f32"), base.with_suffix(".clips.npy")
        if not clips.exists():
            cache.mkdir(parents=True, exist_ok=True)
            lengths: list[int] = []
            with rows.open("wb") as file:
                for poses in Archive(seed, one_body=one_body).clips(hours):
                    file.write(np.ascontiguousarray(poses, np.float32).data)
                    lengths.append(len(poses))
            np.save(clips, np.repeat(np.arange(len(lengths)), lengths))
        clip_of = np.load(clips)
        return cls(np.memmap(rows, np.float32, "r").reshape(len(clip_of), -1), clip_of)

    @cached_property
    def starts(self) -> np.ndarray:
        """Where each clip begins, and the number of frames."""
        return np.append(np.flatnonzero(np.diff(self.clip_of, prepend=-1)), len(self.clip_of))

    def clips(self) -> list[np.ndarray]:
        """The clips, views of the rows."""
        return [self.rows[a:b] for a, b in zip(self.starts[:-1], self.starts[1:], strict=True)]


def main() -> None:
    """Write an archive."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--hours", type=float, default=1.0, help="up to 50")
    parser.add_argument("--kind", choices=["npz", "bvh"], default="npz")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=np.inf, help="cut clips to so many seconds")
    parser.add_argument("--one-body", action="store_true")
    chosen = parser.parse_args()
    archive = Archive(chosen.seed, chosen.one_body, chosen.seconds)
    files = archive.write(chosen.folder, chosen.hours, chosen.kind)
    size = sum(file.stat().st_size for file in files) / 1e6
    print(f"{len(files)} files, {size:.0f} MB in {chosen.folder}")


if __name__ == "__main__":
    main()
