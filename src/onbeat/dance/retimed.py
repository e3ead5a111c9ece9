"""A dance in another time in one call: its beats, keyposes and limits are found where they are not told."""

from __future__ import annotations

from onbeat._shapes import Times
from onbeat.keyposes.own import own_time
from onbeat.limits.learned import learned_limits
from onbeat.limits.limits import Limits
from onbeat.limits.named import robot_limits
from onbeat.motion.motion import Motion
from onbeat.music.song import Song
from onbeat.retime.meeting import wanted_time
from onbeat.retime.retime import Retimed, retime
from onbeat.retime.sources import is_g1, source_of


def retime_motion(
    motion: Motion,
    speed: float | None = None,
    *,
    song: Song | None = None,
    limits: Limits | None = None,
    beats: Times | None = None,
    keyposes: Times | None = None,
    method: str = "qp",
) -> Retimed:
    """The same dance faster or slower, or to a song, inside the limits of the body; keyposes stay what they are.

    Parameters
    ----------
    motion : the dance, of a character or of the robot Unitree G1.
    speed : 1.2 is a fifth faster.
    song : to be danced to instead, beat by beat, through changes of its tempo.
    limits : of the joints. Without them a robot's own, and of a character as fast as each joint turns in the dance.
    beats, keyposes : (B,) and (K,) seconds of the dance; found in it where they are not given.
    method : a name of ``onbeat.retime.methods.METHODS``.

    Raises
    ------
    PlanError
        If both a speed and a song are given, the dance keeps no pulse and no beats are given, or there is no method of
        that name.
    LimitError
        If the limits lack a joint.

    Examples
    --------
    >>> import numpy as np
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.folk_dance import FOLK_DANCE
    >>> from onbeat.examples.performer import perform
    >>> clip = perform(DANCERS[0], [FOLK_DANCE], 1.0, 1, np.random.default_rng(0))
    >>> faster = retime_motion(clip.motion, 1.25, beats=clip.beats, keyposes=clip.keyposes)
    >>> round(clip.motion.duration, 1), round(faster.dance.duration, 1), sum(faster.measures.violations)
    (9.2, 7.4, 0)
    """
    own = own_time(motion, beats, keyposes)
    wanted = wanted_time(own.beats, speed, song)
    if limits is None:
        limits = robot_limits("g1") if is_g1(motion) else learned_limits([motion])
    return retime(source_of(motion), wanted.warp, limits, own.beats, own.keyposes, method, until=wanted.until)
