"""Makes the pictures of README from the embedded troupe: ``python docs/make_pictures.py``."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np

from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.examples.troupe import FIGURES
from onbeat.keyposes.extract import find_keyposes
from onbeat.motion import Motion
from onbeat.viewer.camera import Camera
from onbeat.viewer.figure import DRESSED, Figure, ground_height
from onbeat.viewer.keypose_sheet import keypose_pages, save_pages
from onbeat.viewer.raster import render_frame
from onbeat.viewer.sheet import write_png
from onbeat.viewer.stage import Stage

FOLDER = Path(__file__).parent / "pictures"
SHIRTS = (
    (238, 92, 66), (58, 134, 180), (244, 172, 54), (88, 160, 110),
    (190, 92, 140), (110, 110, 190), (226, 132, 84), (64, 158, 164),
)  # fmt: skip
DANCED = (
    ("star", 5.0), ("kick", 6.0), ("arm waves", 4.0), ("grapevine", 5.0),
    ("bow", 6.0), ("step touch", 5.0), ("folk dance", 6.0), ("offering", 5.0),
)  # fmt: skip
"""What each dancer dances, and the beat at which the picture is taken."""
SIZE = (1320, 400)


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


def troupe_picture() -> np.ndarray:
    """(H, W, 3) uint8: the eight dancers side by side, each in another figure."""
    rng = np.random.default_rng(0)
    figures = {figure.name: figure for figure in FIGURES}
    bodies, places, joints = [], [], []
    for number, (dancer, shirt, (name, beat)) in enumerate(zip(DANCERS, SHIRTS, DANCED, strict=True)):
        danced = perform(dancer, [figures[name]], 1.0, 3, rng)
        body = dressed(danced.motion, shirt)
        second = float(np.interp(beat, np.arange(len(danced.beats)), danced.beats))
        pose = danced.motion.at(np.array([second])).positions[0]
        stands = [*pose[0, :2], ground_height(body, danced.motion)]
        places.append(pose - stands + np.array([1.25 * (3.5 - number), 0.0, 0.0]))
        bodies.append(body)
        joints.append(len(pose))
    camera = Camera((0.0, 16.0, 1.9), (0.0, 0.0, 0.98), view_angle=0.198)
    stage = Stage(light=(0.45, 0.6, 1.0), fine=4)
    return render_frame(np.concatenate(places), company(bodies, joints), camera, SIZE, stage)


def keypose_picture(path: Path) -> None:
    """The sheet of the folk dance: two cycles, eight keyposes each."""
    clip = perform(DANCERS[0], [FOLK_DANCE], 1.0, 2, np.random.default_rng(0))
    within = clip.motion[: round((clip.keyposes[-1] + 0.6) * clip.motion.fps)]
    found = find_keyposes(within, clip.beats)
    save_pages(keypose_pages(found, within, title="the folk dance", cycle=12)[:1], path)


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    keypose_picture(FOLDER / "keyposes.png")
    write_png(FOLDER / "troupe.png", troupe_picture())
