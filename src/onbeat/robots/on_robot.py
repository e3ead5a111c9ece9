"""A dance on a robot in one call: its beats and keyposes are found where they are not told."""

from __future__ import annotations

from onbeat._shapes import Times
from onbeat.keyposes.own import own_time
from onbeat.motion.motion import Motion
from onbeat.music.song import Song
from onbeat.retime.meeting import wanted_time
from onbeat.robots.model import Robot, robot_named
from onbeat.robots.perform import Feet, Staged, stage


def dance_on_robot(
    motion: Motion,
    robot: Robot | str = "g1",
    *,
    speed: float | None = None,
    song: Song | None = None,
    beats: Times | None = None,
    keyposes: Times | None = None,
    feet: Feet = "planted",
) -> Staged:
    """A dance on a humanoid robot: retargeted, in its time or a song's, inside its limits, balanced.

    Parameters
    ----------
    motion : the dance, of any body, or of the robot itself.
    robot : the model (``onbeat.robot_named``, ``onbeat.robot_from``), or its name.
    speed : 1.2 is a fifth faster.
    song : to be danced to instead, beat by beat.
    beats, keyposes : (B,) and (K,) seconds of the dance; found in it where they are not given.
    feet : "planted", both where they are all the time, or "stepping", where the dancer steps.

    Raises
    ------
    BodyError
        If there is no such robot, or the dance cannot be the robot's.
    PlanError
        If both a speed and a song are given, or the dance keeps no pulse and no beats are given.
    MissingExtraError
        If MuJoCo is not installed.

    Examples
    --------
    >>> import numpy as np
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.folk_dance import FOLK_DANCE
    >>> from onbeat.examples.performer import perform
    >>> clip = perform(DANCERS[0], [FOLK_DANCE], 1.0, 1, np.random.default_rng(0))
    >>> staged = dance_on_robot(clip.motion[:90], beats=clip.beats, keyposes=clip.keyposes[:1])
    >>> staged.motion.skeleton.names[0], staged.limits.violations, bool((staged.balanced.margin > 0).all())
    ('pelvis', (0, 0), True)
    """
    model = robot_named(robot) if isinstance(robot, str) else robot
    own = own_time(motion, beats, keyposes)
    wanted = wanted_time(own.beats, speed, song)
    return stage(motion, model, wanted.warp, own.beats, own.keyposes, feet, until=wanted.until)
