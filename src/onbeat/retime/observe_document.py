"""``observe.json``: what repetitions of a dance at several speeds have in common."""

from __future__ import annotations

from typing import Annotated

import msgspec
import numpy as np

from onbeat._shapes import Array
from onbeat.retime.attenuation import Attenuation
from onbeat.retime.hierarchy import SPACING
from onbeat.retime.likeness import likeness
from onbeat.retime.observe import Curves, Observation

VERSION = 1

Said = msgspec.Meta


class LayerDocument(msgspec.Struct, frozen=True):
    """One layer: what is left of it in faster music."""

    spacing: Annotated[float, Said(description="beats between its knots")]
    slope: Annotated[
        list[float],
        Said(
            description="change of its ratio by speed: at -1, speed 1.2 has a fifth less; 0 if the dance were merely "
            "played faster. Then the ends of its 95 % interval, where every speed has two repetitions or more. Empty "
            "with one speed alone"
        ),
    ]
    shared_slope: Annotated[list[float], Said(description="the same of what repetitions share, likewise")]


class CurvesDocument(msgspec.Struct, frozen=True):
    """The repetitions of one speed, or all of them."""

    speed: Annotated[float, Said(description="1 for the original; 0 for all speeds together")]
    repetitions: Annotated[int, Said(description="how many")]
    rms: Annotated[list[float], Said(description="of each layer, radians; empty for all speeds together")]
    shared: Annotated[
        list[float], Said(description="of what repetitions have in common, likewise; empty with one alone")
    ]
    noise: Annotated[list[float], Said(description="of what they have not, likewise")]
    ratio: Annotated[list[float], Said(description="`rms` by that of the speed nearest to 1")]
    shared_ratio: Annotated[list[float], Said(description="`shared`, likewise")]
    variance: Annotated[
        list[float],
        Said(description="Eq. 9 at each of `beats`, the geometric mean over joints; empty with one repetition"),
    ]
    drawn_variance: Annotated[list[float], Said(description="of the joint `drawn`, likewise")]
    drawn_mean: Annotated[
        list[list[list[float]]],
        Said(description="of the joint `drawn`, with 1, 2, … layers, at each of `beats`: the quaternion's logarithm"),
    ]
    valleys: Annotated[list[float], Said(description="beats at which `variance` has a valley")]


class ScoreDocument(msgspec.Struct, frozen=True):
    """The valleys held against known keyposes."""

    keyposes: Annotated[list[float], Said(description="their beats")]
    tolerance: Annotated[float, Said(description="beats by which a valley may be off")]
    precision: Annotated[float, Said(description="share of the valleys that are keyposes")]
    recall: Annotated[float, Said(description="share of the keyposes that are valleys")]
    f: Annotated[float, Said(description="their harmonic mean")]
    chance: Annotated[float, Said(description="F of the same valleys at a random phase, the mean")]
    chance_deviation: Annotated[float, Said(description="and its standard deviation")]
    beat_chance: Annotated[float, Said(description="F of the same valleys shifted by whole beats, the mean")]
    contrast: Annotated[
        list[float],
        Said(description="variance at keyposes by that at other times, in the order of `curves`; 0: none"),
    ]


class ObserveDocument(msgspec.Struct, frozen=True):
    """``observe.json``: means and variances of a dance's repetitions on musical time, layer by layer."""

    version: Annotated[int, Said(description="of this document")]
    joints: Annotated[list[str], Said(description="that were looked at")]
    drawn: Annotated[str, Said(description="the joint whose own curves are here")]
    cycle: Annotated[int, Said(description="beats of a cycle; 0 where takes are whole")]
    beats: Annotated[list[float], Said(description="at which curves are told, from the first beat that all takes have")]
    layers: Annotated[list[LayerDocument], Said(description="the coarsest first")]
    curves: Annotated[list[CurvesDocument], Said(description="of each speed, slowest first, and of all together")]
    resampled: Annotated[str, Said(description="what intervals draw again: `takes` or `cycles`")]
    valleys: Annotated[list[float], Said(description="beats of the valleys that all curves have in common")]
    scores: Annotated[list[ScoreDocument], Said(description="one where keyposes are known")] = []
    likeness: Annotated[
        list[float],
        Said(
            description="of each repetition: the correlation of its joints' rotations with those of the others, the "
            "mean. Of one dance it is 0.6 and more, of different dances 0.4 at most. Empty where one does not move"
        ),
    ] = []
    likeness_shifted: Annotated[
        list[float],
        Said(description="the mean correlation with one of both shifted by whole beats, and the standard deviation"),
    ] = []

    def to_json(self) -> bytes:
        """The document as JSON bytes."""
        return msgspec.json.format(msgspec.json.encode(self), indent=1) + b"\n"


def observe_document(
    found: Observation,
    energies: Attenuation,
    valleys: list[Array],
    common: Array,
    drawn: str,
    scores: list[ScoreDocument],
) -> ObserveDocument:
    """What was observed, as a document.

    Parameters
    ----------
    found, energies : of the same repetitions.
    valleys : of each speed and of all, in the order of ``found.speeds``, beats.
    common : the valleys that all have in common, beats.
    drawn : the joint whose own curves are told.
    scores : one where keyposes are known.
    """
    every = found.repetitions
    alike = likeness(every)
    joint = every.joints.index(drawn)
    curves = (*found.speeds, found.all)
    return ObserveDocument(
        version=VERSION,
        joints=list(every.joints),
        drawn=drawn,
        cycle=round(every.period),
        beats=_rounded(every.beats),
        layers=[_layer(energies, k) for k in range(energies.rms.shape[1])],
        curves=[_curves(c, energies, k, joint, valleys[k]) for k, c in enumerate(curves)],
        resampled=energies.drawn,
        valleys=_rounded(common),
        scores=scores,
        likeness=_rounded(alike.each),
        likeness_shifted=_rounded(np.array([alike.shifted, alike.deviation])),
    )


def _layer(energies: Attenuation, layer: int) -> LayerDocument:
    return LayerDocument(SPACING / 2**layer, *(_slope(slopes[layer]) for slopes in energies.slopes))


def _slope(values: Array) -> list[float]:
    """A slope and the ends of its interval; alone where there is none."""
    return _rounded(values[np.isfinite(values)])


def _curves(curves: Curves, energies: Attenuation, place: int, joint: int, valleys: Array) -> CurvesDocument:
    of = (energies.rms, energies.shared, energies.noise, *energies.ratios)
    told = [_rounded(values[place]) if curves.speed else [] for values in of]
    return CurvesDocument(
        curves.speed,
        curves.count,
        *told,
        variance=_rounded(curves.pooled, 9),
        drawn_variance=_rounded(curves.variance[-1, :, joint], 9),
        drawn_mean=np.round(curves.mean[:, :, joint], 5).tolist(),
        valleys=_rounded(valleys),
    )


def _rounded(values: Array, digits: int = 6) -> list[float]:
    """Numbers for a document; none where one of them is none."""
    return np.round(values, digits).tolist() if np.isfinite(values).all() else []
