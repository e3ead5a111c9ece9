"""Pose vectors: what two frames must share for a dancer to go from one to the other.

Shiratori et al. 2006 compare frames by link directions and their velocities (Eq. 9). Taken literally, as a dot product,
fast frames are like everything; so frames are compared here by the squared distance of the same quantities, which is
still one matrix product: ``|a − b|² = |a|² + |b|² − 2 a·b``. Link directions in the body-centre frame hide height, lean
and where the body is going, so these are added, and the feet on the ground.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array, Float32
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body, body_frames, facing
from onbeat.motion.contacts import foot_contacts
from onbeat.motion.links import LINKS, link_directions
from onbeat.motion.motion import Motion

VELOCITY = 0.10  # s; √α of Eq. 9: a link turning 1 rad/s differently counts as much as one pointing 0.1 rad elsewhere
HEIGHT = 2.0  # [1/m]; 0.1 m of waist height counts as much as 0.2 rad in all links
LEAN = 1.0  # [1]; the up vector of the body-centre frame
TRAVEL = 0.25  # s/m; the waist's velocity, seen from the body
TURN = 0.10  # s; the body's turning about the vertical
CONTACT = 0.30  # [1]; a foot on the ground in one pose and in the air in the other
# Hands and feet hang at the end of what is compared already; the middle of the body moves everything.
WEIGHTS = {"trunk": 0.0, "hand": 0.5, "collar": 0.7, "foot": 0.8, "pelvis": 1.0, "head": 0.7}
DIRECTIONS, VELOCITIES = slice(0, 3 * len(LINKS)), slice(3 * len(LINKS), 6 * len(LINKS))
"""Columns of pose vectors: x, y, z of each link's direction, then of its velocity."""


def link_weights() -> Array:
    """(17,) weights of the links, with mean square 1, so that the distance of links alone is an r.m.s. chord."""
    weights = np.array([WEIGHTS.get(name.removeprefix("left_").removeprefix("right_"), 1.0) for name in LINKS])
    return weights / np.sqrt(np.mean(weights**2))


def pose_vectors(motion: Motion, body: Body | None = None) -> Float32:
    """(F, D) float32; the distance of two rows is about the r.m.s. angle in radians between two moving poses.

    Rows hold the 17 link directions and their velocities in the body-centre frame, waist height, lean, travel, turning
    and the feet's contacts, each in the units given at the top of this file.
    """
    body = Body.of(motion.skeleton) if body is None else body
    frames, waist = body_frames(motion, body)
    links = link_directions(motion, body) * (link_weights() / np.sqrt(len(LINKS)))[:, None]
    flat = links.reshape(len(motion), -1)
    heading = facing(frames)
    travel = rot.rotate(rot.yaw(-heading), _rate(waist, motion.fps))
    lean = rot.rotate(rot.yaw(-heading), rot.rotate(frames, np.array([0.0, 0.0, 1.0])))
    turn = _rate(np.unwrap(heading)[:, None], motion.fps)
    contact = gaussian_filter1d(foot_contacts(motion, body).feet.astype(np.float64), 0.05 * motion.fps, axis=0)
    columns = (
        flat,
        VELOCITY * _rate(flat, motion.fps),
        HEIGHT * waist[:, 2:],
        LEAN * lean,
        TRAVEL * travel,
        TURN * turn,
        CONTACT * contact,
    )
    return np.hstack(columns).astype(np.float32)


def _rate(values: Array, fps: float, smoothing: float = 0.033) -> Array:
    """Change per second of values (F, ...), smoothed by a Gaussian of ``smoothing`` seconds."""
    if len(values) < 2:
        return np.zeros_like(values)
    return np.gradient(gaussian_filter1d(values, smoothing * fps, axis=0, mode="nearest"), axis=0) * fps
