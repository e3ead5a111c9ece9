"""Beats of a motion without music: the steady pulse that its own rests keep.

Not in the papers. Each local minimum of the energy is heard as a soft drum, the louder the deeper it is; the
bar-pointer model that hears songs then finds the likeliest steady chain of beats through them. A dance may rest on
every second beat only: then the pulse is that of its rests.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.errors import PlanError
from onbeat.keyposes.candidates import Minima, minima
from onbeat.keyposes.energy import RATE, energy_of
from onbeat.keyposes.points import body_points
from onbeat.motion.markers import Markers
from onbeat.motion.motion import Motion
from onbeat.music.decode import decode_beats
from onbeat.music.tempo import beat_space

WIDTH = 0.04
"""Seconds, standard deviation of a rest's time about its beat."""
DEEP = 1.0
"""Rise beside a minimum, in units of the mean energy, that makes a rest as sure as rests get."""
EMPTY, GAIN = 0.15, 4.0
"""Strength at which a moment is as likely a beat as not, and log odds per unit of strength."""
STEADINESS, PRIOR_WEIGHT = 40.0, 1.0
"""Cost of a change of tempo, and of an unusual one per second, as in ``music.barpointer``."""


def motion_beats(source: Motion | Markers, local: bool = True) -> Times:
    """Beats (B,) in seconds that a motion keeps by itself; without ``local`` by how it moves in the world alone.

    Raises
    ------
    PlanError
        If the motion is too short or rests too seldom to have a pulse.

    Examples
    --------
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.folk_dance import FOLK_DANCE
    >>> from onbeat.examples.performer import perform
    >>> clip = perform(DANCERS[0], [FOLK_DANCE], 1.0, 2, np.random.default_rng(0))
    >>> float(np.median(np.diff(motion_beats(clip.motion))).round(2)), float(np.diff(clip.beats)[0].round(2))
    (0.58, 0.58)
    """
    energy = energy_of(body_points(source, local=local))
    rests = [minima(curve) for curve in (energy.world, energy.local) if len(curve)]
    heard = sum((strength(one, len(energy.times)) for one in rests), np.zeros(len(energy.times))) / len(rests)
    label = source.name or "the motion"
    if min(len(one.times) for one in rests) < 2:
        raise PlanError(
            f"{label} has no pulse of its own: {(len(source) - 1) / source.fps:.2f} s with {len(rests[-1].times)} "
            "rests; give its beats (--beats) or the song that it is danced to, or take more of it"
        )
    frames = decode_beats(GAIN * (heard - EMPTY), beat_space(RATE, STEADINESS), PRIOR_WEIGHT)
    beats = frames / RATE
    inside = (beats > rests[-1].times[0] - 1.0) & (beats < rests[-1].times[-1] + 1.0)
    if inside.sum() < 2:
        raise PlanError(
            f"{label}: no two beats are kept in {(len(source) - 1) / source.fps:.2f} s; give the beats or the song"
        )
    return beats[inside]


def strength(rests: Minima, count: int) -> Array:
    """How much of a rest there is (N,) at 120 Hz, 0…1."""
    result = np.zeros(count)
    times = np.arange(count) / RATE
    depth = np.minimum(rests.rises / DEEP, 1.0)
    reach = int(4 * WIDTH * RATE)
    for time, deep in zip(rests.times, depth, strict=True):
        at = round(time * RATE)
        part = slice(max(at - reach, 0), at + reach + 1)
        np.maximum(result[part], deep * np.exp(-0.5 * ((times[part] - time) / WIDTH) ** 2), out=result[part])
    return result
