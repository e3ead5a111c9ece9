"""How well a dance is on the beat.

People see a dance on the beat when its movements stop, turn or hit where the music has its beats. Two lists of times
in seconds are compared: ``stops``, the motion's beats (see :mod:`onbeat.motion.features`), and ``beats``, the music's.

Conventions
-----------
Both lists are in seconds on the song's clock, in increasing order; ``duration`` is how long the dance is, and only
what lies within 0…``duration`` counts. Nothing on either side scores 0.

Metrics
-------
* :func:`precision_recall_f` : the parts of stops on a beat and of beats with a stop, and their harmonic mean, within a
  tolerance, matched one to one and optimally, as beat trackers are judged (``mir_eval.beat.f_measure``).
* :func:`beat_align_fact` : mean of ``exp(−d²/2σ²)`` over the stops, d to the nearest beat (Li et al. 2021, FACT).
* :func:`beat_align_bailando` : the same over the beats, d to the nearest stop (Siyao et al. 2022, Bailando).

The two beat-align scores bear one name in the literature and do not agree. σ is in seconds here, 0.05 s, the published
3 frames at 60 fps. For evenly spaced beats chance alone gives about ``√(2π)·σ/spacing``, 0.25 at 120 beats a minute.
No score means anything without chance beside it, so each comes with one or two nulls:

* :func:`phase_null` : all stops shifted by one random phase, around the end. Keeps both rhythms and breaks their
  relation. A dance with its own steady pulse scores high by luck in some shifts, so z stays near 2–3 at best.
* :func:`jitter_null` : each beat moved by up to half its own interval either way. Asks whether the stops follow *these*
  beats rather than others as dense. z of 1 is chance, 10 is a dance.

``z = (score − mean(null)) / std(null)``; :func:`evaluate` gives None where a null does not vary or cannot be made.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.errors import MetricError

TOLERANCES = {"50": 0.05, "100": 0.10}
"""Seconds either way within which a stop is on a beat, by the names used in results (milliseconds)."""
SIGMA = 0.05
"""σ of the beat-align scores in seconds: 3 frames at 60 fps."""
SAMPLES = 200
"""How many times a null is drawn."""

Score = Callable[[Times, Times], float]


def validate(stops: Times, beats: Times, duration: float) -> None:
    """Raise a ``MetricError`` that names what is wrong with the times or the duration."""
    for name, times in (("stops", stops), ("beats", beats)):
        _validate_times(name, times)
    if not (np.isfinite(duration) and duration > 0):
        raise MetricError(f"the duration is {duration} s; a positive number of seconds is needed")


def _validate_times(name: str, times: Times) -> None:
    if times.ndim != 1:
        raise MetricError(f"{name} have shape {times.shape}; one list of seconds, (N,), is needed")
    if not np.isfinite(times).all():
        raise MetricError(f"{name}: number {int(np.argmin(np.isfinite(times)))} is {times[~np.isfinite(times)][0]}")
    later = np.diff(times) < 0
    if later.any():
        at = int(np.argmax(later))
        raise MetricError(f"{name} go back from {times[at]:g} s to {times[at + 1]:g} s; sort them")


def matches(stops: Times, beats: Times, tolerance: float) -> int:
    """The most pairs of a stop and a beat within ``tolerance`` seconds, each used once.

    With one tolerance for all, taking the earliest possible pair each time is optimal.

    Examples
    --------
    >>> matches(np.array([0.99, 1.01]), np.array([1.0, 2.0]), 0.05)
    1
    """
    if (beats[1:] - tolerance > beats[:-1] + tolerance).all():  # no stop is near two beats: count those that have one
        first, last = np.searchsorted(stops, beats - tolerance), np.searchsorted(stops, beats + tolerance, "right")
        return int(np.count_nonzero(last > first))
    early, late = (beats - tolerance).tolist(), (beats + tolerance).tolist()
    found = beat = 0
    for stop in stops.tolist():
        while beat < len(late) and late[beat] < stop:
            beat += 1
        if beat == len(late):
            break
        if early[beat] <= stop:
            found += 1
            beat += 1
    return found


def precision_recall_f(stops: Times, beats: Times, tolerance: float) -> tuple[float, float, float]:
    """Precision (stops on a beat), recall (beats with a stop) and ``F = 2PR / (P + R)``, 0…1.

    Examples
    --------
    >>> precision_recall_f(np.array([0.5, 1.02]), np.array([1.0, 2.0, 3.0, 4.0]), 0.05)
    (0.5, 0.25, 0.3333333333333333)
    """
    if not len(stops) or not len(beats):
        return 0.0, 0.0, 0.0
    found = matches(stops, beats, tolerance)
    return found / len(stops), found / len(beats), 2 * found / (len(stops) + len(beats))


def recall(stops: Times, beats: Times, tolerance: float) -> float:
    """The part of ``beats`` (all, or the strong ones only) that have a stop within ``tolerance`` seconds."""
    return precision_recall_f(stops, beats, tolerance)[1]


def f_measure(stops: Times, beats: Times, tolerance: float) -> float:
    """F within ``tolerance`` seconds, 0…1."""
    return precision_recall_f(stops, beats, tolerance)[2]


def _alignment(events: Times, to: Times, sigma: float) -> float:
    """``1/N Σ_i exp(−min_j (e_i − t_j)² / 2σ²)`` over the events."""
    if not len(events) or not len(to):
        return 0.0
    right = np.minimum(np.searchsorted(to, events), len(to) - 1)
    distance = np.minimum(np.abs(to[right] - events), np.abs(to[np.maximum(right - 1, 0)] - events))
    return float(np.exp(-(distance**2) / (2 * sigma**2)).mean())


def beat_align_fact(stops: Times, beats: Times, sigma: float = SIGMA) -> float:
    """Beat-align score over the motion's beats (FACT, Li et al. 2021), σ in seconds, 0…1; few good stops score high.

    Examples
    --------
    >>> beat_align_fact(np.array([1.0]), np.array([0.0, 1.0, 2.0]))
    1.0
    """
    return _alignment(stops, beats, sigma)


def beat_align_bailando(stops: Times, beats: Times, sigma: float = SIGMA) -> float:
    """Beat-align score over the music's beats (Bailando, Siyao et al. 2022), σ in seconds, 0…1; restlessness scores.

    Examples
    --------
    >>> round(beat_align_bailando(np.array([1.0]), np.array([0.0, 1.0, 2.0])), 3)
    0.333
    """
    return _alignment(beats, stops, sigma)


def phase_null(stops: Times, duration: float, rng: np.random.Generator, samples: int = SAMPLES) -> list[Times]:
    """``samples`` copies of the stops, each shifted by one random phase within 0…``duration``, around the end."""
    return [np.sort((stops + shift) % duration) for shift in rng.uniform(0, duration, samples)]


def jitter_null(beats: Times, rng: np.random.Generator, samples: int = SAMPLES) -> list[Times]:
    """``samples`` copies of the beats, each beat moved by up to ±½ of its interval.

    Its interval is the shorter one of those to its neighbours, so that a pause in the music does not widen it.
    """
    if len(beats) < 2:
        return []
    gaps = np.diff(beats)
    interval = np.minimum(np.append(gaps, gaps[-1]), np.append(gaps[0], gaps))
    moved = beats + interval * rng.uniform(-0.5, 0.5, (samples, len(beats)))
    return list(np.sort(moved, axis=1))


def z_score(score: float, null: Array) -> float | None:
    """``(score − mean) / std`` of a null; None where it is empty or does not vary."""
    spread = float(null.std()) if len(null) else 0.0
    return (score - float(null.mean())) / spread if spread > 1e-9 else None


def evaluate(
    stops: Times,
    beats: Times,
    duration: float,
    rng: np.random.Generator,
    strong: Times | None = None,
    samples: int = SAMPLES,
) -> dict[str, float | None]:
    """All scores of this module with their nulls.

    Parameters
    ----------
    stops, beats : (N,), (B,) seconds; those outside 0…``duration`` are left out.
    duration : seconds.
    rng : draws the nulls; the same generator state gives the same result.
    strong : seconds of the strong beats (downbeats), for a recall of their own; None leaves it out.
    samples : how many times each null is drawn.

    Returns
    -------
    ``stops`` and ``beats`` (how many), ``precision50``, ``recall50``, ``f50`` and the same with ``100``,
    ``strong_recall50``…, ``beat_align_fact`` and ``beat_align_bailando``. A score's chance level is beside it as
    ``…_phase_null`` or ``…_jitter_null`` (the null's mean), how far above it stands as ``…_phase_z``, ``…_jitter_z``
    (of F) and ``…_margin`` (of the beat-align scores, above their phase null).

    Raises
    ------
    MetricError
        If times are not one increasing list of finite numbers, or the duration is not positive.
    """
    stops, beats = np.asarray(stops, np.float64), np.asarray(beats, np.float64)
    validate(stops, beats, duration)
    stops, beats = _within(stops, duration), _within(beats, duration)
    result: dict[str, float | None] = {"stops": len(stops), "beats": len(beats)}
    for name, tolerance in TOLERANCES.items():
        scores = precision_recall_f(stops, beats, tolerance)
        result |= {f"{key}{name}": value for key, value in zip(("precision", "recall", "f"), scores, strict=True)}
        if strong is not None:
            result[f"strong_recall{name}"] = _strong_recall(stops, strong, duration, tolerance)
    result |= {"beat_align_fact": beat_align_fact(stops, beats)}
    result |= {"beat_align_bailando": beat_align_bailando(stops, beats)}
    return result | _chance(result, stops, beats, duration, rng, samples)


def _within(times: Times, duration: float) -> Times:
    return times[(times >= 0) & (times <= duration)]


def _strong_recall(stops: Times, strong: Times, duration: float, tolerance: float) -> float | None:
    strong = np.asarray(strong, np.float64)
    _validate_times("strong beats", strong)
    strong = _within(strong, duration)
    return recall(stops, strong, tolerance) if len(strong) else None


def _chance(
    scores: dict[str, float | None],
    stops: Times,
    beats: Times,
    duration: float,
    rng: np.random.Generator,
    samples: int,
) -> dict[str, float | None]:
    """Nulls, z and margins of the scores."""
    shifted = phase_null(stops, duration, rng, samples) if len(stops) else []
    jittered = jitter_null(beats, rng, samples)
    result: dict[str, float | None] = {}
    for name, tolerance in TOLERANCES.items():
        score = scores[f"f{name}"] or 0.0
        for kind, null in (
            ("phase", np.array([f_measure(s, beats, tolerance) for s in shifted])),
            ("jitter", np.array([f_measure(stops, b, tolerance) for b in jittered])),
        ):
            result[f"f{name}_{kind}_null"] = float(null.mean()) if len(null) else None
            result[f"f{name}_{kind}_z"] = z_score(score, null)
    functions: dict[str, Score] = {"beat_align_fact": beat_align_fact, "beat_align_bailando": beat_align_bailando}
    for name, function in functions.items():
        chance = float(np.mean([function(s, beats) for s in shifted])) if shifted else None
        result[f"{name}_null"] = chance
        result[f"{name}_margin"] = None if chance is None else (scores[name] or 0.0) - chance
    return result
