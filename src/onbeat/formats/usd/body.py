"""The visible body of a USD stage: the capsule mesh, each vertex bound to one joint, and the box it moves in."""

from __future__ import annotations

from typing import Any

import numpy as np

from onbeat._shapes import Array, Float32, Positions
from onbeat.errors import FormatError
from onbeat.formats.body_mesh import Mesh, body_mesh
from onbeat.formats.conventions import Convention, up_vectors
from onbeat.motion import Motion
from onbeat.motion import rotations as rot

_COLOUR = (0.85, 0.45, 0.25)


def in_stage(v: Positions, convention: Convention) -> Float32:
    """Vectors (..., 3) in metres with Z up in the axes and the unit of a stage.

    Raises
    ------
    FormatError
        If one is longer than 32-bit floats go.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        made = np.ascontiguousarray(up_vectors(v, convention.up) / convention.metres, np.float32)
    if not np.isfinite(made).all():
        raise FormatError("the motion has lengths that no USD file can hold, beyond 3e38; check its unit")
    return made


def add_body(pxr: Any, stage: Any, motion: Motion, stand: Positions, convention: Convention) -> None:
    """Add ``/dancer/body`` to a stage and the extent of ``/dancer`` at each frame.

    Parameters
    ----------
    pxr : the modules of usd-core.
    stage : the stage that has ``/dancer`` and ``/dancer/skeleton``.
    stand : (3,) metres, the root in the rest pose.
    convention : the stage's up axis and unit.
    """
    mesh, vectors = body_mesh(motion.skeleton), pxr.Vt.Vec3fArray.FromNumpy
    points = in_stage(mesh.vertices + stand, convention)
    made = pxr.UsdGeom.Mesh.Define(stage, "/dancer/body")
    made.CreatePointsAttr(vectors(points))
    made.CreateNormalsAttr(vectors(in_stage(mesh.normals * convention.metres, convention)))
    made.SetNormalsInterpolation("vertex")
    made.CreateFaceVertexCountsAttr([3] * len(mesh.triangles))
    made.CreateFaceVertexIndicesAttr(mesh.triangles.ravel().tolist())
    made.CreateSubdivisionSchemeAttr("none")
    made.CreateExtentAttr(vectors(np.stack((points.min(0), points.max(0)))))
    made.CreateDisplayColorAttr([_COLOUR])
    _bind(pxr, made.GetPrim(), mesh)
    _paint(pxr, stage, made.GetPrim())
    extent = pxr.UsdGeom.Boundable(stage.GetPrimAtPath("/dancer")).CreateExtentAttr()
    for frame, box in enumerate(_extents(motion, mesh, convention)):
        extent.Set(vectors(box), frame)


def _bind(pxr: Any, body: Any, mesh: Mesh) -> None:
    binding = pxr.UsdSkel.BindingAPI.Apply(body)
    binding.CreateSkeletonRel().SetTargets([pxr.Sdf.Path("/dancer/skeleton")])
    binding.CreateJointIndicesPrimvar(False, 1).Set(mesh.joints.tolist())
    binding.CreateJointWeightsPrimvar(False, 1).Set([1.0] * len(mesh.joints))
    binding.CreateGeomBindTransformAttr(pxr.Gf.Matrix4d(1))


def _paint(pxr: Any, stage: Any, body: Any) -> None:
    """A material beside the display colour: programs that render look at one only, viewers at the other."""
    material = pxr.UsdShade.Material.Define(stage, "/dancer/look")
    surface = pxr.UsdShade.Shader.Define(stage, "/dancer/look/surface")
    surface.CreateIdAttr("UsdPreviewSurface")
    surface.CreateInput("diffuseColor", pxr.Sdf.ValueTypeNames.Color3f).Set(_COLOUR)
    surface.CreateInput("roughness", pxr.Sdf.ValueTypeNames.Float).Set(0.7)
    material.CreateSurfaceOutput().ConnectToSource(surface.ConnectableAPI(), "surface")
    pxr.UsdShade.MaterialBindingAPI.Apply(body).Bind(material)


def _extents(motion: Motion, mesh: Mesh, convention: Convention) -> Float32:
    """(F, 2, 3) a box around the moved body at each frame: around the turned box of each joint's vertices.

    A box of centre c and half sizes h, turned by R, reaches as far as ``R c ± |R| h``.
    """
    joints = np.unique(mesh.joints)
    own = mesh.vertices - motion.skeleton.rest_positions[mesh.joints]
    low = np.array([own[mesh.joints == joint].min(0) for joint in joints])
    high = np.array([own[mesh.joints == joint].max(0) for joint in joints])
    matrices: Array = rot.to_matrix(motion.world_rotations[:, joints])
    centre = motion.positions[:, joints] + np.einsum("fjab,jb->fja", matrices, (low + high) / 2)
    reach = np.einsum("fjab,jb->fja", np.abs(matrices), (high - low) / 2)
    corners = in_stage(np.stack(((centre - reach).min(1), (centre + reach).max(1)), axis=1), convention)
    return np.stack((corners.min(1), corners.max(1)), axis=1)
