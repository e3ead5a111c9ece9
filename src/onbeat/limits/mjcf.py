"""Limits of an MJCF (MuJoCo's model): the ``range`` of each hinge and slide. It does not tell how fast joints are.

As MuJoCo reads it: angles are in degrees unless ``<compiler angle="radian">``; a joint takes what it does not tell from
its default class, that of its ``class``, else of the nearest body's ``childclass``, else the outermost; a class takes
from the class around it. ``limited`` says whether the range counts; "auto", the default, that it does where it is
there; with ``<compiler autolimits="false">`` it has to be told. Ball and free joints, and those without a name, are
left out.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from xml.etree.ElementTree import Element

from onbeat.errors import LimitError
from onbeat.limits.joint_limit import Model, Told
from onbeat.limits.limits import shown
from onbeat.limits.plain_xml import as_number

Loader = Callable[[str], Element]
"""The root element of the file of an ``<include>``, by its name."""
_MOST_FILES = 100
_KINDS = ("hinge", "slide", "ball", "free")
_KEYS = ("type", "range", "limited")
_MAIN = "main"
"""The outermost default class; a file may give it another name as well."""


def mjcf_model(root: Element, label: str, load: Loader) -> Model:
    """What an MJCF tells of its joints.

    Parameters
    ----------
    root : its ``<mujoco>``; the content of includes is put into it.
    label : the file, for messages.
    load : reads the files it includes.

    Raises
    ------
    LimitError
        If a joint's class is not there, its type is unknown, its range is not two numbers or it is there twice, or if
        a file is included twice.
    """
    _include(root, load, label)
    compiler = {key: value for each in root.iter("compiler") for key, value in each.attrib.items()}
    classes = _classes(root, label)
    joints, nameless = dict[str, Told](), 0
    for joint, childclass in _joints(root):
        name = joint.get("name", "")
        where = f"{label}: joint {shown(name)}" if name else f"{label}: a joint without a name"
        given = _inherited(joint, childclass, classes, where)
        kind = given.get("type", "hinge")
        if kind not in _KINDS:
            raise LimitError(f"{where}: type {shown(kind)!r} found; one of {', '.join(_KINDS)} is expected")
        if kind in ("ball", "free"):
            continue
        if name in joints:
            raise LimitError(f"{where} is there more than once")
        if name:
            joints[name] = _told(given, kind, compiler, where)
        else:
            nameless += 1
    return Model(root.get("model", ""), joints, f"without {nameless} joints that have no name" if nameless else "")


def _include(root: Element, load: Loader, label: str) -> None:
    """Put in the place of each ``<include>`` what is in its file."""
    seen: set[str] = set()
    waiting = [root]
    while waiting:
        parent = waiting.pop()
        children = list[Element]()
        todo = list(parent)[::-1]
        while todo:
            child = todo.pop()
            if child.tag != "include":
                children.append(child)
                continue
            file = child.get("file", "")
            if file in seen or len(seen) == _MOST_FILES:
                raise LimitError(f"{label} includes {shown(file)!r} twice, or over {_MOST_FILES} files")
            seen.add(file)
            todo += list(load(file))[::-1]
        parent[:] = children
        waiting += children


def _classes(root: Element, label: str) -> dict[str, Mapping[str, str]]:
    """What each default class tells of a joint, with what it takes from those around it."""
    classes = {_MAIN: dict[str, str]()}
    for top in root.findall("default"):
        waiting = [(top, _MAIN, classes[_MAIN])]
        while waiting:
            element, name, above = waiting.pop()
            own = dict(above)
            for joint in element.findall("joint"):
                own.update(_attributes(joint))
            classes[name] = own
            if element is top and element.get("class"):
                classes[element.get("class", "")] = own
            for child in element.findall("default"):
                if not child.get("class"):
                    raise LimitError(f"{label}: a <default> within another needs a class; none found")
                waiting.append((child, child.get("class", ""), own))
    return dict(classes)


def _joints(root: Element) -> Iterator[tuple[Element, str]]:
    """The joints of the bodies, in the order of the file, each with the default class of its place."""
    waiting = [(element, _MAIN) for element in root.findall("worldbody")[::-1]]
    while waiting:
        element, childclass = waiting.pop()
        if element.tag == "joint":
            yield element, childclass
        elif element.tag in ("worldbody", "body", "frame"):
            childclass = element.get("childclass", childclass)
            waiting += [(child, childclass) for child in reversed(element)]


def _inherited(
    joint: Element, childclass: str, classes: Mapping[str, Mapping[str, str]], where: str
) -> Mapping[str, str]:
    name = joint.get("class", childclass)
    if name not in classes:
        raise LimitError(f"{where}: no default class {shown(name)!r} is there")
    return {**classes[name], **_attributes(joint)}


def _attributes(joint: Element) -> dict[str, str]:
    return {key: joint.attrib[key] for key in _KEYS if key in joint.attrib}


def _told(given: Mapping[str, str], kind: str, compiler: Mapping[str, str], where: str) -> Told:
    """The range, in radians or metres; nothing where it does not count."""
    limited = given.get("limited", "auto")
    if limited not in ("true", "false", "auto"):
        raise LimitError(f"{where}: limited {shown(limited)!r} found; true, false or auto is expected")
    if limited == "false" or (limited == "auto" and "range" not in given):
        return {}
    if limited == "auto" and compiler.get("autolimits", "true") != "true":
        raise LimitError(f'{where}: a range found, but not whether it counts: autolimits is off; tell limited="true"')
    words = given.get("range", "").split()
    if len(words) != 2:
        raise LimitError(f"{where}: a range of two numbers is expected, {given.get('range', '')[:40]!r} found")
    in_degrees = kind == "hinge" and compiler.get("angle", "degree") == "degree"
    unit = math.pi / 180 if in_degrees else 1.0
    low, high = (unit * as_number(word, f"{where}: range") for word in words)
    return {"low": low, "high": high}
