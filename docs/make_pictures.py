"""Makes the pictures of the README from the embedded troupe: ``python docs/make_pictures.py``."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from moving_picture import write_moving
from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.keyposes.extract import find_keyposes
from onbeat.viewer.keypose.sheet import keypose_pages, save_pages

FOLDER = Path(__file__).parent / "pictures"


def keypose_picture(path: Path) -> None:
    """The sheet of the folk dance: two cycles, eight keyposes each."""
    clip = perform(DANCERS[0], [FOLK_DANCE], 1.0, 2, np.random.default_rng(0))
    within = clip.motion[: round((clip.keyposes[-1] + 0.6) * clip.motion.fps)]
    found = find_keyposes(within, clip.beats)
    save_pages(keypose_pages(found, within, title="the folk dance", cycle=12)[:1], path)


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    keypose_picture(FOLDER / "keyposes.png")
    write_moving(FOLDER / "dance.webp")
