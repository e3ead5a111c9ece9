"""Eight dancers of different size and style."""

from __future__ import annotations

from dataclasses import dataclass

from onbeat.examples.body import Build


@dataclass(frozen=True)
class Dancer:
    """Who dances: a build and a style.

    Parameters
    ----------
    name : the person's name.
    build : sizes.
    amplitude : how large arms and trunk move, 1 for as written.
    stride : how large the steps are, 1 for as written.
    lag : seconds by which the hands come after the beat; negative before it.
    softness : seconds over which moves flow into each other.
    hold : share of each move's time spent at rest in the poses, 0…0.4.
    overshoot : wind-up and overshoot of arms and trunk, 0…1.
    bounce : depth of the bounce, 1 for as written.
    bow : radians by which the trunk is always inclined.
    crouch : share of the leg's length by which the dancer stands low.
    lift : radians by which the arms are always higher or lower.
    sway : how far the weight goes over to the standing foot, 1 for as written.
    ornaments : size of the small fast details between the poses, 1 for as written.
    wrist : how loosely the hands follow the arms, 1 for the average.
    """

    name: str
    build: Build
    amplitude: float = 1.0
    stride: float = 1.0
    lag: float = 0.0
    softness: float = 0.03
    hold: float = 0.12
    overshoot: float = 0.25
    bounce: float = 1.0
    bow: float = 0.0
    crouch: float = 0.0
    lift: float = 0.0
    sway: float = 1.0
    ornaments: float = 1.0
    wrist: float = 1.0


DANCERS = (
    Dancer("Aiko", Build(1.58, legs=0.98, shoulders=0.94, hips=1.05), softness=0.04, ornaments=1.3, wrist=1.3),
    Dancer(
        "Bruno", Build(1.88, legs=1.0, arms=1.02, shoulders=1.08), amplitude=0.9, lag=0.02, softness=0.045, hold=0.05,
        overshoot=0.1, bounce=1.25, bow=0.06, crouch=0.03, lift=-0.08, sway=1.1, ornaments=0.5,
    ),
    Dancer(
        "Carla", Build(1.67, legs=1.03, shoulders=0.96, hips=1.05), amplitude=1.12, stride=1.08, lag=-0.015,
        softness=0.02, hold=0.2, overshoot=0.5, bounce=1.3, bow=-0.03, lift=0.06, wrist=1.1,
    ),
    Dancer(
        "Dawit", Build(1.80, legs=1.04, arms=1.04, shoulders=0.98), amplitude=1.05, softness=0.012, hold=0.34,
        overshoot=0.35, bounce=0.7, bow=-0.04, ornaments=0.7, wrist=0.6,
    ),
    Dancer(
        "Emi", Build(1.50, legs=0.97, arms=0.97, shoulders=0.94, hips=1.02), amplitude=1.15, stride=1.1, lag=-0.01,
        softness=0.025, hold=0.1, overshoot=0.45, bounce=1.35, lift=0.1, ornaments=1.2,
    ),
    Dancer(
        "Farid", Build(1.74, shoulders=1.04), amplitude=0.92, stride=0.95, lag=0.03, softness=0.055, hold=0.0,
        overshoot=0.05, bounce=0.6, bow=0.02, sway=1.15, ornaments=1.0, wrist=1.5,
    ),
    Dancer(
        "Greta", Build(1.71, legs=1.01, shoulders=1.0, hips=1.08), amplitude=0.84, stride=0.9, lag=0.01, softness=0.04,
        hold=0.15, overshoot=0.15, bounce=0.8, bow=0.08, crouch=0.015, lift=-0.05, ornaments=0.8, wrist=0.9,
    ),
    Dancer(
        "Hugo", Build(1.90, legs=1.02, arms=1.0, shoulders=1.03), amplitude=1.06, stride=1.0, lag=0.0, softness=0.03,
        hold=0.24, overshoot=0.4, bounce=1.0, ornaments=1.0, wrist=1.0,
    ),
)  # fmt: skip
"""From soft to sharp, from light to heavy, 1.50 to 1.90 m."""
