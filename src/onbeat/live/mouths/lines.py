"""Poses as lines of text, to whoever reads a stream: CSV, or JSON in the shape of ROS' JointTrajectory.

A file is written to by its number, past Python's buffers: a reader that stops reading then holds up nothing but the
thread that writes. One that goes away ends it quietly.
"""

from __future__ import annotations

import os
import time
from typing import IO, Any, Literal

import msgspec

from onbeat.errors import OnbeatError
from onbeat.live.protocol import Event, Pose, Who

Shape = Literal["csv", "trajectory"]
CHUNK = 10
"""Poses in one line of a trajectory."""
_SECOND = 1_000_000_000


class Lines:
    r"""A mouth that writes lines; events are not among them.

    Parameters
    ----------
    stream : binary, or a text stream over one such as ``sys.stdout``.
    shape : "csv": a header, then ``time`` [s], the root's place [m] and rotation (wxyz), then a robot's hinges [rad] or
        a character's joints (wxyz in their parents), a pose a line. "trajectory": a ``trajectory_msgs/JointTrajectory``
        of ten poses a line, of robots alone, its stamp the first pose's time since 1970.

    Examples
    --------
    >>> import io
    >>> out = io.BytesIO()
    >>> lines = Lines(out)
    >>> lines.open(Who("arm", "robot", ("base",), (-1,), ("elbow",), ()))
    >>> out.getvalue()
    b'time,root.x,root.y,root.z,root.qw,root.qx,root.qy,root.qz,elbow\n'
    """

    quick = False

    def __init__(self, stream: IO[Any], shape: Shape = "csv") -> None:
        self.name = f"the lines ({shape})"
        self.ended = False
        self._shape = shape
        self._stream = getattr(stream, "buffer", stream)
        self._number = _file_number(stream)
        self._begun = False
        self._waiting: list[Pose] = []

    def open(self, who: Who) -> None:
        """Write the header.

        Raises
        ------
        OnbeatError
            If a trajectory is asked of who has no hinges.
        """
        if self._shape == "trajectory" and not who.hinges:
            raise OnbeatError(f'{who.name} has no hinges, which make a trajectory; ask for "csv" or name a robot')
        self._who = who
        self._csv = ",".join(["%.4f", *["%.5f"] * (len(csv_columns(who)) - 1)]) + "\n"
        if self._shape == "csv" and not self._begun:
            self._write(",".join(csv_columns(who)) + "\n")
        self._begun = True

    def pose(self, pose: Pose) -> None:
        """Write the pose, or keep it until there are enough for a line."""
        if self.ended:
            return
        if self._shape == "csv":
            turns = pose.rotations[0].tolist() if self._who.kind == "robot" else pose.rotations.ravel().tolist()
            self._write(self._csv % (pose.time, *pose.root.tolist(), *turns, *pose.angles.tolist()))
            return
        self._waiting.append(pose)
        if len(self._waiting) == CHUNK:
            self._write(trajectory_line(self._who, self._waiting))
            self._waiting = []

    def say(self, event: Event) -> None:
        """Nothing: lines are poses."""

    def close(self) -> None:
        """Write what waits."""
        if self._waiting and not self.ended:
            self._write(trajectory_line(self._who, self._waiting))
        self._waiting = []

    def _write(self, line: str) -> None:
        data = memoryview(line.encode(errors="replace"))
        try:
            while len(data):
                data = data[self._put(data) :]
        except (BrokenPipeError, ConnectionError):
            self.ended = True

    def _put(self, data: memoryview) -> int:
        if self._number is None:
            return self._stream.write(data)
        try:
            return os.write(self._number, data)
        except BlockingIOError:  # somebody else made the file one that does not wait
            time.sleep(0.01)
            return 0


def csv_columns(who: Who) -> list[str]:
    """Names of the columns of CSV.

    Examples
    --------
    >>> csv_columns(Who("ann", "character", ("hips", "a,b"), (-1, 0), (), ()))[4:9]
    ['hips.qw', 'hips.qx', 'hips.qy', 'hips.qz', 'a_b.qw']
    """
    turning = ("root",) if who.kind == "robot" else who.joints
    turns = [f"{_cell(joint)}.{axis}" for joint in turning for axis in ("qw", "qx", "qy", "qz")]
    return ["time", "root.x", "root.y", "root.z", *turns, *(_cell(hinge) for hinge in who.hinges)]


def trajectory_line(who: Who, poses: list[Pose]) -> str:
    """Some poses in a row as one ``trajectory_msgs/JointTrajectory`` in JSON."""
    first = poses[0].time
    points = [
        {"positions": [round(angle, 6) for angle in pose.angles.tolist()], "time_from_start": _stamp(pose.time - first)}
        for pose in poses
    ]
    header = {"stamp": _stamp(who.started + first), "frame_id": ""}
    return msgspec.json.encode({"header": header, "joint_names": who.hinges, "points": points}).decode() + "\n"


def _stamp(seconds: float) -> dict[str, int]:
    nanoseconds = 1000 * round(seconds * 1e6)
    return {"sec": nanoseconds // _SECOND, "nanosec": nanoseconds % _SECOND}


def _cell(name: str) -> str:
    return "".join("_" if letter in ',"' or not letter.isprintable() else letter for letter in name)


def _file_number(stream: IO[Any]) -> int | None:
    """The number of the file under a stream, none where it is in memory; what was written before goes first."""
    try:
        stream.flush()
        return stream.fileno()
    except (OSError, AttributeError, ValueError):
        return None
