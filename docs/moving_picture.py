"""The moving picture of the README: the troupe dances eight beats of its own song, over and over."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
from PIL import Image

from onbeat._shapes import Times
from onbeat.examples import embedded_song
from onbeat.examples.dancers import DANCERS
from onbeat.examples.performer import perform
from onbeat.examples.troupe import FIGURES
from onbeat.motion import Motion
from onbeat.viewer.figure import DRESSED, Figure, ground_height
from onbeat.viewer.film.strip import Strip, loudness
from onbeat.viewer.render.camera import Camera
from onbeat.viewer.render.raster import render_frame
from onbeat.viewer.render.stage import Stage

DANCED = ("star", "kick", "arm waves", "step touch", "punch", "arm circles", "offering", "turn")
"""What each dancer dances; all of them come round in four or eight beats."""
SHIRTS = (
    (238, 92, 66), (58, 134, 180), (244, 172, 54), (88, 160, 110),
    (190, 92, 140), (110, 110, 190), (226, 132, 84), (64, 158, 164),
)  # fmt: skip
SIZE, FOOT, FPS, BEATS = (880, 310), 44, 15.0, 8
END = BEATS - 0.5
"""The picture begins half a beat before the first beat, and so ends half a beat after the last."""
LARGEST = 1_500_000
ACCENT, QUIET = np.array([238.0, 92.0, 66.0]), np.array([196.0, 203.0, 212.0])


def company(bodies: list[Figure], joints: list[int]) -> Figure:
    """Several bodies as one figure; their joints follow each other in this order."""
    firsts = np.concatenate(([0], np.cumsum(joints)))
    edges = np.concatenate(([0], np.cumsum([len(body.joints) for body in bodies])))
    adjacent = np.zeros((edges[-1], edges[-1]), np.bool_)
    for body, (begin, end) in zip(bodies, pairwise(edges.tolist()), strict=True):
        adjacent[begin:end, begin:end] = body.adjacent
    return Figure(
        np.concatenate([body.joints + first for body, first in zip(bodies, firsts.tolist(), strict=False)]),
        *(np.concatenate([getattr(body, name) for body in bodies]) for name in ("reach", "radii", "colours")),
        adjacent,
    )


def dressed(motion: Motion, shirt: tuple[int, int, int]) -> Figure:
    """A dancer's body in a shirt of its own colour."""
    return Figure.of(motion.skeleton, {**DRESSED, **dict.fromkeys(("torso", "left_arm", "right_arm"), shirt)})


def troupe_at(beats: np.ndarray) -> tuple[np.ndarray, Figure]:
    """(N, joints, 3) metres, the eight dancers side by side at each of N beats; and their figure.

    Over the last beat before ``END`` each goes over to where it began, so that the picture has no end.
    """
    rng, figures = np.random.default_rng(0), {figure.name: figure for figure in FIGURES}
    bodies, places = [], []
    for number, (dancer, shirt, name) in enumerate(zip(DANCERS, SHIRTS, DANCED, strict=True)):
        danced = perform(dancer, [figures[name]], 1.0, 24 // figures[name].beats, rng)
        body = dressed(danced.motion, shirt)
        first = BEATS

        def poses(at: np.ndarray, danced=danced) -> np.ndarray:
            return danced.motion.at(np.interp(at, np.arange(len(danced.beats)), danced.beats)).positions

        share = np.clip(beats - END + 1, 0.0, 1.0)[:, None, None]
        looped = (1 - share) * poses(first + beats) + share * poses(first + beats - BEATS)
        stands = [*looped[:, 0, :2].mean(axis=0), ground_height(body, danced.motion)]
        places.append(looped - stands + np.array([1.2 * (3.5 - number), 0.0, 0.0]))
        bodies.append(body)
    joints = [place.shape[1] for place in places]
    return np.concatenate(places, axis=1), company(bodies, joints)


def disc(picture: np.ndarray, x: float, y: float, radius: float, colour: np.ndarray) -> None:
    """A filled circle with a soft edge."""
    rows, columns = np.mgrid[: picture.shape[0], : picture.shape[1]]
    cover = np.clip(radius - np.hypot(columns - x, rows - y) + 0.5, 0.0, 1.0)[..., None]
    picture[:] = np.round(picture * (1 - cover) + colour * cover).astype(np.uint8)


def mark_beats(picture: np.ndarray, beat: float, downbeats: list[int]) -> None:
    """A row of dots, one a beat, the first of a bar larger; each lights up on its beat and fades until the next."""
    for number in range(BEATS):
        since = (beat - number) % BEATS
        lit = (1.0 - since) if since < 1.0 else 0.0
        radius = (6.0 if number in downbeats else 4.5) + 3.0 * lit
        disc(
            picture,
            picture.shape[1] * (number + 0.5) / BEATS,
            picture.shape[0] - 16.0,
            radius,
            QUIET + lit * (ACCENT - QUIET),
        )


def stretch() -> tuple[Times, list[int], np.ndarray, int]:
    """Ten beats of the embedded song, the second a downbeat; which of those from there on are; samples, their rate."""
    song, samples, rate = embedded_song(seconds=30.0)
    first = int(np.searchsorted(song.beats, song.downbeats[4] - 1e-6))
    beats = song.beats[first - 1 : first + BEATS + 1]
    return beats, [n for n in range(BEATS) if np.abs(song.downbeats - beats[n + 1]).min() < 1e-3], samples, rate


def frames() -> list[np.ndarray]:
    """The pictures (H, W, 3) uint8 of eight beats."""
    beats, downbeats, samples, rate = stretch()
    begin, end = np.interp([-0.5, END], np.arange(-1, BEATS + 1), beats)
    length = end - begin
    count = round(length * FPS)
    times = np.arange(count) / count * length
    at = np.interp(begin + times, beats, np.arange(-1, BEATS + 1))
    positions, figure = troupe_at(at)
    sound = samples[round(begin * rate) : round(end * rate)]
    strip = Strip.of(None, loudness(sound, SIZE[0], length, rate), np.zeros(0), length, FOOT, SIZE[0])
    camera, stage = Camera((0.0, 16.0, 2.1), (0.0, 0.0, 0.98), view_angle=0.226), Stage(light=(0.45, 0.6, 1.0), fine=4)
    made = []
    for pose, beat, time in zip(positions, at.tolist(), times.tolist(), strict=True):
        picture = np.zeros((SIZE[1] + FOOT, SIZE[0], 3), np.uint8)
        picture[: SIZE[1]] = render_frame(pose, figure, camera, SIZE, stage)
        strip.draw(picture, time)
        mark_beats(picture[: SIZE[1]], beat, downbeats)
        made.append(picture)
    return made


def write_moving(path: Path) -> None:
    """Write the moving picture as WebP."""
    first, *others = [Image.fromarray(picture) for picture in frames()]
    first.save(
        path, "WEBP", save_all=True, append_images=others, duration=round(1000 / FPS), loop=0, quality=62, method=6
    )
    if path.stat().st_size > LARGEST:
        raise RuntimeError(f"{path} has {path.stat().st_size} bytes; more than {LARGEST}")
