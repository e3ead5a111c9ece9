"""How deep the feet of a live dance are in the floor, before and after they are pressed out of it, and what that costs.

Usage: ``python benchmarks/live_soles.py MOTIONS… [--source-fps F] [--seconds S]``. The motions are danced one after the
other to a song by the embedded band at 112 beats a minute, in a session without a clock. Looked at are all joints from
the ankles on. The cost is processor time of the press alone; the budget of a pose is 10 ms.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np

from live_sessions import run
from made_songs import made_song, steady
from onbeat.formats.read import read_motion
from onbeat.live.beat.pulse import Pulse
from onbeat.live.bodies.dancers import Character
from onbeat.live.bodies.soles import Soles
from onbeat.live.cast import Known, following
from onbeat.live.session import Session
from onbeat.motion.soles import FREE

APART = 0.55  # [s] between the beats that the motions are taken to have


class Watched:
    """Soles that keep what they did: the lowest joint of each pose before and after, and seconds a pose."""

    def __init__(self, soles: Soles) -> None:
        self._soles = soles
        self.before, self.after, self.seconds = list[np.ndarray](), list[np.ndarray](), list[float]()

    def pressed(self, rotations: np.ndarray, roots: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """As of :class:`Soles`."""
        began = time.thread_time()
        pressed = self._soles.pressed(rotations, roots, places)
        self.seconds.append((time.thread_time() - began) / len(roots))
        self.before.append(places[:, self._soles.feet, 2].min(axis=1))
        self.after.append(pressed[1][:, self._soles.feet, 2].min(axis=1))
        return pressed


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("motions", type=Path, nargs="+")
    parser.add_argument("--source-fps", type=float, help="of motions that store no rate")
    parser.add_argument("--seconds", type=float, default=60.0)
    given = parser.parse_args()
    motions = [read_motion(path, given.source_fps) for path in given.motions]
    cast = following([Known(one, np.arange(0.3, one.duration, APART), np.zeros(0)) for one in motions])
    if not isinstance(cast.dancer, Character):
        parser.error("no character dances these motions; robots stand on planted feet")
    watched = Watched(cast.dancer.soles)
    object.__setattr__(cast.dancer, "soles", watched)
    run(Session(Pulse(), cast.conductor, cast.dancer), made_song(steady(112), given.seconds, 3)[0], keep=False)
    before, after = np.concatenate(watched.before), np.concatenate(watched.after)
    cost = 1e6 * np.array(watched.seconds)
    pressed = np.array([(lowest < -FREE).any() for lowest in watched.before])
    print(f"{len(before)} poses, {(before < -FREE).mean():.1%} of them with a foot deeper than {1000 * FREE:g} mm")
    print(f"deepest joint of a foot: {1000 * before.min():.1f} mm before, {1000 * after.min():.1f} mm after")
    print(f"microseconds a pose: {cost.mean():.0f} on average", end="")
    for name, which in (("where nothing is deep", ~pressed), ("where something is", pressed)):
        print(f", {np.median(cost[which]):.1f} {name}" if which.any() else "", end="")
    print()


if __name__ == "__main__":
    sys.exit(main())
