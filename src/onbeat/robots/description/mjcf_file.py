"""Robots of MJCF files: MuJoCo reads them, and what it compiled is taken apart into pieces.

Only the tree under the heaviest body of the world is taken, with its hinges; slides and what equality constraints and
tendons tie are still or free. Motors, defaults and sensors are not taken: the robot gets its own. Geoms whose meshes
are not there are left out and counted in a warning.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from onbeat._shapes import Array
from onbeat.errors import BodyError
from onbeat.limits.plain_xml import read_xml
from onbeat.motion import rotations as rot
from onbeat.robots.description.description import AssumedWarning, Description
from onbeat.robots.description.pieces import Piece, Turn, description_of_pieces
from onbeat.robots.description.shapes import Shape, box, cloud, cylinder, sphere
from onbeat.robots.engine import engine

_LIGHT, _THIN = 1e-4, 1e-8
"""kg and kg·m² of what is between two hinges of one body: an engine needs some."""


def read_mjcf(path: Path) -> Description:
    """The description of a humanoid that an MJCF file holds; what is assumed is a warning.

    Raises
    ------
    BodyError
        If MuJoCo cannot read it (the reason it gives names the line, the joint or the mesh), it has no robot, a joint
        is a ball, a hinge has no name, or as :func:`onbeat.robots.description.pieces.description_of_pieces`.
    LimitError
        If the file cannot be read, is no XML or has a document type.
    """
    root = read_xml(path, "an MJCF")
    if root.tag != "mujoco":
        raise BodyError(f"{path}: <{root.tag[:40]}> found; an MJCF's <mujoco> is expected")
    model = _compiled(path)
    if model.neq or model.ntendon:
        warnings.warn(f"{path}: its equality constraints and tendons are left out", AssumedWarning, stacklevel=2)
    pieces = list(_pieces(model, str(path)))
    name = root.get("model", "") or path.stem
    return description_of_pieces(name, pieces, str(path), path.name)


def _compiled(path: Path) -> Any:
    """MuJoCo's model of a file; geoms whose meshes are not where the file says are left out, with a warning."""
    left_out = ""
    try:
        try:
            return engine().MjModel.from_xml_path(str(path))
        except ValueError:
            spec = engine().MjSpec.from_file(str(path))
            missing = _without_meshes(spec)
            if not missing:
                raise
            left_out = f" without the {len(missing)} meshes that are not where it says ({missing[0]}, …)"
            model = spec.compile()
    except ValueError as error:
        raise BodyError(f"{path}: MuJoCo cannot read it{left_out}: {' '.join(str(error).split())[:300]}") from None
    warnings.warn(
        f"{path}: {len(missing)} meshes are not where it says ({missing[0]}, …): their geoms are left out; links "
        "without a shape get capsules along them",
        AssumedWarning,
        stacklevel=3,
    )
    return model


def _without_meshes(spec: Any) -> list[str]:
    """Take the meshes whose files are not there out of a model that is not compiled yet; their files."""
    folder = Path(spec.modelfiledir, spec.meshdir)
    gone = {mesh.name or Path(mesh.file).stem: mesh for mesh in spec.meshes if mesh.file}
    gone = {name: mesh for name, mesh in gone.items() if not (folder / mesh.file).is_file()}
    missing = [str(Path(spec.meshdir, mesh.file)) for mesh in gone.values()]
    for element in [*(geom for geom in spec.geoms if geom.meshname in gone), *gone.values()]:
        if hasattr(spec, "delete"):
            spec.delete(element)
        else:  # MuJoCo before 3.3
            element.delete()
    return missing


def _pieces(model: Any, label: str) -> Iterator[Piece]:
    """The bodies of the robot, depth first as MuJoCo numbers them; one piece more for each further hinge of a body."""
    tops = [b for b in range(1, model.nbody) if model.body_parentid[b] == 0]
    if not tops:
        raise BodyError(f"{label}: no body found; a robot is expected")
    top = max(tops, key=lambda b: model.body_subtreemass[b])
    anchors, inside = {0: np.zeros(3)}, {0: ""}
    for body in range(top, model.nbody):
        if body != top and model.body_parentid[body] not in inside:
            break
        if body != top and model.body_parentid[body] == 0:
            break
        yield from _piece(model, body, top, anchors, inside, label)


def _piece(
    model: Any, body: int, top: int, anchors: dict[int, Array], inside: dict[int, str], label: str
) -> Iterator[Piece]:
    parent = 0 if body == top else int(model.body_parentid[body])
    name = model.body(body).name or f"body_{body}"
    turn, at = np.array(model.body_quat[body]), model.body_pos[body] - anchors[parent]
    above, anchor = inside[parent], np.zeros(3)
    first = int(model.body_jntadr[body])
    joints = range(first, first + int(model.body_jntnum[body]))
    hinges = [turned for j in joints if (turned := _hinge(model, j, label))]
    for number, (hinge, place) in enumerate(hinges[:-1]):
        between = f"{name}_{number}"
        at_hinge = at + rot.rotate(turn, place - anchor)
        light = (_LIGHT, np.zeros(3), np.eye(3) * _THIN)
        yield Piece(between, above, at_hinge, turn, hinge, *light)
        above, at, turn, anchor = between, np.zeros(3), rot.IDENTITY, place
    hinge = None
    if hinges:
        hinge, place = hinges[-1]
        at, anchor = at + rot.rotate(turn, place - anchor), place
    piece = Piece(name, above, at, turn, hinge, float(model.body_mass[body]), model.body_ipos[body] - anchor)
    axes = rot.to_matrix(np.array(model.body_iquat[body])[None])[0]
    piece.inertia = axes @ np.diag(model.body_inertia[body]) @ axes.T
    piece.shapes = [shape.moved(rot.IDENTITY, -anchor) for shape in _shapes(model, body)]
    anchors[body], inside[body] = anchor, name
    yield piece


def _hinge(model: Any, joint: int, label: str) -> tuple[Turn, Array] | None:
    """A hinge and its place in its body's frame; None of a free joint, a slide, and one that is held."""
    kinds, kind = engine().mjtJoint, int(model.jnt_type[joint])
    name = model.joint(joint).name
    if kind == kinds.mjJNT_BALL:
        raise BodyError(f"{label}: joint {name!r} is a ball; a robot's motors turn hinges: three of them are expected")
    if kind != kinds.mjJNT_HINGE:
        return None
    if not name:
        raise BodyError(
            f"{label}: a hinge of body {model.body(model.jnt_bodyid[joint]).name!r} has no name; give it one"
        )
    low, high = model.jnt_range[joint].tolist()
    if low > high:  # which MuJoCo takes for no limit
        raise BodyError(f"{label}: joint {name!r} has a range from {low:g} to {high:g}; the low limit comes first")
    if not model.jnt_limited[joint]:
        low, high = -math.pi, math.pi
    torque = _torque(model, joint)
    armature = float(model.dof_armature[model.jnt_dofadr[joint]])
    turn = Turn(name, np.array(model.jnt_axis[joint]), low, high, 0.0, torque, armature)
    return turn, np.array(model.jnt_pos[joint])


def _torque(model: Any, joint: int) -> float:
    """What the joint's own limit says, else its motor's; 0 where neither does."""
    if model.jnt_actfrclimited[joint]:
        return float(np.abs(model.jnt_actfrcrange[joint]).max())
    for motor in range(model.nu):
        if model.actuator_trnid[motor, 0] == joint and model.actuator_forcelimited[motor]:
            return float(np.abs(model.actuator_forcerange[motor]).max() * abs(model.actuator_gear[motor, 0]))
    return 0.0


def _shapes(model: Any, body: int) -> Iterator[Shape]:
    """The geoms of a body that collide; all of them where none does."""
    first = int(model.body_geomadr[body])
    geoms = range(first, first + int(model.body_geomnum[body]))
    solid = [geom for geom in geoms if model.geom_contype[geom] or model.geom_conaffinity[geom]]
    for geom in solid or geoms:
        shape = _shape(model, geom)
        if shape is not None:
            yield shape.moved(np.array(model.geom_quat[geom]), np.array(model.geom_pos[geom]))


def _shape(model: Any, geom: int) -> Shape | None:
    kinds, kind, size = engine().mjtGeom, int(model.geom_type[geom]), np.array(model.geom_size[geom])
    if kind == kinds.mjGEOM_SPHERE:
        return sphere(float(size[0]))
    if kind == kinds.mjGEOM_CAPSULE:
        return cylinder(float(size[0]), 2 * float(size[1] + size[0]))
    if kind == kinds.mjGEOM_CYLINDER:
        return cylinder(float(size[0]), 2 * float(size[1]))
    if kind in (kinds.mjGEOM_BOX, kinds.mjGEOM_ELLIPSOID):
        return box(size)
    if kind == kinds.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        first = int(model.mesh_vertadr[mesh])
        return cloud(np.array(model.mesh_vert[first : first + int(model.mesh_vertnum[mesh])], np.float64))
    return None
