"""What goes wrong on a stage: a robot that is heavier than it thinks, a slippery floor, a push."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from onbeat.errors import BodyError
from onbeat.robots.model import Robot


@dataclass(frozen=True)
class Push:
    """A force on the trunk.

    Parameters
    ----------
    at : seconds, when it begins.
    force : N along the world's x, y and z.
    seconds : how long it lasts.
    """

    at: float
    force: tuple[float, float, float]
    seconds: float = 0.1

    def __post_init__(self) -> None:
        values = np.array([self.at, *self.force, self.seconds])
        if not (np.abs(values) < 1e6).all() or self.seconds <= 0:
            raise BodyError(
                f"a push of {self.force} N at {self.at:g} s for {self.seconds:g} s cannot be: finite numbers and a "
                "time above zero are expected"
            )


def pushes(count: int, newtons: float, until: float, rng: np.random.Generator, seconds: float = 0.1) -> list[Push]:
    """Level pushes of one strength in random directions, evenly spread over a dance of ``until`` seconds.

    Examples
    --------
    >>> [push.at for push in pushes(2, 50.0, 10.0, np.random.default_rng(0))]
    [2.5, 7.5]
    """
    angles = rng.uniform(0, 2 * np.pi, count)
    spots = (np.arange(count) + 0.5) / max(count, 1) * until
    forces = np.stack((newtons * np.cos(angles), newtons * np.sin(angles), np.zeros(count)), axis=1)
    return [
        Push(float(at), (float(x), float(y), float(z)), seconds) for at, (x, y, z) in zip(spots, forces, strict=True)
    ]


def loaded(model: Any, scale: float, spread: float, rng: np.random.Generator) -> None:
    """Make a model's bodies heavier: all by ``scale``, each by a random part of up to ± ``spread`` more.

    Raises
    ------
    BodyError
        If nothing, or less, would be left of a body.
    """
    if not (np.isfinite(scale) and 0 < scale <= 10 and 0 <= spread < 1):
        raise BodyError(
            f"masses times {scale:g} ± {spread:g} cannot be: a scale above 0 and up to 10, "
            "and a spread from 0 to below 1 are expected"
        )
    times = scale * (1 + rng.uniform(-spread, spread, model.nbody))
    model.body_mass[:] *= times
    model.body_inertia[:] *= times[:, None]


def slippery(model: Any, friction: float) -> None:
    """Give everything that touches a sliding friction.

    Raises
    ------
    BodyError
        If it is not above zero.
    """
    if not (np.isfinite(friction) and 0 < friction <= 10):
        raise BodyError(f"a friction of {friction:g} cannot be; a number above 0 and up to 10 is expected")
    model.geom_friction[:, 0] = friction


def trunk_of(robot: Robot) -> int:
    """The body that is pushed: the heaviest above the legs."""
    model = robot.model
    legs = {0}
    for foot in robot.feet.values():
        link = int(model.body(foot.link).id)
        while link > 1:
            legs.add(link)
            link = int(model.body_parentid[link])
    masses = np.array(model.body_mass)
    masses[sorted(legs)] = 0
    return int(np.argmax(masses))


def push(data: Any, body: int, given: Sequence[Push], now: float) -> None:
    """Apply to a body the pushes that are on at a time in seconds."""
    data.xfrc_applied[body, :3] = 0
    for each in given:
        if each.at <= now < each.at + each.seconds:
            data.xfrc_applied[body, :3] += each.force
