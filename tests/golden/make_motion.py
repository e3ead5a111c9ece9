"""Makes ``motion/``: one small file of each format and where its joints are. Run it only where a format is to change.

The positions are those of the motion before it was written; whoever changes a reader or a writer by accident is told.
"""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from onbeat.formats import write_motion
from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_motion
from onbeat.motion.unitree_g1 import G1
from persons import person, swinging

FOLDER = Path(__file__).parent / "motion"
FILES = {"body": ("bvh", "npz", "c3d", "trc"), "robot": ("csv", "tracking.npz")}


def motions() -> dict[str, Motion]:
    t = np.arange(4) / 30
    angles = G1.low + (G1.high - G1.low) * (0.5 + 0.2 * np.sin(5 * t[:, None] + np.arange(len(G1.low))))
    turns = rot.exp(np.stack((0.1 * t, 0.2 * t, t), axis=1))
    return {
        "body": swinging(person(), 4, 30, seed=2006, angle=0.4),
        "robot": hinge_motion(G1, np.stack((t, 0 * t, 0.8 - 0.1 * t), axis=1), turns, angles, 30.0, "robot"),
    }


def main() -> None:
    FOLDER.mkdir(exist_ok=True)
    places = {}
    for name, motion in motions().items():
        for suffix in FILES[name]:
            write_motion(motion, FOLDER / f"{name}.{suffix}")
        joints = zip(motion.skeleton.names, np.moveaxis(motion.positions, 1, 0).round(6).tolist(), strict=True)
        places[name] = dict(joints)
    (FOLDER / "positions.json").write_text(json.dumps(places, indent=0) + "\n")


if __name__ == "__main__":
    main()
