"""A Choreonoid pose sequence (``.pseq``, YAML) danced by HRP-4C: key poses to a motion at 120 Hz.

What is between key poses follows Choreonoid's pose sequences:

- Every joint, and every link with a place of its own (waist and feet), has its own list of keys.
- ``maxTransitionTime``: the value is *held* at the last key and moves only during these last seconds before the next.
- Values move on cubics. By ``passing="rest"`` every key is a rest. By ``passing="choreonoid"`` they are passed as that
  program passes them: at the mean of the slopes on both sides, and at rest only where a hold begins or ends, where the
  direction turns, where a joint is stationary (``spJoints``) and where a foot touches the floor.
- Orientations move as roll, pitch and yaw.
- A lifted foot keeps to its place on the floor below 5 mm (the "stealthy step"), so that it never slides.

The legs' own joint angles in the sequence are not used: waist and feet have places, and the legs are bent to them.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yaml
from scipy.interpolate import CubicHermiteSpline

from hrp4c_body import FEET, LEG, ROOT, bend_leg, leg_of, read_body
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import HingeBody, hinge_motion
from onbeat.motion.motion import Motion

FPS = 120.0
SONG_AT = 1.6
"""Seconds of the motion at which the song begins."""
TEMPO = 150.0
UPPER_BODY = range(14, 32)
"""Numbers of the joints of chest, neck and arms."""
PASSING = ("rest", "choreonoid")
FLAT = 0.005  # [m] under which a foot that is lifted or set down moves straight up or down
STILL = 1e-3  # metres or radians: less is no direction


class Key(NamedTuple):
    """Values at a moment: seconds, values (n,), how long the way there may take (0: all the time), whether it rests."""

    time: float
    value: np.ndarray
    transition: float
    rests: bool
    touches: bool = False


@dataclass(frozen=True)
class Dance:
    """The motion, and what it was made from.

    Parameters
    ----------
    motion : at ``FPS``, its second 0 the sequence's.
    body : the robot.
    angles : (F, n) radians.
    places : waist and feet, each (F, 3) metres and (F, 4) wxyz, where they are to be.
    out_of_reach : (F,) metres by which the farther foot cannot get to its place.
    key_poses : (72,) seconds of the motion, of the key poses that move the upper body.
    """

    motion: Motion
    body: HingeBody
    angles: np.ndarray
    places: Mapping[str, tuple[np.ndarray, np.ndarray]]
    out_of_reach: np.ndarray
    key_poses: np.ndarray


def read_dance(folder: Path, passing: str = PASSING[0]) -> Dance:
    """The dance in a folder that holds ``HRP4C.body`` and ``TurnToTheFuture.pseq``, keys passed as in ``PASSING``."""
    if passing not in PASSING:
        raise ValueError(f"no passing {passing!r}; there are {', '.join(PASSING)}")
    body, numbers = read_body(folder / "HRP4C.body")
    poses = yaml.safe_load((folder / "TurnToTheFuture.pseq").read_text(encoding="utf-8"))["refs"]
    times = np.arange(int(poses[-1]["time"] * FPS) + 1) / FPS
    angles = np.zeros((len(times), len(numbers)))
    for column, number in enumerate(numbers):
        if keys := joint_keys(poses, number):
            angles[:, column] = follow(passed(keys, passing), times)[:, 0]
    places = {name: place(passed(link_keys(poses, name), passing), times) for name in (ROOT, *FEET.values())}
    short = np.zeros(len(times))
    for side, foot in FEET.items():
        columns = [body.names.index(f"{side[0].upper()}_{part}") for part in LEG]
        angles[:, columns], missing = bend_leg(leg_of(body, side), places[ROOT], places[foot])
        short = np.maximum(short, missing)
    motion = hinge_motion(body, *places[ROOT], angles, FPS, "Turn to the Future")
    return Dance(motion, body, angles, places, short, upper_body_times(poses))


def upper_body_times(poses: Sequence[Mapping[str, Any]]) -> np.ndarray:
    """Seconds of the key poses that give a joint of the upper body its angle."""
    return np.array([p["time"] for p in poses if set(p["refer"].get("joints", ())) & set(UPPER_BODY)])


def joint_keys(poses: Sequence[Mapping[str, Any]], number: int) -> list[Key]:
    """The keys of one joint."""
    keys: list[Key] = []
    for pose in poses:
        refer = pose["refer"]
        joints = refer.get("joints", [])
        if number in joints:
            value = np.array([refer["q"][joints.index(number)]])
            keys.append(
                Key(pose["time"], value, pose.get("maxTransitionTime", 0.0), number in refer.get("spJoints", []))
            )
    return keys


def link_keys(poses: Sequence[Mapping[str, Any]], name: str) -> list[Key]:
    """The keys of one link: x, y, z in metres, then roll, pitch and yaw in radians."""
    keys: list[Key] = []
    for pose in poses:
        for link in pose["refer"].get("ikLinks", []):
            if link["name"] == name:
                matrix = np.array(link["rotation"]).reshape(1, 3, 3)
                turn = rot.to_euler("ZYX", rot.from_matrix(matrix))[0, ::-1]
                value, touches = np.concatenate((link["translation"], turn)), link.get("isTouching", False)
                rests = touches or link.get("isStationaryPoint", False)
                keys.append(Key(pose["time"], value, pose.get("maxTransitionTime", 0.0), rests, touches))
    return keys


def passed(keys: Sequence[Key], passing: str) -> list[Key]:
    """The keys, all at rest if they are to be."""
    return [key._replace(rests=key.rests or passing == "rest") for key in keys]


def place(keys: Sequence[Key], times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A link's path (N, 3) in metres and turns (N, 4) wxyz at some times; its height goes on its own."""
    turns = np.unwrap([key.value[3:] for key in keys], axis=0)
    keys = [k._replace(value=np.concatenate((k.value[:3], turn))) for k, turn in zip(keys, turns, strict=True)]
    values = follow(stealthy(keys), times)
    values[:, 2] = follow([key._replace(value=key.value[2:3]) for key in keys], times)[:, 0]
    return values[:, :3], rot.from_euler("ZYX", values[:, :2:-1])


def stealthy(keys: Sequence[Key]) -> list[Key]:
    """The keys with rests added to where a foot leaves the floor or comes to it, until it is ``FLAT`` above it.

    Height goes as a cubic from rest to rest at most: ``3u² − 2u³ = FLAT / height`` gives the part u of the time.
    """
    held = with_holds(keys)
    found = [held[0]]
    for before, after in itertools.pairwise(held):
        rise = float(after.value[2] - before.value[2])
        if before.touches != after.touches and abs(rise) > 2 * FLAT:
            u = _reached(FLAT / abs(rise)) * (after.time - before.time)
            if before.touches:
                found.append(before._replace(time=before.time + u, rests=True))
            else:
                found.append(after._replace(time=after.time - u, rests=True))
        found.append(after)
    return found


def _reached(part: float) -> float:
    """When a cubic from rest to rest, 0 to 1 in a time of 1, is at ``part``."""
    return float(0.5 - np.sin(np.arcsin(1 - 2 * part) / 3))


def with_holds(keys: Sequence[Key]) -> list[Key]:
    """The keys with one more wherever a value is held: at the end of the hold; both its ends rest."""
    found: list[Key] = []
    for key in keys:
        if found and 0 < key.transition < key.time - found[-1].time:
            found[-1] = found[-1]._replace(rests=True)
            found.append(found[-1]._replace(time=key.time - key.transition))
        found.append(key._replace(transition=0.0))
    return found


def follow(keys: Sequence[Key], times: np.ndarray) -> np.ndarray:
    """The values (N, n) at some times; before the first and after the last key they stand still."""
    keys = with_holds(keys)
    at = np.array([key.time for key in keys])
    # Of several keys at one moment the last counts.
    last = np.flatnonzero(np.append(np.diff(at) > 1e-6, True))
    at, values = at[last], np.array([keys[k].value for k in last])
    if len(at) == 1:
        return np.repeat(values, len(times), axis=0)
    curve = CubicHermiteSpline(at, values, speeds(at, values, np.array([keys[k].rests for k in last])))
    return curve(np.clip(times, at[0], at[-1]))


def speeds(at: np.ndarray, values: np.ndarray, rests: np.ndarray) -> np.ndarray:
    """Speed (K, n) with which each key is passed."""
    step, gap = np.diff(values, axis=0), np.diff(at)[:, None]
    result = np.zeros_like(values)
    before, after = step[:-1], step[1:]
    passing = (np.abs(before) >= STILL) & (np.abs(after) >= STILL) & (before * after > 0) & ~rests[1:-1, None]
    result[1:-1] = np.where(passing, (before / gap[:-1] + after / gap[1:]) / 2, 0.0)
    return result
