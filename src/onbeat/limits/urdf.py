"""Limits of a URDF (ROS's robot description): ``<limit lower upper velocity>`` of each joint, in radians.

Joints that turn or slide are taken; those that are fixed, float or follow another (``<mimic>``) are left out, and so
are those that are held (``lower = upper``). A velocity of 0, as CAD exporters write, counts as not told. A
``<safety_controller>``'s soft limits lie within the hard ones and are taken where they are asked for.
"""

from __future__ import annotations

import math
from xml.etree.ElementTree import Element

from onbeat.errors import LimitError
from onbeat.limits.joint_limit import Model, Told
from onbeat.limits.limits import shown
from onbeat.limits.plain_xml import number

_MOVING = ("revolute", "continuous", "prismatic")
_STILL = ("fixed", "floating", "planar")


def urdf_model(root: Element, label: str, soft: bool = False) -> Model:
    """What a URDF tells of its joints.

    Parameters
    ----------
    root : its ``<robot>``.
    label : the file, for messages.
    soft : take the soft limits of safety controllers where they are narrower.

    Raises
    ------
    LimitError
        If a joint has no name, an unknown type, no ``<limit>`` that it needs, or a number that is none.
    """
    joints, following, held = dict[str, Told](), 0, 0
    if any(child.tag.startswith("xacro:") for child in root):
        raise LimitError(f"{label} is a xacro, from which a URDF is made; run xacro on it first")
    for joint in root.findall("joint"):
        name, kind = _named(joint, label), joint.get("type", "")
        where = f"{label}: joint {shown(name)}"
        if kind not in (*_MOVING, *_STILL):
            raise LimitError(
                f"{where}: type {shown(kind)!r} found; one of {', '.join((*_MOVING, *_STILL))} is expected"
            )
        if kind in _STILL:
            continue
        if joint.find("mimic") is not None:
            following += 1
            continue
        told = _told(joint, kind, where, soft)
        if told.get("low", -1.0) == told.get("high", 1.0):
            held += 1
        elif name in joints:
            raise LimitError(f"{where} is there more than once")
        else:
            joints[name] = told
    counts = ((following, "follow others"), (held, "are held"))
    left_out = " and ".join(f"{count} joints that {do}" for count, do in counts if count)
    return Model(root.get("name", ""), joints, f"without {left_out}" if left_out else "")


def _named(joint: Element, label: str) -> str:
    name = joint.get("name", "")
    if not name:
        raise LimitError(f"{label}: a joint without a name found; a URDF's joints have names")
    return name


def _told(joint: Element, kind: str, where: str, soft: bool) -> Told:
    limit = joint.find("limit")
    if limit is None and kind != "continuous":
        raise LimitError(f"{where}: a {kind} joint needs a <limit lower= upper= velocity=>, none found")
    told = dict[str, float]()
    if limit is not None:
        velocity = number(limit, "velocity", where, 0.0)
        if velocity != 0:
            told["speed"] = velocity
    if limit is not None and kind != "continuous":
        told["low"], told["high"] = (number(limit, key, where, 0.0) for key in ("lower", "upper"))
        safety = joint.find("safety_controller")
        if soft and safety is not None:
            told["low"] = max(told["low"], number(safety, "soft_lower_limit", where, -math.inf))
            told["high"] = min(told["high"], number(safety, "soft_upper_limit", where, math.inf))
    return told
