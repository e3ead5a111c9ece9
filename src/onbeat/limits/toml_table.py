"""Limits as TOML, which people write; the built-in robots' tables are in the same format.

::

    name = "my arm"                        # what messages call it; without it the file's name
    source = "data sheet, 2025"            # where the figures are from
    angles = "degrees"                     # those of the whole file; radians without it
    model = "arm.urdf"                     # a URDF or MJCF beside this file, which tells the rest
    [default]                              # of all joints of which nothing else is told
    acceleration = 1000
    [joints]
    shoulder = { position = [-90, 120], speed = 180 }
    elbow = { position = [0, 150], speed = inf, acceleration = 2000, jerk = 50000 }

A joint has what its own line tells, else what the model tells, else what ``[default]`` tells. Without a ``position`` it
turns freely. A speed has to be told, ``inf`` where there is no limit; accelerations and jerks are infinite where none
is told. Joints of the model that are not written here are as the model has them.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable, Mapping
from typing import Any, cast

from onbeat.errors import LimitError
from onbeat.limits.joint_limit import Model, Told, limits_of, without_speed
from onbeat.limits.limits import Limits, listed, near_names, shown

VERSION = 1
_TOP = ("version", "name", "source", "licence", "angles", "model", "soft", "default", "joints")
_RATES = ("speed", "acceleration", "jerk")
_UNITS = {"radians": 1.0, "degrees": math.pi / 180}

ModelReader = Callable[[str, bool], Model]
"""Reads the model of a name; the second tells whether its soft limits count."""


def no_model(name: str, soft: bool) -> Model:
    """Refuse a model: of a text that is in no file nothing is beside."""
    raise LimitError(f"model = {name!r} is told, but a table that is in no file has no model beside it")


def limits_from_toml(text: str, label: str, name: str, model: ModelReader = no_model) -> Limits:
    r"""The limits that a TOML text tells.

    Parameters
    ----------
    text : the document.
    label : what messages call it.
    name : of the body, where the text tells none.
    model : reads the description that the text names.

    Raises
    ------
    LimitError
        If it is no TOML, or a key or a value is not expected; the key is named.

    Examples
    --------
    >>> arm = limits_from_toml('angles = "degrees"\njoints.elbow = { position = [0, 90], speed = 180 }', "arm", "arm")
    >>> arm.high.round(3).tolist(), arm.speed.round(3).tolist(), arm.jerk.tolist()
    ([1.571], [3.142], [inf])
    """
    document = _document(text, label)
    unit = _UNITS[_one_of(document, "angles", tuple(_UNITS), label)]
    default = _told(document.get("default", {}), f"{label}: [default]", unit, _RATES)
    written = {
        joint: _told(values, f"{label}: {shown(joint)}", unit, ("position", *_RATES))
        for joint, values in _table(document.get("joints", {}), f"{label}: joints").items()
    }
    base = _model(document, label, model)
    if base is not None:
        _check_in(base, written, label)
    known = base.joints if base is not None else {}
    joints = {joint: {**default, **known.get(joint, {}), **written.get(joint, {})} for joint in {**known, **written}}
    _check_whole(joints, label)
    source = _source(document, label, base)
    try:
        return limits_of(_text(document, "name", label) or name, joints, source)
    except LimitError as error:
        raise LimitError(f"{label}: {error}") from None


def _document(text: str, label: str) -> dict[str, Any]:
    try:
        document = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise LimitError(f"{label} is no TOML: {str(error)[:200]}; names with dots or spaces need quotes") from None
    for key in document:
        if key not in _TOP:
            raise LimitError(f"{label}: {shown(key)}: no such key; there are {', '.join(_TOP)}")
    version = document.get("version", VERSION)
    if type(version) is not int or version != VERSION:
        raise LimitError(f"{label}: version {_shown(version)} found; this onbeat reads version {VERSION}")
    return document


def _table(value: object, where: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise LimitError(f"{where}: a table is expected, {_shown(value)} found")
    return cast("dict[str, Any]", value)


def _told(value: object, where: str, unit: float, keys: tuple[str, ...]) -> Told:
    """What a table tells, in radians."""
    table, told = _table(value, where), dict[str, float]()
    for key, given in table.items():
        if key not in keys:
            raise LimitError(f"{where}: {shown(key)}: no such key; there are {', '.join(keys)}{_is_speed(key)}")
        if key == "position":
            told["low"], told["high"] = (unit * limit for limit in _range(given, where))
        else:
            told[key] = unit * _number(given, f"{where}: {key}")
    return told


def _is_speed(key: str) -> str:
    return " (a velocity is a speed here)" if key == "velocity" else ""


def _range(value: object, where: str) -> tuple[float, float]:
    values = cast("list[object]", value) if isinstance(value, list) else []
    if len(values) != 2:
        raise LimitError(f"{where}: position: [low, high] is expected, {_shown(value)} found")
    low, high = (_number(one, f"{where}: position") for one in values)
    return low, high


def _number(value: object, where: str) -> float:
    """A number that is one; not true or false, which are integers in Python."""
    if type(value) in (int, float):
        try:
            number = float(cast("float", value))
        except OverflowError:
            number = math.nan
        if not math.isnan(number):
            return number
    raise LimitError(f"{where}: a number is expected, inf where there is no limit; {_shown(value)} found")


def _text(document: Mapping[str, Any], key: str, label: str) -> str:
    value = document.get(key, "")
    if not isinstance(value, str):
        raise LimitError(f"{label}: {key}: a text in quotes is expected, {_shown(value)} found")
    return value


def _one_of(document: Mapping[str, Any], key: str, words: tuple[str, ...], label: str) -> str:
    """One of some words, the first without it."""
    word = _text(document, key, label) or words[0]
    if word not in words:
        raise LimitError(f"{label}: {key}: {' or '.join(words)} is expected, {shown(word)!r} found")
    return word


def _model(document: Mapping[str, Any], label: str, model: ModelReader) -> Model | None:
    soft = document.get("soft", False)
    if not isinstance(soft, bool):
        raise LimitError(f"{label}: soft: true or false is expected, {_shown(soft)} found")
    name = _text(document, "model", label)
    return model(name, soft) if name else None


def _check_in(base: Model, written: Mapping[str, Told], label: str) -> None:
    """Raise where a joint is not the model's: it would be a slip of the pen."""
    known = tuple(base.joints)
    for joint in written:
        if joint not in base.joints:
            near = near_names(joint, known)
            raise LimitError(f"{label}: {shown(joint)}: the model has no such joint {near}; it has {listed(known)}")


def _check_whole(joints: Mapping[str, Told], label: str) -> None:
    if not joints:
        raise LimitError(f"{label} has limits of no joint; a table [joints] is expected, or a model")
    silent = without_speed(joints)
    if silent:
        raise LimitError(
            f"{label}: no speed is told for {listed(silent, 5)}; give them one, or all of them by [default] with a "
            "line like speed = 5.0; inf is no limit"
        )


def _source(document: Mapping[str, Any], label: str, base: Model | None) -> str:
    """Where the figures are from, in a line."""
    told = _text(document, "source", label) or label + (f" and {_text(document, 'model', label)}" if base else "")
    licence = _text(document, "licence", label)
    left_out = f"; {base.left_out}" if base is not None and base.left_out else ""
    return told + left_out + (f" ({licence})" if licence else "")


def _shown(value: object) -> str:
    try:
        return repr(value)[:60]
    except (ValueError, RecursionError):  # an integer of thousands of digits, lists in lists
        return f"a {type(value).__name__}"
