"""The humanoid Unitree G1 with 29 hinges: where they are, how they turn, and how far and how fast they may.

Figures of Unitree's own models (``g1_29dof_rev_1_0.urdf``; the MJCF of the same name and mjlab's have the same
places). Their velocity limits of the ankles differ between sources: 30 rad/s here, 37 in others. The robot
faces +X in its zero configuration, its left is +Y.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Positions, Rotations
from onbeat.errors import BodyError, FormatError
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import End, Hinge, HingeBody, hinge_angles, hinge_motion
from onbeat.motion.motion import Motion

_X, _Y, _Z, _FLAT = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)
_LEGS = (
    Hinge("left_hip_pitch_joint", "pelvis", (0, 0.064452, -0.1027), _FLAT, _Y, -2.5307, 2.8798, 32),
    Hinge(
        "left_hip_roll_joint", "left_hip_pitch_joint", (0, 0.052, -0.030465), (0, -0.1749, 0), _X, -0.5236, 2.9671, 20
    ),
    Hinge("left_hip_yaw_joint", "left_hip_roll_joint", (0.025001, 0, -0.12412), _FLAT, _Z, -2.7576, 2.7576, 32),
    Hinge(
        "left_knee_joint",
        "left_hip_yaw_joint",
        (-0.078273, 0.0021489, -0.17734),
        (0, 0.1749, 0),
        _Y,
        -0.087267,
        2.8798,
        20,
    ),
    Hinge("left_ankle_pitch_joint", "left_knee_joint", (0, -9.4445e-05, -0.30001), _FLAT, _Y, -0.87267, 0.5236, 30),
    Hinge("left_ankle_roll_joint", "left_ankle_pitch_joint", (0, 0, -0.017558), _FLAT, _X, -0.2618, 0.2618, 30),
    Hinge("right_hip_pitch_joint", "pelvis", (0, -0.064452, -0.1027), _FLAT, _Y, -2.5307, 2.8798, 32),
    Hinge(
        "right_hip_roll_joint",
        "right_hip_pitch_joint",
        (0, -0.052, -0.030465),
        (0, -0.1749, 0),
        _X,
        -2.9671,
        0.5236,
        20,
    ),
    Hinge("right_hip_yaw_joint", "right_hip_roll_joint", (0.025001, 0, -0.12412), _FLAT, _Z, -2.7576, 2.7576, 32),
    Hinge(
        "right_knee_joint",
        "right_hip_yaw_joint",
        (-0.078273, -0.0021489, -0.17734),
        (0, 0.1749, 0),
        _Y,
        -0.087267,
        2.8798,
        20,
    ),
    Hinge("right_ankle_pitch_joint", "right_knee_joint", (0, 9.4445e-05, -0.30001), _FLAT, _Y, -0.87267, 0.5236, 30),
    Hinge("right_ankle_roll_joint", "right_ankle_pitch_joint", (0, 0, -0.017558), _FLAT, _X, -0.2618, 0.2618, 30),
)
_TRUNK = (
    Hinge("waist_yaw_joint", "pelvis", (0, 0, 0), _FLAT, _Z, -2.618, 2.618, 32),
    Hinge("waist_roll_joint", "waist_yaw_joint", (-0.0039635, 0, 0.044), _FLAT, _X, -0.52, 0.52, 30),
    Hinge("waist_pitch_joint", "waist_roll_joint", (0, 0, 0), _FLAT, _Y, -0.52, 0.52, 30),
)
_LEFT_SHOULDER, _RIGHT_SHOULDER = (0.27931, 5.4949e-05, -0.00019159), (-0.27931, 5.4949e-05, 0.00019159)
_ARMS = (
    Hinge(
        "left_shoulder_pitch_joint",
        "waist_pitch_joint",
        (0.0039563, 0.10022, 0.24778),
        _LEFT_SHOULDER,
        _Y,
        -3.0892,
        2.6704,
        37,
    ),
    Hinge(
        "left_shoulder_roll_joint",
        "left_shoulder_pitch_joint",
        (0, 0.038, -0.013831),
        (-0.27925, 0, 0),
        _X,
        -1.5882,
        2.2515,
        37,
    ),
    Hinge("left_shoulder_yaw_joint", "left_shoulder_roll_joint", (0, 0.00624, -0.1032), _FLAT, _Z, -2.618, 2.618, 37),
    Hinge("left_elbow_joint", "left_shoulder_yaw_joint", (0.015783, 0, -0.080518), _FLAT, _Y, -1.0472, 2.0944, 37),
    Hinge("left_wrist_roll_joint", "left_elbow_joint", (0.1, 0.00188791, -0.01), _FLAT, _X, -1.972222, 1.972222, 37),
    Hinge("left_wrist_pitch_joint", "left_wrist_roll_joint", (0.038, 0, 0), _FLAT, _Y, -1.61443, 1.61443, 22),
    Hinge("left_wrist_yaw_joint", "left_wrist_pitch_joint", (0.046, 0, 0), _FLAT, _Z, -1.61443, 1.61443, 22),
    Hinge(
        "right_shoulder_pitch_joint",
        "waist_pitch_joint",
        (0.0039563, -0.10021, 0.24778),
        _RIGHT_SHOULDER,
        _Y,
        -3.0892,
        2.6704,
        37,
    ),
    Hinge(
        "right_shoulder_roll_joint",
        "right_shoulder_pitch_joint",
        (0, -0.038, -0.013831),
        (0.27925, 0, 0),
        _X,
        -2.2515,
        1.5882,
        37,
    ),
    Hinge(
        "right_shoulder_yaw_joint", "right_shoulder_roll_joint", (0, -0.00624, -0.1032), _FLAT, _Z, -2.618, 2.618, 37
    ),
    Hinge("right_elbow_joint", "right_shoulder_yaw_joint", (0.015783, 0, -0.080518), _FLAT, _Y, -1.0472, 2.0944, 37),
    Hinge("right_wrist_roll_joint", "right_elbow_joint", (0.1, -0.00188791, -0.01), _FLAT, _X, -1.972222, 1.972222, 37),
    Hinge("right_wrist_pitch_joint", "right_wrist_roll_joint", (0.038, 0, 0), _FLAT, _Y, -1.61443, 1.61443, 22),
    Hinge("right_wrist_yaw_joint", "right_wrist_pitch_joint", (0.046, 0, 0), _FLAT, _Z, -1.61443, 1.61443, 22),
)
# The soles' ends, the finger tips and the middle of the head: the ends of mjlab's collision capsules.
_ENDS = (
    End("left_toe", "left_ankle_roll_joint", (0.132, 0, -0.035)),
    End("left_heel", "left_ankle_roll_joint", (-0.054, 0, -0.035)),
    End("right_toe", "right_ankle_roll_joint", (0.132, 0, -0.035)),
    End("right_heel", "right_ankle_roll_joint", (-0.054, 0, -0.035)),
    End("left_hand", "left_wrist_yaw_joint", (0.15, -0.02, 0)),
    End("right_hand", "right_wrist_yaw_joint", (0.15, 0.02, 0)),
    End("head", "waist_pitch_joint", (0, 0, 0.43)),
)
G1 = HingeBody.of("Unitree G1 with 29 joints", "pelvis", _LEGS + _TRUNK + _ARMS, _ENDS)
"""The robot; its hinges are in Unitree's own order, which is MuJoCo's: legs, waist, arms, left before right."""

_ONLY_IN_29 = ("waist_roll_joint", "waist_pitch_joint", "wrist_pitch_joint", "wrist_yaw_joint")
G1_23 = tuple(name for name in G1.names if not name.endswith(_ONLY_IN_29))
"""The hinges, in order, of the G1 that has 23: without waist roll and pitch and without wrist pitch and yaw."""

LINKS = ("pelvis", *("torso_link" if n == "waist_pitch_joint" else n.removesuffix("joint") + "link" for n in G1.names))
"""The links of Unitree's models: the pelvis and what each hinge moves, in the hinges' order."""
LARGEST = 1e5
"""Metres and radians that no motion of a robot reaches."""
_ROUNDED = 1.5e-6


def g1_motion(
    root_positions: Positions, root_rotations: Rotations, angles: Array, fps: float, name: str = "", label: str = ""
) -> Motion:
    """A motion of the G1 from the numbers of a file, checked.

    Parameters
    ----------
    root_positions : (F, 3) metres.
    root_rotations : (F, 4) wxyz; brought to unit length where they are not, to the sixth digit.
    angles : (F, 29) radians, or (F, 23) of the G1 with 23 hinges; the six others are then zero.
    fps : frames per second.
    name : of the motion.
    label : the file, for messages.

    Raises
    ------
    FormatError
        If there are other joints, a number is not finite or beyond all measure, or a quaternion is not of length 1.
    """
    label = label or name or "the motion"
    if angles.shape[1:] == (len(G1_23),):
        angles, fewer = np.zeros((len(angles), len(G1.names))), angles
        angles[:, [G1.names.index(hinge) for hinge in G1_23]] = fewer
    if angles.shape[1:] != (len(G1.names),):
        raise FormatError(f"{label}: angles of shape {angles.shape}; the Unitree G1 has 29 joints (or 23)")
    for what, values in (("root position", root_positions), ("joint angle", angles)):
        with np.errstate(invalid="ignore"):
            good = (np.abs(values) < LARGEST).all(axis=1)
        if not good.all():
            raise FormatError(f"{label}: frame {int(np.argmin(good))} has a {what} that no robot can have")
    return hinge_motion(G1, root_positions, unit_quaternions(root_rotations, label), angles, fps, name)


def unit_quaternions(q: Rotations, label: str) -> Rotations:
    """Quaternions (F, 4) of unit length; a ``FormatError`` names the first frame where it is off by over a hundredth.

    What is one to six digits is left alone: it was rounded when it was written, and is to be written so again.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        length = np.sqrt(np.sum(q * q, axis=-1))
        bad = ~(np.abs(length - 1) < 0.01)
    if bad.any():
        frame = int(np.argmax(bad))
        raise FormatError(
            f"{label}: frame {frame} has a root quaternion of length {length[frame]:g}; 1 is expected "
            "(are the columns in another order, or the angles Euler's?)"
        )
    return np.where((np.abs(length - 1) > _ROUNDED)[:, None], rot.normalise(q), q)


def g1_angles(motion: Motion, what: str) -> Array:
    """The angles (F, 29) of a motion of the G1, for a file of the kind ``what``.

    Raises
    ------
    FormatError
        If it is not a motion of the G1.
    """
    try:
        return hinge_angles(G1, motion)
    except BodyError as error:
        raise FormatError(
            f"{what} can hold one robot's motion alone; {error}. Retarget it to that robot with a tool that keeps its "
            "hinges, as GMR (`--like` does not), or write .bvh, .glb or .npz"
        ) from None
