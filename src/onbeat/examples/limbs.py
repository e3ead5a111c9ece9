"""Two-bone arms and legs in closed form, on all frames at once.

Each limb is a direction from its root to its end, a reach, and a swivel of the plane it bends in. The plane is carried
from a known pose to the wanted direction by the smallest rotation, so that elbows and knees never flip.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Positions, Rotations
from onbeat.motion import rotations as rot

ARM_REST = np.array([0.46, 0.74, -0.49]) / np.linalg.norm([0.46, 0.74, -0.49])
"""Where the right arm is easiest: out, to the front, a little down. Directions are measured from here."""
_OUT = np.array([ARM_REST[1], -ARM_REST[0], 0.0]) / np.hypot(ARM_REST[0], ARM_REST[1])
_UP = np.cross(_OUT, ARM_REST)


def _arm_rest_rotation() -> Rotations:
    """The right upper arm along ``ARM_REST`` with its elbow hanging: x along the bone, z the axis of the elbow."""
    elbow = np.array([0.35, -0.35, -0.9])
    elbow -= ARM_REST * (elbow @ ARM_REST)
    elbow /= np.linalg.norm(elbow)
    return rot.from_matrix(np.stack((ARM_REST, -elbow, np.cross(elbow, ARM_REST)), axis=-1))


_ARM_REST_ROTATION = _arm_rest_rotation()


def turn_x(angle: Array) -> Rotations:
    """Rotations about the x axis by ``angle`` (F,) radians."""
    zero = np.zeros_like(angle)
    return np.stack((np.cos(angle / 2), np.sin(angle / 2), zero, zero), axis=-1)


def turn_z(angle: Array) -> Rotations:
    """Rotations about the z axis by ``angle`` (F,) radians."""
    return rot.yaw(angle)


def bend(upper: float, lower: float, distance: Array) -> tuple[Array, Array]:
    """Angles of a two-bone limb whose ends are ``distance`` (F,) apart, by the law of cosines.

    Returns
    -------
    The angle between the upper bone and the line from end to end, and the angle by which the middle joint is bent
    (0 when straight), (F,) radians.
    """
    cosine = (upper**2 + distance**2 - lower**2) / (2 * upper * distance)
    flexion = (distance**2 - upper**2 - lower**2) / (2 * upper * lower)
    return np.arccos(np.clip(cosine, -1, 1)), np.arccos(np.clip(flexion, -1, 1))


def arm_direction(place: Array) -> Array:
    """A place (out, front, up) as arc coordinates (2,) in radians about ``ARM_REST``: outward and upward."""
    unit = place / np.linalg.norm(place)
    angle = np.arccos(np.clip(unit @ ARM_REST, -1, 1))
    across = unit - ARM_REST * (unit @ ARM_REST)
    across = across / max(float(np.linalg.norm(across)), 1e-9)
    return angle * np.array([across @ _OUT, across @ _UP])


def arm_rotations(arcs: Array, reach: Array, swivel: Array, bones: tuple[float, float]) -> tuple[Rotations, Rotations]:
    """The right arm's rotations: of the upper arm in the chest's frame and of the forearm in the upper arm's.

    Parameters
    ----------
    arcs : (F, 2) radians from ``ARM_REST``, outward and upward: a straight line here is an arc about the shoulder.
    reach : (F,) distance from shoulder to wrist, a share of the arm's length.
    swivel : (F,) radians by which the elbow is turned outward about the line from shoulder to wrist.
    bones : metres of upper arm and forearm.
    """
    lift, flexion = bend(*bones, np.clip(reach, 0.3, 0.985) * (bones[0] + bones[1]))
    axis = arcs[:, 1:] * _OUT - arcs[:, :1] * _UP  # ARM_REST × (outward _OUT + upward _UP)
    carried = rot.multiply(rot.exp(axis), _ARM_REST_ROTATION)
    upper = rot.multiply(rot.multiply(carried, turn_x(-swivel)), turn_z(-lift))
    return upper, turn_z(flexion)


def leg_rotations(hip_to_ankle: Positions, heading: Array, bones: tuple[float, float]) -> tuple[Rotations, Rotations]:
    """A leg's rotations: of the thigh in the world and of the shin in the thigh's frame; the knee bends to the front.

    Parameters
    ----------
    hip_to_ankle : (F, 3) metres in the world.
    heading : (F,) radians, yaw in which the knee points.
    bones : metres of thigh and shin.
    """
    distance = np.linalg.norm(hip_to_ankle, axis=-1)
    lift, flexion = bend(*bones, np.clip(distance, 0.35 * sum(bones), 0.9999 * sum(bones)))
    unit = hip_to_ankle / distance[:, None]
    x = np.cos(heading) * unit[:, 0] + np.sin(heading) * unit[:, 1]
    y = np.cos(heading) * unit[:, 1] - np.sin(heading) * unit[:, 0]
    # The smallest rotation from straight down to (x, y, z): 1 + cos, and down × (x, y, z).
    carried = rot.normalise(np.stack((1.0 - unit[:, 2], y, -x, np.zeros_like(x)), axis=-1))
    thigh = rot.multiply(rot.multiply(rot.yaw(heading), carried), turn_x(lift))
    return thigh, turn_x(-flexion)


def mirrored(q: Rotations) -> Rotations:
    """The rotation seen in a mirror across the body's middle plane (x → −x)."""
    return q * np.array([1.0, 1.0, -1.0, -1.0])
