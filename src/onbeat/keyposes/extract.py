"""Keyposes of a dance: the poses in which it rests on the beat, by methods chosen by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from onbeat._shapes import Array, Ints, Times, frozen
from onbeat.errors import BodyError, PlanError
from onbeat.keyposes.candidates import LEAST_RISE, WINDOW, Minima, Thresholds, candidates, minima
from onbeat.keyposes.effectors import hand_stops, shiratori2004
from onbeat.keyposes.energy import RATE, Energy, energy_of
from onbeat.keyposes.points import Points, body_points
from onbeat.keyposes.rests import nearest_to_beat
from onbeat.motion.markers import Markers
from onbeat.motion.motion import Motion

DEFAULT = Thresholds(0.6, 1.0)
"""T1 and T2 in units of the mean energy."""
SMOOTHING_SHARE = 0.12
"""Of a beat, the standard deviation of the smoothing: in fast music rests are short, in slow music tremor is long."""
ORDERS = ("global-local", "local-global", "global", "local")
"""Which energy's candidate is taken first at a beat, and whether the other's is taken where there is none."""


@dataclass(frozen=True)
class Options:
    """How the method ``energy`` looks for keyposes.

    Parameters
    ----------
    kind : the energy, one of ``energy.KINDS``.
    order : one of ``ORDERS``.
    weights : one of ``points.WEIGHTS``.
    thresholds : T1 and T2 in units of the mean energy.
    window : share of a beat within which a minimum belongs to a beat.
    either : whether a rise of T2 on one side of a minimum is enough.
    least : of the mean energy; bumps lower than this part no rests.
    held : of the mean energy, by how much a body at rest may be over the minimum: of a pose that is held the moment
        nearest to its beat is taken; 0 takes the minimum itself.
    """

    kind: str = "rms"
    order: str = "global-local"
    weights: str = "uniform"
    thresholds: Thresholds = DEFAULT
    window: float = WINDOW
    either: bool = False
    least: float = LEAST_RISE
    held: float = 0.02


PAPER = Options(kind="paper", window=0.25, either=True, least=0.0, held=0.0)
"""As printed in 2009, as far as it is printed: smoothing and units of the thresholds are ours."""
PERIODS = (0.2, 1.5)
"""Seconds between beats beyond which the smoothing does not follow them."""
CLOSEST = 0.25
"""Of a beat: of two keyposes closer than this, the one farther from its beat is the same rest again."""


@dataclass(frozen=True)
class Keyposes:
    """The keyposes of a motion.

    Parameters
    ----------
    times : (K,) seconds, increasing.
    beats : (K,) index of each one's beat.
    sources : which energy's candidate each is: "global" or "local"; "hands" or "effectors" by other methods.
    song_beats : (B,) seconds of the beats on the motion's clock.
    candidates : (B,) seconds by energy, NaN where a beat has none.
    energy : of the motion.
    thresholds : that were used.
    method : that found them.
    fps : frames per second of the motion.
    """

    times: Times
    beats: Ints
    sources: tuple[str, ...]
    song_beats: Times
    candidates: Mapping[str, Times]
    energy: Energy
    thresholds: Thresholds
    method: str
    fps: float

    def __post_init__(self) -> None:
        for name, kind in (("times", np.float64), ("beats", np.int64), ("song_beats", np.float64)):
            object.__setattr__(self, name, frozen(getattr(self, name), kind))

    def __len__(self) -> int:
        return len(self.times)

    @property
    def frames(self) -> Ints:
        """(K,) the nearest frame to each keypose."""
        return np.round(self.times * self.fps).astype(np.int64)


class Reading:
    """A motion made ready, so that thresholds can be tried without reading it again."""

    def __init__(self, source: Motion | Markers, beats: Times, options: Options = Options()) -> None:
        if options.order not in ORDERS:
            raise BodyError(f"no order {options.order!r}; there are {', '.join(ORDERS)}")
        self.source, self.options = source, options
        self.beats = beats_inside(beats, source)
        self.points = body_points(source, options.weights, "local" in options.order)
        period = float(np.clip(np.median(np.diff(self.beats)), *PERIODS))
        self.energy = in_units(energy_of(self.points, options.kind, SMOOTHING_SHARE * period), self.beats)
        self.minima: dict[str, Minima] = {"global": minima(self.energy.world, least=options.least)}
        if self.points.centred:
            self.minima["local"] = minima(self.energy.local, least=options.least)

    def keyposes(self, thresholds: Thresholds | None = None, method: str = "energy") -> Keyposes:
        """The keyposes by some thresholds, those of the options if none are given."""
        chosen = self.options.thresholds if thresholds is None else thresholds
        window, either = self.options.window, self.options.either
        curves = {"global": self.energy.world, "local": self.energy.local}
        found = {
            name: nearest_to_beat(
                candidates(rests, self.beats, chosen, window, either), self.beats, curves[name], self.options.held
            )
            for name, rests in self.minima.items()
        }
        times, sources = np.full(len(self.beats), np.nan), np.full(len(self.beats), "", object)
        for name in self.options.order.split("-"):
            free = np.isnan(times) & ~np.isnan(found[name])
            times[free], sources[free] = found[name][free], name
        return self.taken(times, sources, found, chosen, method)

    def taken(
        self, times: Times, sources: np.ndarray, found: Mapping[str, Times], thresholds: Thresholds, method: str
    ) -> Keyposes:
        """Keyposes from a time for each beat (B,), NaN where it has none; what is found twice is kept once."""
        at = once(times, self.beats)
        return Keyposes(
            times[at],
            at,
            tuple(str(one) for one in sources[at]),
            self.beats,
            found,
            self.energy,
            thresholds,
            method,
            self.source.fps,
        )


def once(times: Times, beats: Times) -> Ints:
    """The beats (K,) whose times (B,) are there, without those that only see the rest of a neighbour again.

    Examples
    --------
    >>> once(np.array([0.1, np.nan, 1.48, 1.52]), np.array([0.0, 0.5, 1.0, 1.5])).tolist()
    [0, 3]
    """
    at = np.flatnonzero(~np.isnan(times))
    closest = CLOSEST * float(np.median(np.diff(beats)))
    kept: list[int] = []
    for beat in at.tolist():
        if not kept or times[beat] - times[kept[-1]] >= closest:
            kept.append(beat)
        elif abs(times[beat] - beats[beat]) < abs(times[kept[-1]] - beats[kept[-1]]):
            kept[-1] = beat
    return np.array(kept, np.int64)


def beats_inside(beats: Times, source: Motion | Markers) -> Times:
    """The beats that fall into a motion.

    Raises
    ------
    PlanError
        If they are not increasing numbers, or fewer than two are inside.
    """
    beats = np.asarray(beats, np.float64)
    if beats.ndim != 1 or not np.isfinite(beats).all() or (np.diff(beats) <= 0).any():
        raise PlanError("the beats are not a list of increasing seconds; check the file or the song they come from")
    last = (len(source) - 1) / source.fps
    inside = beats[(beats >= 0.0) & (beats <= last)]
    if len(inside) < 2:
        span = f"the beats go from {beats[0]:.2f} to {beats[-1]:.2f} s" if len(beats) else "there are no beats"
        raise PlanError(
            f"{source.name or 'the motion'} lasts {last:.2f} s and {len(inside)} of {len(beats)} beats fall into it "
            f"({span}); two are needed: say when the song begins in the motion (--song-at), or take a longer motion"
        )
    return inside


def in_units(energy: Energy, beats: Times) -> Energy:
    """Energy in units of its mean where the beats are, so that standing about before and after does not count."""
    period = float(np.median(np.diff(beats)))
    first, last = (round(at * RATE) for at in (beats[0] - period, beats[-1] + period))
    part = slice(max(first, 0), last + 1)
    curves: list[Array] = []
    for curve in (energy.world, energy.local):
        mean = float(curve[part].mean()) if len(curve) else 0.0
        curves.append(curve / mean if mean > 1e-9 else curve)
    return replace(energy, world=curves[0], local=curves[1])


def _paper(source: Motion | Markers, beats: Times, options: Options) -> Keyposes:
    literal = replace(PAPER, weights=options.weights, thresholds=options.thresholds)
    return Reading(source, beats, literal).keyposes(method="paper2009")


def _energy(source: Motion | Markers, beats: Times, options: Options) -> Keyposes:
    return Reading(source, beats, options).keyposes()


def _by_ends(
    name: str, source_name: str, find: Callable[[Points, Times, float], Times]
) -> Callable[[Motion | Markers, Times, Options], Keyposes]:
    def method(source: Motion | Markers, beats: Times, options: Options) -> Keyposes:
        reading = Reading(source, beats, options)
        times = find(reading.points, reading.beats, options.window)
        sources = np.full(len(times), source_name, object)
        return reading.taken(times, sources, {source_name: times}, options.thresholds, name)

    return method


METHODS: Mapping[str, Callable[[Motion | Markers, Times, Options], Keyposes]] = {
    "energy": _energy,
    "paper2009": _paper,
    "shiratori2004": _by_ends("shiratori2004", "effectors", shiratori2004),
    "hands": _by_ends("hands", "hands", hand_stops),
}
"""Methods by name, the default first."""


def find_keyposes(
    source: Motion | Markers,
    beats: Times | None = None,
    method: str = "energy",
    options: Options = Options(),
) -> Keyposes:
    """The keyposes of a motion that is danced to beats.

    Parameters
    ----------
    source : a motion or markers.
    beats : (B,) seconds on the motion's clock, as a song's are; without them those of the motion's own pulse.
    method : a name of ``METHODS``.
    options : of the methods by energy.

    Raises
    ------
    PlanError
        If ``method`` is unknown, the beats do not cover the motion, or it keeps no pulse and none are given.
    BodyError
        If the body's centre cannot be found.

    Examples
    --------
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.folk_dance import FOLK_DANCE
    >>> from onbeat.examples.performer import perform
    >>> clip = perform(DANCERS[0], [FOLK_DANCE], 1.0, 1, np.random.default_rng(0))
    >>> found = find_keyposes(clip.motion, clip.beats)
    >>> len(clip.keyposes), len(found)  # the pose in which the dance ends is found, too
    (8, 9)
    >>> len(find_keyposes(clip.motion))  # by its own pulse, which no music tells
    9
    """
    if method not in METHODS:
        raise PlanError(f"no method {method!r} finds keyposes; there are {', '.join(METHODS)}")
    return METHODS[method](source, _own_beats(source) if beats is None else beats, options)


def _own_beats(source: Motion | Markers) -> Times:
    from onbeat.keyposes.motion_tempo import motion_beats  # what is compiled in it is not needed where beats are told

    return motion_beats(source)
