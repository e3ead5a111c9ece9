"""Steps that dancers were taught and tried, as files: what the tests of ``onbeat recognise`` share."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from onbeat.examples.dancers import DANCERS
from onbeat.examples.performer import perform
from onbeat.examples.repertoire import CLAPS, STAR, SWAY
from onbeat.formats import write_motion

HEAD = "file,from,to,task,person,cycle\n"


def write_steps(place: Path) -> Path:
    """Three dancers, two steps, three cycles: two to learn from, one to try; and a step that nobody taught."""
    rng = np.random.default_rng(0)
    rows: dict[str, list[str]] = {"taught": [], "tried": [], "other": []}
    for dancer in DANCERS[:3]:
        for figure in (CLAPS, SWAY, STAR):
            clip = perform(dancer, [figure], 1.0, 3, rng, 30.0)
            name = f"{dancer.name} {figure.name}.npz"
            write_motion(clip.motion, place / name)
            for cycle in range(3):
                start, end = clip.beats[2 + 4 * cycle], clip.beats[5 + 4 * cycle]
                row = f"{name},{start:.3f},{end:.3f},{figure.name},{dancer.name},{cycle}"
                rows["other" if figure is STAR else "tried" if cycle == 2 else "taught"].append(row)
    (place / "bare.csv").write_text("file,from,to\nAiko claps.npz,1,2\n")
    (place / "beyond.csv").write_text(HEAD + "Aiko claps.npz,1,99,claps,Aiko,0\n")
    for name, lines in rows.items():
        (place / f"{name}.csv").write_text(HEAD + "\n".join(lines) + "\n")
    return place
