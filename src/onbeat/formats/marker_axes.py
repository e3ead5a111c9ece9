"""Which axis of markers points up, and how long their unit is: what the file says, held against what they show.

Recognised labels tell most: the head is over the feet. Without them bodies tell that stand: they are taller than wide,
and the lowest marker keeps close to zero. That also finds files that name the wrong axis (PhoeniX's name Z and stand
along X).
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple, cast

import numpy as np

from onbeat._shapes import Array, Positions
from onbeat.formats.conventions import Convention, Up, z_up_vectors
from onbeat.formats.notes import tell
from onbeat.formats.upright import bounds, clear_axis, has_floor

_TOP = re.compile(r"head|[lr][fb]hd$|^[lr]hd|ariel|^top|^hd")
_BELOW_TOP = re.compile(r"shoulder|[lr]sho|^c7$|clav|strn|neck")
_FEET = re.compile(r"heel|toe|ankle|foot|^[lr]?hee|[lr]ank$|[lr]mt[15]$|calc")
_SAMPLES = 64
_NAMES = {
    "m": ("m", "meter", "meters", "metre", "metres"),
    "cm": ("cm", "centimeter", "centimeters", "centimetre", "centimetres"),
    "mm": ("mm", "millimeter", "millimeters", "millimetre", "millimetres"),
    "in": ("in", "inch", "inches"),
    "dm": ("dm", "decimeter", "decimeters", "decimetre", "decimetres"),
    "ft": ("ft", "foot", "feet"),
}


class Stored(NamedTuple):
    """What a file says of its lengths: the name of its unit, the axis that is up as ``+z``, and what is usual."""

    unit: str
    up: str
    usual: Up


def z_up_positions(
    names: Sequence[str], raw: Array, stored: Stored, up: Up | None = None, unit: str | None = None
) -> Positions:
    """Markers as a file tells them, in metres with Z up; what was guessed or contradicted is told.

    Parameters
    ----------
    names : M labels.
    raw : (F, M, 3) in the file's unit and axes, NaN where a marker is not seen.
    stored : what the file says.
    up, unit : what the user says, which goes before all.

    Returns
    -------
    (F, M, 3) read-only.

    Examples
    --------
    >>> z_up_positions(("LFHD", "LTOE"), np.array([[[0, 1700.0, 5], [0, 20, 100]]]), Stored("mm", "", "y")).round(3)
    array([[[ 0.   , -0.005,  1.7  ],
            [ 0.   , -0.1  ,  0.02 ]]])
    """
    some = _some(raw)
    upright = _head_over_feet(names, some)
    axis = up or _up(some, upright, stored)
    metres = Convention("z", unit or _unit(some, upright, stored)).metres
    positions = z_up_vectors(raw, axis) * metres
    positions.setflags(write=False)
    return positions


def _some(raw: Array) -> Array:
    """A few frames spread over the whole, in which anything is seen."""
    there = np.flatnonzero(np.isfinite(raw[..., 0]).any(1))
    return raw[there[:: max(1, len(there) // _SAMPLES)]]


def _head_over_feet(names: Sequence[str], some: Positions) -> Array | None:
    """(3,) from the feet to the head, in the file's axes; None where labels or gaps hide it."""
    plain = [name.lower().replace(".", "").replace("_", "") for name in names]
    feet = _middle(some, [i for i, name in enumerate(plain) if _FEET.search(name)])
    for pattern in (_TOP, _BELOW_TOP):
        rise = _middle(some, [i for i, name in enumerate(plain) if pattern.search(name)]) - feet
        rise = rise[np.isfinite(rise).all(1)]
        if len(rise):
            return np.median(rise, axis=0)
    return None


def _middle(some: Positions, chosen: list[int]) -> Array:
    """(F, 3) the mean of the chosen markers that are seen; NaN where none is."""
    points = some[:, chosen]
    seen = np.isfinite(points)
    count = seen.sum(1)
    return np.where(count > 0, np.where(seen, points, 0.0).sum(1) / np.maximum(count, 1), np.nan)


def _up(some: Positions, upright: Array | None, stored: Stored) -> Up:
    """The axis that is up, told with the reason."""
    shown, reason = (clear_axis(upright) if upright is not None else ""), "the head is over the feet along it"
    if not shown:
        shown, reason = _standing_axis(some), "bodies stand along it, on a floor at its zero"
    if shown and shown == stored.up:
        taken, why = shown, f"the file says so, and {reason}"
    elif shown and _prevails(some, shown, stored.up):
        taken, why = shown, f"{reason}{f', though the file says {stored.up}' if stored.up else ''}"
    elif stored.up:
        taken, why = stored.up, f"the file says so{f', though it may be {shown}: {reason}' if shown else ''}"
    else:
        taken, why = f"+{stored.usual}", "it is usual; neither the file nor what it shows tells"
    axis = cast("Up", taken.removeprefix("+"))
    tell("up", axis, why)
    return axis


def _prevails(some: Positions, shown: str, said: str) -> bool:
    """Whether what is seen counts more than what the file says: somebody may lie, on a floor along the axis said.

    Where the file says nothing, X up is believed only with a floor: in many files somebody lies, in hardly any X is up.
    """
    if said:
        return has_floor(some, shown) and not has_floor(some, said)
    return shown[1] != "x" or has_floor(some, shown)


def _standing_axis(some: Positions) -> str:
    """The axis along which bodies are half as long again as along the others, over a floor; nothing where none is."""
    if len(some) < 8:
        return ""
    low, high = bounds(some)
    size = np.median(high - low, axis=0)
    column = int(np.argmax(size))
    axis = "+" + "xyz"[column]
    return axis if size[column] > 1.5 * np.delete(size, column).max() and has_floor(some, axis) else ""


def _unit(some: Positions, upright: Array | None, stored: Stored) -> str:
    """The unit the file names; where it names none, the one in which a body has its size, else millimetres."""
    words = stored.unit.lower().strip()
    for unit, names in _NAMES.items():
        if words in names:
            return unit
    named = f"its unit {stored.unit[:20]!r} is not known" if words else "the file names no unit"
    tall = float(np.abs(upright).max()) if upright is not None else 0.0
    if tall > 0:
        taken = "m" if tall < 3 else "cm" if tall < 300 else "mm"
        tell("unit", taken, f"{named}, and the head is {tall:.4g} over the feet")
        return taken
    tell("unit", "mm", f"{named}; mm is usual")
    return "mm"
