"""Whether a description can be a robot's: a tree, hinges that turn, masses that can be, two feet."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from onbeat.errors import BodyError
from onbeat.robots.description.description import Description, Link, Root, moments

LARGEST = 1e5
"""No metre, radian, kilogram or N·m of a robot is past this."""
_SIDES = ("left", "right")


def check_description(description: Description, label: str) -> None:
    """Raise a ``BodyError`` that names the first link or joint that cannot be.

    Links are in a tree and depth first, joints have names of their own, axes a length, limits an order; an inertia is
    a body's (no principal moment is more than the sum of the others); left and right foot stand on links that are.
    """
    for problem in _problems(description):
        raise BodyError(f"{label}: {problem}")


def _problems(description: Description) -> Iterator[str]:
    root, links = description.root, description.links
    yield from _heavy(root.link, root)
    line, joints = [root.link], set[str]()
    for name, link in links.items():
        if link.parent not in line:
            yield _out_of_order(name, link.parent, description)
        del line[line.index(link.parent) + 1 :]
        line.append(name)
        if link.joint in joints or name == root.link:
            yield f"joint {link.joint!r} of link {name!r} is there twice; give each link and joint a name of its own"
        joints.add(link.joint)
        yield from _hinge(link)
        yield from _heavy(name, link)
    yield from _points(description)


def _out_of_order(name: str, parent: str, description: Description) -> str:
    if parent == name or parent not in {description.root.link, *description.links}:
        return f"link {name!r} hangs on {parent!r}, which is no other link"
    return f"link {name!r} is not in its place: list parents first, and all that hangs on a link before the next one"


def _hinge(link: Link) -> Iterator[str]:
    low, high = link.position
    numbers = (*link.origin, *link.rpy, *link.axis, low, high, link.torque, link.armature)
    if not all(abs(number) < LARGEST for number in numbers):
        yield f"joint {link.joint!r} has a number that no robot has: {_worst(numbers):g}"
    if float(np.linalg.norm(link.axis)) < 1e-6:
        yield f"joint {link.joint!r} turns about an axis of no length; a direction is expected, as [0, 1, 0]"
    if not low < high:
        yield f"joint {link.joint!r} turns from {low:g} to {high:g} rad; the low limit is expected under the high one"


def _worst(numbers: tuple[float, ...]) -> float:
    return next(number for number in numbers if not abs(number) < LARGEST)


def _heavy(name: str, link: Link | Root) -> Iterator[str]:
    numbers = (link.mass, *link.centre, *link.inertia, *(number for capsule in link.capsules for number in capsule))
    if not all(abs(number) < LARGEST for number in numbers):
        yield f"link {name!r} has a number that no robot has: {_worst(numbers):g}"
        return
    if any(capsule[6] <= 0 for capsule in link.capsules):
        yield f"link {name!r} has a capsule whose radius is not above zero"
    least, middle, most = moments(link.inertia)
    if least <= 0 or least + middle < most * (1 - 1e-9):
        yield (
            f"link {name!r} has an inertia that no body has: principal moments of {least:.3g}, {middle:.3g} and "
            f"{most:.3g} kg·m²; each is above zero, and at most the sum of the others"
        )


def _points(description: Description) -> Iterator[str]:
    known = {description.root.link, *description.links}
    if set(description.feet) != set(_SIDES):
        found = ", ".join(map(repr, description.feet)) or "none"
        yield f"feet left and right are expected, {found} found"
    points = {**description.ends, **description.pads}
    places = [*(at for sole in description.feet.values() for at in sole.corners), *(p.at for p in points.values())]
    if not all(abs(number) < LARGEST for place in places for number in place):
        yield "a foot, an end or a pad has a number that no robot has"
    for what in (*description.feet.values(), *points.values()):
        if what.link not in known:
            yield f"a foot, an end or a pad is on {what.link!r}, which is no link"
