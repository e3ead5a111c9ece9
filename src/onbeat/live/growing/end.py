"""The end of a growing dance made anew: joins fitted and blended, feet planted, going on from what stays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from onbeat.dance.blend import inertial
from onbeat.dance.plan import DancePlan
from onbeat.dance.realise import joined
from onbeat.dance.sources import BEYOND, Sources, standing_at
from onbeat.dance.windows import LONGEST, fitted_windows
from onbeat.live.growing.frames import Frames
from onbeat.live.growing.placing import Dancers, Placed
from onbeat.live.growing.planting import Floor, planted
from onbeat.motion.kinematics import forward_kinematics

CONTEXT = 2
"""Frames before those made anew that tell where they go on, and how fast."""
RUN_UP = LONGEST / 2
"""Seconds before what is made anew that count for the room that the first join's window has."""


def grown(dancers: Dancers, moves: Sequence[Placed], before: Frames, first: int, fps: float) -> Frames:
    """The frames from ``first`` on, up to a little beyond the end of the last move.

    Parameters
    ----------
    dancers : the clips.
    moves : those shown from the first frame on, in order.
    before : the frames so far; none of those before the first is inside the window of a join that comes later.
    first : number of the first frame to make.
    fps : frames a second.
    """
    fixed = min(CONTEXT, first - before.first)
    base = first - fixed
    run_up = min(RUN_UP, (moves[0].second(base / fps) + BEYOND) / moves[0].move.rate * (1 - 1e-6))
    sources = _sources(dancers, moves, base / fps - run_up)
    times = run_up + np.arange(int((sources.plan.duration - run_up) * fps + 1e-6) + 1) / fps
    local = np.maximum(sources.moves_at(times), 0)
    shown = sources.pose(local, times)
    world = forward_kinematics(sources.skeleton, shown.rotations, shown.roots)
    windows = fitted_windows(sources, inertial, dancers.peaks)
    blended = joined(sources, windows, inertial, shown, times)
    numbers = np.array([placed.number for placed in moves], np.int64)[local]
    old = before.between(base, base + len(times))
    floor = Floor(dancers.body, times, local, numbers, windows, old, fixed)
    steps = floor.steps(standing_at(sources, dancers.standing, local, times), world)
    pose, offsets, anchors, sinks = planted(floor, blended, world, steps)
    joining = windows.join_at(times) >= 0
    frames = Frames(base, pose.rotations, pose.roots, steps.contacts, offsets, anchors, sinks, numbers, joining)
    return frames.between(first, frames.after)


def _sources(dancers: Dancers, moves: Sequence[Placed], base: float) -> Sources:
    """The moves in their places, on a clock that begins at second ``base`` of the dance, the last going on a little."""
    end = moves[-1].end + BEYOND / moves[-1].move.rate * (1 - 1e-6)
    moves = (*moves[:-1], moves[-1].until(end))
    first = replace(moves[0].move, from_s=moves[0].second(base), at_s=0.0)
    later = [replace(placed.move, at_s=placed.move.at_s - base) for placed in moves[1:]]
    plan = DancePlan((first, *later), end - base)
    turns, shifts = np.array([placed.turn for placed in moves]), np.stack([placed.shift for placed in moves])
    return replace(Sources.of(dancers.clips, plan), turns=turns, shifts=shifts)
