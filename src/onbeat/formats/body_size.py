"""The unit of a file that stores none, by the size of the body in it."""

from __future__ import annotations

import warnings

import numpy as np

from onbeat.errors import BodyError
from onbeat.formats.conventions import UNITS
from onbeat.formats.notes import tell
from onbeat.motion import Body, Skeleton

LEGS = 0.48
"""Hip to ankle, of a person's height: .46 to .50 in captured bodies."""
PERSONS = (1.0, 2.3)
"""Metres of height, by the legs, that need no word: children of school age, humanoid robots, giants."""
_USUAL = (1.3, 2.1)
"""Metres of height that a unit must give to be named instead."""


class UnitWarning(UserWarning):
    """A file stores no unit, and in the one that was guessed its body is no person's size."""


def tree_span(skeleton: Skeleton) -> float:
    """The longest way along the bones from one joint to another, in the skeleton's unit.

    It needs no rest pose that looks like a body. From head to toe or hand to foot it is 1.1 to 1.3 body heights.
    """
    deepest, span = np.zeros(len(skeleton)), 0.0
    for joint in range(len(skeleton) - 1, 0, -1):
        parent, reach = skeleton.parents[joint], deepest[joint] + skeleton.bone_lengths[joint]
        span = max(span, float(deepest[parent] + reach))
        deepest[parent] = max(deepest[parent], reach)
    return span


def guessed_unit(skeleton: Skeleton, label: str = "") -> str:
    """The unit in which a skeleton is the size of a body; BVH stores none.

    By :func:`tree_span`: up to 15 metres (giants are drawn, dwarfs of centimetres are not); to 60 the CMU scale (a body
    of 30 units); to 400 centimetres; beyond millimetres. Skeletons without length are taken as centimetres. Of a body
    that is no person's size in it a :class:`UnitWarning` says so, and which unit would make it one.

    Parameters
    ----------
    skeleton : in the file's unit.
    label : the file, for the warning.
    """
    span = tree_span(skeleton)
    unit = "m" if 0 < span < 15 else "cmu" if 15 <= span < 60 else "cm" if span < 400 else "mm"
    tell("unit", unit, f"the longest way along the bones is {span:g} units, so {span * UNITS[unit]:.2f} m")
    if said := odd_person(skeleton, unit):
        warnings.warn(f"{label}: {said}" if label else said, UnitWarning, stacklevel=2)
    return unit


def odd_person(skeleton: Skeleton, unit: str) -> str:
    """Words on a body that is no person's size in a unit, with the units in which it is one; none ("") of others.

    By its legs: who lies or crouches is as tall as who stands.

    Examples
    --------
    >>> names = ["hips", "chest", *(s + n for s in "lr" for n in
    ...          ("humerus", "radius", "wrist", "femur", "tibia", "foot"))]
    >>> parents = [-1, 0, 1, 2, 3, 0, 5, 6, 1, 8, 9, 0, 11, 12]
    >>> person = Skeleton(names, parents, np.tile([0, 0, 4.0], (14, 1)))
    >>> odd_person(person, "cmu").split(";")[0]
    'a body 0.94 m tall is found (its legs are 8 units long, taken as cmu)'
    >>> odd_person(person, "dm")
    ''
    """
    try:
        legs = Body.of(skeleton).leg_length
    except BodyError:
        return ""
    height = legs / LEGS * UNITS[unit]
    if PERSONS[0] <= height <= PERSONS[1]:
        return ""
    others = {other: legs / LEGS * metres for other, metres in UNITS.items()}
    usual = {other: tall for other, tall in others.items() if _USUAL[0] <= tall <= _USUAL[1]}
    named = ", ".join(f"{other} makes it {tall:.2f} m" for other, tall in usual.items())
    who = "a small child or a robot" if height < 1 else "a giant"
    hint = f"is it {who}? (`--source-unit` takes {', '.join(UNITS)})"
    if usual:
        first = next(iter(usual))
        hint = f"if that is wrong, {named} (`onbeat convert FILE NEW.npz --source-unit {first}`)"
    return f"a body {height:.2f} m tall is found (its legs are {legs:.3g} units long, taken as {unit}); {hint}"
