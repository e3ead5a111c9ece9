"""Binary glTF 2.0 (GLB): an animated armature with a simple body, as Blender, Unity, three.js and Windows open it.

One node per joint, turned by rotation channels; the root also moves. One skin binds a capsule body (see
:mod:`onbeat.formats.body_mesh`), each vertex to one joint. glTF demands metres, Y up, quaternions xyzw and 32-bit
floats; times run from 0 to (F − 1) / fps seconds. In the rest pose the body stands on the ground.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pygltflib as gltf

from onbeat._shapes import Float32, Positions
from onbeat.errors import FormatError
from onbeat.files import write_atomically
from onbeat.formats.body_mesh import body_mesh
from onbeat.formats.conventions import Convention, y_up_rotations, y_up_vectors
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot

_MOST_JOINTS = 2**16
_COLOUR = [0.85, 0.45, 0.25, 1.0]


def write_glb(motion: Motion, path: str | Path, convention: Convention | None = None) -> None:
    """Write a motion as a GLB file.

    Raises
    ------
    FormatError
        If another convention than Y up in metres is asked for: glTF allows no other.
    """
    if convention is not None and convention != Convention("y", "m"):
        raise FormatError("a .glb file is always in metres with Y up; leave the unit and the axis out")
    write_atomically(path, glb_bytes(motion))


def glb_bytes(motion: Motion) -> bytes:
    """The bytes of a GLB file.

    Raises
    ------
    FormatError
        If there are more joints than 16 bits count, or a time or a length is beyond 32-bit floats.
    """
    made, skeleton = _Builder(), motion.skeleton
    if len(skeleton) > _MOST_JOINTS:
        raise FormatError(f"a .glb file holds up to {_MOST_JOINTS} joints, the motion has {len(skeleton)}")
    times = _single(motion.times, "times of frames")
    if (np.diff(times) <= 0).any():
        raise FormatError(f"frames at {motion.fps:g} a second are too close for the times of a .glb file; resample it")
    rest = np.array(skeleton.rest_positions)
    stand = np.array([0.0, 0.0, -rest[:, 2].min()])
    made.nodes(skeleton, stand)
    made.skin_and_body(skeleton, rest + stand, stand)
    made.animation(motion)
    return made.bytes()


def _single(array: Any, what: str) -> Float32:
    """As 32-bit floats, which end at 3.4e38."""
    with np.errstate(over="ignore"):
        made = np.asarray(array, np.float32)
    if not np.isfinite(made).all():
        raise FormatError(f"the motion has {what} that no .glb file can hold, beyond 3e38; check its unit and its rate")
    return made


class _Builder:
    """Collects accessors into one buffer, and what points at them."""

    def __init__(self) -> None:
        self.file = gltf.GLTF2(asset=gltf.Asset(version="2.0", generator="onbeat"))
        self.blob = bytearray()

    def accessor(self, array: Any, kind: str, component: int, target: int | None = None, bounds: bool = False) -> int:
        """Append an array (N,) or (N, k) and return the number of its accessor."""
        array = np.ascontiguousarray(array)
        self.blob += b"\0" * (-len(self.blob) % 4)
        view = gltf.BufferView(buffer=0, byteOffset=len(self.blob), byteLength=array.nbytes, target=target)
        self.blob += array.tobytes()
        self.file.bufferViews.append(view)
        rows = array.reshape(len(array), -1)
        self.file.accessors.append(
            gltf.Accessor(
                bufferView=len(self.file.bufferViews) - 1,
                byteOffset=0,
                componentType=component,
                count=len(array),
                type=kind,
                min=rows.min(0).tolist() if bounds else None,
                max=rows.max(0).tolist() if bounds else None,
            )
        )
        return len(self.file.accessors) - 1

    def floats(self, array: Any, kind: str, target: int | None = None, bounds: bool = False) -> int:
        return self.accessor(_single(array, "lengths"), kind, gltf.FLOAT, target, bounds)

    def nodes(self, skeleton: Skeleton, stand: Positions) -> None:
        """One node per joint in the rest pose; node and joint have the same number."""
        offsets = y_up_vectors(skeleton.offsets + np.where(np.arange(len(skeleton))[:, None] == 0, stand, 0))
        for joint, name in enumerate(skeleton.names):
            children = list(skeleton.children[joint])
            self.file.nodes.append(gltf.Node(name=name, translation=offsets[joint].tolist(), children=children))

    def skin_and_body(self, skeleton: Skeleton, rest: Positions, stand: Positions) -> None:
        binds = np.tile(np.eye(4), (len(skeleton), 1, 1))
        binds[:, 3, :3] = -y_up_vectors(rest)  # column-major: the translation is the last row
        matrices = self.floats(binds.reshape(-1, 16), gltf.MAT4)
        joints = list(range(len(skeleton)))
        self.file.skins.append(gltf.Skin(name="body", inverseBindMatrices=matrices, skeleton=0, joints=joints))
        self.file.materials.append(
            gltf.Material(
                name="body",
                pbrMetallicRoughness=gltf.PbrMetallicRoughness(
                    baseColorFactor=_COLOUR, metallicFactor=0.0, roughnessFactor=0.7
                ),
                alphaCutoff=None,
            )
        )
        self.file.meshes.append(gltf.Mesh(name="body", primitives=[self._primitive(skeleton, stand)]))
        self.file.nodes.append(gltf.Node(name="body", mesh=0, skin=0))
        self.file.scenes.append(gltf.Scene(name="onbeat", nodes=[0, len(self.file.nodes) - 1]))
        self.file.scene = 0

    def _primitive(self, skeleton: Skeleton, stand: Positions) -> gltf.Primitive:
        mesh = body_mesh(skeleton)
        owner = np.zeros((len(mesh.joints), 4), np.uint16)
        owner[:, 0] = mesh.joints
        weights = np.tile([1.0, 0, 0, 0], (len(owner), 1))
        vertex = gltf.ARRAY_BUFFER
        attributes = gltf.Attributes(
            POSITION=self.floats(y_up_vectors(mesh.vertices + stand), gltf.VEC3, vertex, bounds=True),
            NORMAL=self.floats(y_up_vectors(mesh.normals), gltf.VEC3, vertex),
            JOINTS_0=self.accessor(owner, gltf.VEC4, gltf.UNSIGNED_SHORT, vertex),
            WEIGHTS_0=self.floats(weights, gltf.VEC4, vertex),
        )
        indices = mesh.triangles.astype(np.uint32).ravel()
        triangles = self.accessor(indices, gltf.SCALAR, gltf.UNSIGNED_INT, gltf.ELEMENT_ARRAY_BUFFER)
        return gltf.Primitive(attributes=attributes, indices=triangles, material=0)

    def animation(self, motion: Motion) -> None:
        """Rotation channels for all joints, translation channels for the root and what travels in its parent."""
        animation = gltf.Animation(name=motion.name or "motion")
        self.file.animations.append(animation)
        times = self.floats(motion.times, gltf.SCALAR, bounds=True)
        turned = rot.normalise(rot.continuous(y_up_rotations(motion.rotations)))[..., [1, 2, 3, 0]]
        for joint in np.flatnonzero(~motion.skeleton.end_sites).tolist():
            self._channel(animation, joint, "rotation", times, self.floats(turned[:, joint], gltf.VEC4))
        self._channel(animation, 0, "translation", times, self.floats(y_up_vectors(motion.root_positions), gltf.VEC3))
        moved = motion.translations
        if moved is not None:
            for joint in (np.flatnonzero(np.ptp(moved[:, 1:], axis=0).max(-1) > 0) + 1).tolist():
                path = self.floats(y_up_vectors(moved[:, joint]), gltf.VEC3)
                self._channel(animation, joint, "translation", times, path)

    def _channel(self, animation: gltf.Animation, node: int, path: str, times: int, values: int) -> None:
        animation.samplers.append(gltf.AnimationSampler(input=times, output=values, interpolation="LINEAR"))
        target = gltf.AnimationChannelTarget(node=node, path=path)
        animation.channels.append(gltf.AnimationChannel(sampler=len(animation.samplers) - 1, target=target))

    def bytes(self) -> bytes:
        self.blob += b"\0" * (-len(self.blob) % 4)
        self.file.buffers.append(gltf.Buffer(byteLength=len(self.blob)))
        self.file.set_binary_blob(bytes(self.blob))
        return b"".join(self.file.save_to_bytes())
