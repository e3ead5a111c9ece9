"""What the joints of a body can do: how far they turn, how fast, and how quickly they change that."""

from __future__ import annotations

import difflib
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from onbeat._shapes import Array, Bools, frozen
from onbeat.errors import LimitError

LISTED = 12
"""Names that a message lists at most."""
_LONGEST, _COMPARED = 60, 1000


def _unknown() -> Array:
    return np.array(math.inf)


@dataclass(frozen=True, eq=False)
class Limits:
    """The limits of n joints. What is not limited, or not known, is infinite.

    Parameters
    ----------
    name : of the body, as messages call it.
    joints : (n,) their names, each once.
    low, high : (n,) limits of the angle in radians (metres of a joint that slides); −inf, inf where it turns freely.
    speed : (n,) of the angular velocity in either direction, in rad/s.
    acceleration, jerk : (n,) in rad/s² and rad/s³; infinite without them, for hardly any model of a robot tells them.
    source : where the figures are from.

    One number instead of an array is every joint's.

    Raises
    ------
    LimitError
        If a joint's low is not under its high, a limit is not a number or not above zero, a name is there twice or
        shapes disagree; the joint is named.

    Examples
    --------
    >>> arm = Limits("arm", ("shoulder", "elbow"), [-2, 0], [2, 2.5], [3, 4])
    >>> arm.of(["elbow"]).high.tolist(), arm.scaled(0.5).speed.tolist()
    ([2.5], [1.5, 2.0])
    >>> arm.with_acceleration(0.1).acceleration.tolist()
    [30.0, 40.0]
    """

    name: str
    joints: tuple[str, ...]
    low: Array
    high: Array
    speed: Array
    acceleration: Array = field(default_factory=_unknown)
    jerk: Array = field(default_factory=_unknown)
    source: str = ""

    def __post_init__(self) -> None:
        set_ = object.__setattr__
        set_(self, "joints", tuple(self.joints))
        twice = [joint for joint, count in Counter(self.joints).items() if count > 1]
        if twice:
            raise LimitError(f"{self.name}: the joint {shown(twice[0])} is there more than once; name each joint once")
        for key in ("low", "high", "speed", "acceleration", "jerk"):
            set_(self, key, self._each(key))
        for key in ("speed", "acceleration", "jerk"):
            values: Array = getattr(self, key)
            self._refuse(~(values > 0), f"a limit of its {key}", key, "a number above 0 is expected, or inf for none")
        self._refuse(~(self.low < self.high), "a range of its angle", "low", "the low limit has to be under the high")
        self._refuse(np.isposinf(self.low) | np.isneginf(self.high), "a range of its angle", "low", "it holds nothing")

    def _each(self, key: str) -> Array:
        """A limit of every joint."""
        given = np.asarray(getattr(self, key), np.float64)
        n = len(self.joints)
        if given.shape not in ((), (n,)):
            raise LimitError(f"{self.name}: {key} has the shape {given.shape}; one number each of {n} joints is needed")
        return frozen(np.broadcast_to(given, (n,)))

    def _refuse(self, wrong: Bools, what: str, key: str, expected: str) -> None:
        if wrong.any():
            n = int(np.argmax(wrong))
            value = f"{getattr(self, key)[n]:g}" + (f" … {self.high[n]:g}" if key == "low" else "")
            raise LimitError(f"{self.name}: {shown(self.joints[n])} has {what} of {value}; {expected}")

    def __len__(self) -> int:
        return len(self.joints)

    def of(self, joints: Sequence[str]) -> Limits:
        """The limits of some joints, in their order.

        Raises
        ------
        LimitError
            If a joint has none here; names that come near are told.
        """
        place = {joint: n for n, joint in enumerate(self.joints)}
        missing = [joint for joint in joints if joint not in place]
        if missing:
            raise LimitError(self._missing(missing))
        return self._picked([place[joint] for joint in joints])

    def _picked(self, at: list[int]) -> Limits:
        return replace(
            self,
            joints=tuple(self.joints[n] for n in at),
            low=self.low[at],
            high=self.high[at],
            speed=self.speed[at],
            acceleration=self.acceleration[at],
            jerk=self.jerk[at],
        )

    def _missing(self, missing: Sequence[str]) -> str:
        near = [f"{shown(name)} {near_names(name, self.joints)}".rstrip() for name in missing[:3]]
        more = f" and {len(missing) - 3} more" if len(missing) > 3 else ""
        return f"{self.name} has no limits for {', '.join(near)}{more}; it has {listed(self.joints)}"

    def scaled(self, share: float) -> Limits:
        """The same with a share of the speed, acceleration and jerk: 0.9 leaves a margin of a tenth.

        Raises
        ------
        LimitError
            If the share is not a number above 0.
        """
        _check_positive(share, "share of the limits", "0.9 leaves a margin of a tenth")
        return replace(self, speed=self.speed * share, acceleration=self.acceleration * share, jerk=self.jerk * share)

    def with_acceleration(self, seconds: float) -> Limits:
        """The same where no acceleration is known: as much as reaches full speed from rest in so many seconds.

        Raises
        ------
        LimitError
            If the seconds are not a number above 0.
        """
        _check_positive(seconds, "time to full speed", "0.1 s is usual for a robot's arm")
        return replace(
            self, acceleration=np.where(np.isinf(self.acceleration), self.speed / seconds, self.acceleration)
        )


def _check_positive(value: float, what: str, example: str) -> None:
    if not (math.isfinite(value) and value > 0):
        raise LimitError(f"{value} found as the {what}; a number above 0 is expected: {example}")


def shown(name: str) -> str:
    """A name as messages show it: the beginning of a very long one."""
    return name if len(name) <= _LONGEST else f"{name[:_LONGEST]}…"


def listed(names: Sequence[str], most: int = LISTED) -> str:
    """Some names and how many more there are; "nothing" of none."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return (", ".join(shown(name) for name in names[:most]) or "nothing") + more


def near_names(name: str, known: Sequence[str]) -> str:
    """Names that come near, as a message asks: "(is it left_knee?)"; empty where none does."""
    plain = {one.lower(): one for one in known[:_COMPARED]}
    close = difflib.get_close_matches(name.lower()[:_LONGEST], [one for one in plain if len(one) <= _LONGEST], 2, 0.6)
    return f"(is it {' or '.join(plain[one] for one in close)}?)" if close else ""
