"""Dances as ROS 2 messages in an MCAP bag: ``trajectory_msgs/JointTrajectory``, as controllers take it.

One message on ``/joint_trajectory`` has the names of all hinges and, for each frame, their angles, velocities and
accelerations with the time from the start; one on ``/root_trajectory`` (``MultiDOFJointTrajectory``) has the path of
the root, so that the whole motion can be read back. ``ros2 bag play`` plays it. Needs the extra ``[ros]``.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from onbeat._shapes import Array
from onbeat.errors import FormatError, MissingExtraError
from onbeat.files import write_atomically
from onbeat.motion.motion import Motion
from onbeat.robots.model import Robot
from onbeat.robots.sequences.even import even_rate
from onbeat.robots.state import Derivatives, configurations, derivatives, motion_of

JOINTS, ROOT = "/joint_trajectory", "/root_trajectory"
_KIND = "trajectory_msgs/msg/"
_KINDS = {JOINTS: f"{_KIND}JointTrajectory", ROOT: f"{_KIND}MultiDOFJointTrajectory"}
LARGEST = 1 << 30
"""Bytes of a bag that is read."""
_SECOND = 1_000_000_000
_VERSION = 9
"""Of bags, as ROS 2 Jazzy writes them."""


def write_mcap(robot: Robot, motion: Motion, path: Path) -> None:
    """Write a dance of the robot as a bag: one file, MCAP.

    Raises
    ------
    MissingExtraError
        If ``rosbags`` is not installed.
    BodyError
        If the motion is not the robot's.
    OnbeatError
        If the file cannot be written.
    """
    types = _types()
    qpos = configurations(robot, motion)
    names = list(robot.body.names)
    stamps = [_duration(types, time) for time in motion.times.tolist()]
    messages = {
        JOINTS: _joints(types, names, qpos, derivatives(robot, qpos, motion.fps), stamps),
        ROOT: _root(types, robot.body.skeleton.names[0], qpos, stamps),
    }
    write_atomically(path, _bag(types, messages))


def read_mcap(robot: Robot, path: Path) -> Motion:
    """Read a dance of the robot from a bag that :func:`write_mcap` wrote.

    Raises
    ------
    MissingExtraError
        If ``rosbags`` is not installed.
    FormatError
        If it is no MCAP that can be read, a message is missing, a joint is, or the times are not even.
    """
    found = _messages(_types(), path)
    joints, root = found[JOINTS], found[ROOT]
    missing = [name for name in robot.body.names if name not in joints.joint_names]
    if missing:
        raise FormatError(f"{path}: no joint {', '.join(missing[:4])} of {robot.name} in its trajectory")
    if not joints.points or len(joints.points) != len(root.points):
        raise FormatError(f"{path}: {len(joints.points)} poses and {len(root.points)} places of the root found")
    order = [joints.joint_names.index(name) for name in robot.body.names]
    try:
        angles = np.array([point.positions for point in joints.points], np.float64)[:, order]
    except (ValueError, IndexError):
        raise FormatError(f"{path}: a pose has not an angle for each of {len(joints.joint_names)} joints") from None
    places = np.array([_placed(point) for point in root.points])
    times = np.array([p.time_from_start.sec + p.time_from_start.nanosec / _SECOND for p in joints.points])
    return motion_of(robot, np.hstack((places, angles)), even_rate(times, str(path)), path.stem)


def _types() -> Any:
    """The messages of ROS 2."""
    try:
        from rosbags.typesys import Stores, get_typestore
    except ImportError:
        raise MissingExtraError('bags of ROS need rosbags: pip install "onbeat[ros]"') from None
    return get_typestore(Stores.ROS2_HUMBLE)


def _duration(types: Any, time: float) -> Any:
    nanoseconds = round(time * _SECOND)
    return types.types["builtin_interfaces/msg/Duration"](nanoseconds // _SECOND, nanoseconds % _SECOND)


def _header(types: Any, frame: str) -> Any:
    stamp = types.types["builtin_interfaces/msg/Time"](0, 0)
    return types.types["std_msgs/msg/Header"](stamp, frame)


def _joints(types: Any, names: list[str], qpos: Array, moving: Derivatives, stamps: list[Any]) -> Any:
    point, none = types.types[f"{_KIND}JointTrajectoryPoint"], np.zeros(0)
    rows = zip(qpos[:, 7:], moving.qvel[:, 6:], moving.qacc[:, 6:], stamps, strict=True)
    points = [point(*map(np.ascontiguousarray, row[:3]), none, row[3]) for row in rows]
    return types.types[f"{_KIND}JointTrajectory"](_header(types, ""), names, points)


def _root(types: Any, name: str, qpos: Array, stamps: list[Any]) -> Any:
    geometry = "geometry_msgs/msg/"
    vector, quaternion, transform = (types.types[geometry + kind] for kind in ("Vector3", "Quaternion", "Transform"))
    point = types.types[f"{_KIND}MultiDOFJointTrajectoryPoint"]
    points = [
        point([transform(vector(x, y, z), quaternion(i, j, k, w))], [], [], stamp)
        for (x, y, z, w, i, j, k), stamp in zip(qpos[:, :7].tolist(), stamps, strict=True)
    ]
    return types.types[f"{_KIND}MultiDOFJointTrajectory"](_header(types, "world"), [name], points)


def _placed(point: Any) -> list[float]:
    """``x y z w i j k`` of the root."""
    if not point.transforms:
        raise FormatError("a place of the root has no transform")
    at, turn = point.transforms[0].translation, point.transforms[0].rotation
    return [at.x, at.y, at.z, turn.w, turn.x, turn.y, turn.z]


def _bag(types: Any, messages: Mapping[str, Any]) -> bytes:
    """The bytes of a bag that has each message on its topic at time 0."""
    from rosbags.rosbag2 import StoragePlugin, Writer

    with tempfile.TemporaryDirectory() as folder:
        bag = Path(folder) / "dance"  # its name is in the bytes
        with Writer(bag, version=_VERSION, storage_plugin=StoragePlugin.MCAP) as writer:
            for topic, message in messages.items():
                kind = message.__msgtype__
                connection = writer.add_connection(topic, kind, typestore=types)
                writer.write(connection, 0, types.serialize_cdr(message, kind))
        return (bag / "dance.mcap").read_bytes()


def _messages(types: Any, path: Path) -> dict[str, Any]:
    """The first message of each of both topics."""
    from rosbags.rosbag2 import Reader

    found = dict[str, Any]()
    try:
        if path.stat().st_size > LARGEST:
            raise FormatError(f"{path}: more than {LARGEST >> 20} MB found; no dance has as much")
        with Reader(path) as reader:
            chosen = [connection for connection in reader.connections if connection.topic in _KINDS]
            for connection, _, data in reader.messages(connections=chosen):
                if connection.msgtype == _KINDS[connection.topic]:
                    found.setdefault(connection.topic, types.deserialize_cdr(data, connection.msgtype))
    except FormatError:
        raise
    except OSError as error:
        raise FormatError(f"cannot read {path}: {error.strerror or error}") from None
    except Exception as error:  # a damaged bag breaks the reader in many ways
        raise FormatError(f"{path} is no bag (MCAP) that can be read: {str(error)[:200]}") from None
    for topic, kind in _KINDS.items():
        if topic not in found:
            raise FormatError(f"{path}: no {kind} on {topic} found")
    return found
