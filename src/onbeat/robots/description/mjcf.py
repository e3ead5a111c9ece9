"""A description as MJCF, MuJoCo's own XML: a free root, hinges, motors, capsules, soles and a floor.

The soles touch the floor with a small sphere under each corner, whose lowest point is the corner; capsules touch the
floor (a robot that falls lies on it) and each other. Links that are neighbours, or joined by a third whose capsules
cannot but overlap, are not looked at for collisions.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from xml.sax.saxutils import quoteattr

import numpy as np

from onbeat._shapes import Array
from onbeat.motion import rotations as rot
from onbeat.robots.description.description import Capsule, Description, Link, Root
from onbeat.robots.description.rest import excluded, standing_height

FRICTION = 1.0
"""Of rubber soles on a stage's floor; sliding."""
SOLE = 0.005
"""Metres, the radius of the spheres under a sole's corners."""
STEP = 0.002
"""Seconds of a step of the simulation."""
_HEAD = """<mujoco model={name}>
  <compiler angle="radian" autolimits="true"/>
  <option timestep="{step}" integrator="implicitfast" cone="elliptic" impratio="10"/>
  <visual>
    <headlight ambient="0.4 0.4 0.4" diffuse="0.5 0.5 0.5"/>
    <global offwidth="1920" offheight="1080"/>
    <quality shadowsize="4096"/>
  </visual>
  <asset>
    <texture name="sky" type="skybox" builtin="gradient" rgb1="0.9 0.93 0.96" rgb2="0.6 0.68 0.78" width="64" height="384"/>
    <texture name="floor" type="2d" builtin="checker" rgb1="0.78 0.78 0.76" rgb2="0.7 0.7 0.68" width="256" height="256"/>
    <material name="floor" texture="floor" texrepeat="2 2" texuniform="true" reflectance="0.1"/>
  </asset>
  <default>
    <geom density="0"/>
    <default class="capsule">
      <geom type="capsule" contype="2" conaffinity="3" rgba="0.55 0.6 0.68 1"/>
    </default>
    <default class="sole">
      <geom type="sphere" size="{sole}" contype="0" conaffinity="1" condim="4" priority="1" friction="{friction} 0.005 0.0001" rgba="0.25 0.27 0.3 1"/>
    </default>
  </default>
"""  # noqa: E501


def mjcf_of(description: Description, friction: float = FRICTION) -> str:
    """The MJCF of a robot on a floor, standing on it with straight legs in the zero configuration.

    Parameters
    ----------
    description : the robot, sound.
    friction : sliding friction of the soles.

    Examples
    --------
    >>> from onbeat.robots.description.toml import described
    >>> mjcf_of(described("g1")).count("<motor ")
    29
    """
    head = _HEAD.format(name=quoteattr(description.name), step=STEP, sole=SOLE, friction=f"{friction:g}")
    parts = (_bodies(description), _contact(description), _motors(description))
    return head + "".join(line + "\n" for part in parts for line in part) + "</mujoco>\n"


def numbers(values: Sequence[float] | Array) -> str:
    """Numbers as attributes have them, with all their digits."""
    return " ".join(f"{float(value):.12g}" for value in values)


def _bodies(description: Description) -> Iterator[str]:
    yield "  <worldbody>"
    yield '    <light pos="0 0 4" dir="0 0 -1" directional="true" diffuse="0.5 0.5 0.5"/>'
    yield '    <geom name="floor" type="plane" size="0 0 0.05" material="floor" contype="1" conaffinity="1"/>'
    root = description.root
    yield f'    <body name={quoteattr(root.link)} pos="0 0 {standing_height(description):.6g}">'
    yield '      <freejoint name="root"/>'
    yield from _inside(root.link, root, description, "      ")
    line = [root.link]
    for name, link in description.links.items():
        yield from _closed(line, line.index(link.parent) + 1)
        yield from _opened(name, link, description, "      " + "  " * (len(line) - 1))
        line.append(name)
    yield from _closed(line, 0)
    yield "  </worldbody>"


def _closed(line: list[str], left: int) -> Iterator[str]:
    """Close bodies until only the first ``left`` of the line are open."""
    while len(line) > left:
        yield "    " + "  " * (len(line) - 1) + "</body>"
        line.pop()


def _opened(name: str, link: Link, description: Description, indent: str) -> Iterator[str]:
    quat = rot.from_euler("ZYX", np.array(link.rpy[::-1]))
    turned = f' quat="{numbers(quat)}"' if any(link.rpy) else ""
    yield f'{indent}<body name={quoteattr(name)} pos="{numbers(link.origin)}"{turned}>'
    yield (
        f'{indent}  <joint name={quoteattr(link.joint)} axis="{numbers(link.axis)}" range="{numbers(link.position)}" '
        f'armature="{link.armature:.12g}" actuatorfrcrange="{numbers((-link.torque, link.torque))}"/>'
    )
    yield from _inside(name, link, description, indent + "  ")


def _inside(name: str, link: Link | Root, description: Description, indent: str) -> Iterator[str]:
    mass = f'mass="{link.mass:.12g}" fullinertia="{numbers(link.inertia)}"'
    yield f'{indent}<inertial pos="{numbers(link.centre)}" {mass}/>'
    for capsule in link.capsules:
        yield f"{indent}<geom {_shape(capsule)}/>"
    touching = {
        f"{side}_sole_{number}": (sole.link, corner)
        for side, sole in description.feet.items()
        for number, corner in enumerate(sole.corners)
    } | {f"pad_{pad}": (point.link, point.at) for pad, point in description.pads.items()}
    for geom, (link_name, (x, y, z)) in touching.items():
        if link_name == name:
            yield f'{indent}<geom class="sole" name={quoteattr(geom)} pos="{numbers((x, y, z + SOLE))}"/>'


def _shape(capsule: Capsule) -> str:
    ends, radius = capsule[:6], capsule[6]
    if ends[:3] == ends[3:]:
        return f'class="capsule" type="sphere" pos="{numbers(ends[:3])}" size="{radius:.12g}"'
    return f'class="capsule" fromto="{numbers(ends)}" size="{radius:.12g}"'


def _contact(description: Description) -> Iterator[str]:
    yield "  <contact>"
    for one, other in excluded(description):
        yield f"    <exclude body1={quoteattr(one)} body2={quoteattr(other)}/>"
    yield "  </contact>"


def _motors(description: Description) -> Iterator[str]:
    yield "  <actuator>"
    for link in description.links.values():
        joint, most = quoteattr(link.joint), numbers((-link.torque, link.torque))
        yield f'    <motor name={joint} joint={joint} ctrlrange="{most}" forcerange="{most}"/>'
    yield "  </actuator>"
