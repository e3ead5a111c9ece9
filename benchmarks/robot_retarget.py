"""How near a robot's arms are to the dancer's, and what a retargeting per frame costs in limits, jumps and collisions.

The error is the angle between the dancer's upper arms and forearms and the robot's, over all frames: none is left out
for being out of reach. The baseline is damped least squares, frame by frame, without limits, smoothness or collisions,
and is nearer for that. A hand's stop (a minimum of its speed, a quarter of the fast ones deep) is kept where the
robot's hand has one within 50 ms.
"""

from __future__ import annotations

import time

import numpy as np
from scipy.signal import find_peaks

from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body
from onbeat.motion.contacts import point_speeds
from onbeat.motion.hinges import hinge_angles, hinge_motion
from onbeat.robots.ik.collision import capsules_of, clearances
from onbeat.robots.ik.directions import aims_of
from onbeat.robots.ik.trajectory import Problem, solve
from onbeat.robots.ik.tree import ROOT, tree_of
from onbeat.robots.model import Robot, robot_named
from onbeat.robots.retarget import retarget, rules_of

SECONDS, RATE = 10.0, 60.0
HEADS = ("error °, mean", "p95", "past limits %", "steps too fast %", "colliding %", "stops kept", "× real time")


def retargeting(dances: list[tuple[str, Motion]]) -> None:
    """A table of all dances, ours and the baseline under it."""
    robot = robot_named("g1")
    retarget(dances[0][1][:60], robot)  # compiled
    print(f"\nRetargeting to the G1, first {SECONDS:.0f} s of each; under each the baseline, per frame")
    print(f"  {'':26} " + " ".join(f"{head:>16}" for head in HEADS))
    for name, motion in dances:
        part = motion[: int(SECONDS * motion.fps)]
        for told, way in ((name, retarget), ("", per_frame)):
            began = time.process_time()
            made = way(part, robot)
            spent = time.process_time() - began
            print(f"  {told[:26]:26} " + " ".join(f"{cell:>16}" for cell in _cells(part, made, robot, spent)))


def _cells(dancer: Motion, made: Motion, robot: Robot, spent: float) -> list[str]:
    shown = dancer.at(np.clip(made.times, 0, dancer.times[-1])).replace(fps=made.fps)
    error = arm_errors(shown, made)
    angles = np.unwrap(hinge_angles(robot.body, made), axis=0)
    past = ((angles < robot.body.low - 1e-6) | (angles > robot.body.high + 1e-6)).any(axis=1).mean()
    fast = (np.abs(np.diff(angles, axis=0)) * made.fps > robot.body.speed * (1 + 1e-6)).any(axis=1).mean()
    touching = (clearances(made, capsules_of(robot)).min(axis=1) < 0).mean()
    kept, stops = _stops_kept(shown, made)
    shares = [f"{100 * share:.1f}" for share in (past, fast, touching)]
    return [
        f"{error.mean():.2f}",
        f"{np.percentile(error, 95):.1f}",
        *shares,
        f"{kept} of {stops}",
        f"{dancer.duration / spent:.1f}",
    ]


def arm_errors(dancer: Motion, robot: Motion) -> np.ndarray:
    """(F, 4) degrees between upper arms and forearms."""
    theirs, ours = Body.of(dancer.skeleton), Body.of(robot.skeleton)
    out = []
    for side in ("left", "right"):
        for top, end in (("shoulder", "elbow"), ("elbow", "wrist")):
            u, v = (
                motion.positions[:, body[f"{side}_{end}"]] - motion.positions[:, body[f"{side}_{top}"]]
                for motion, body in ((dancer, theirs), (robot, ours))
            )
            cosine = np.sum(u * v, axis=1) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
            out.append(np.degrees(np.arccos(np.clip(cosine, -1, 1))))
    return np.stack(out, axis=1)


def _stops_kept(dancer: Motion, robot: Motion) -> tuple[int, int]:
    kept = total = 0
    for theirs, ours in zip(_stops(dancer), _stops(robot), strict=True):
        total += len(theirs)
        kept += sum(bool(len(ours)) and bool(np.abs(ours - stop).min() <= 0.05) for stop in theirs)
    return kept, total


def _stops(motion: Motion) -> list[np.ndarray]:
    body, out = Body.of(motion.skeleton), []
    for side in ("left", "right"):
        hand = motion.positions[:, [body[f"{side}_wrist"]]] - motion.positions[:, [body["hips"]]]
        speed = point_speeds(hand, motion.fps)[:, 0]
        out.append(find_peaks(-speed, prominence=0.25 * np.percentile(speed, 90))[0] / motion.fps)
    return out


def per_frame(motion: Motion, robot: Robot) -> Motion:
    """Damped least squares, each frame from the one before."""
    body = robot.body
    dancer = motion.at(np.arange(int((len(motion) - 1) / motion.fps * RATE) + 1) / RATE).replace(fps=RATE)
    aims, capsules = aims_of(dancer, robot), capsules_of(robot)
    wide, count = np.full(ROOT + len(body.names), np.inf), len(body.names)
    bent = 0.8 * np.clip(0.0, body.low, body.high) + 0.1 * (body.low + body.high)
    start = np.concatenate((np.zeros(ROOT), bent))
    rules = rules_of(robot)._replace(low=-wide, high=wide)
    problem = Problem(tree_of(body), aims, capsules, rules, np.zeros((len(dancer), len(capsules.pairs))), 1 / RATE)
    found = np.tile(start, (len(dancer), 1))
    for frame in range(len(dancer)):
        part = problem.cut(slice(frame, frame + 1))
        found[frame] = solve(part, found[max(frame - 1, 0)][None], steps=8).x[0]
    turns = rot.multiply(rot.exp(found[:, 3:ROOT]), rot.from_matrix(aims.turn))
    assert found.shape[1] == ROOT + count
    return hinge_motion(body, aims.place + found[:, :3], turns, found[:, ROOT:], RATE)
