"""From points back to a motion that plays: joint rotations on the person's own skeleton, bones of their own length.

Rebuilt points are no body: their bones stretch. Each joint is turned so that what hangs on it points to where the
points below it are; how it twists about its bone, which points do not tell, is as near as can be to the original's.
Hips, and all above them, stay on the original's path.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Ints, Positions, Rotations
from onbeat.errors import MetricError
from onbeat.keyposes.vectors import PoseVectors
from onbeat.motion import rotations as rot
from onbeat.motion.kinematics import local_rotations
from onbeat.motion.motion import Motion
from onbeat.motion.skeleton import Skeleton
from onbeat.motion.tree import ancestors

_KEPT = 1e-6  # how much the original's rotation counts beside the points: only where they leave it open


def playable(values: Array, vectors: PoseVectors, original: Motion, name: str = "") -> Motion:
    """The motion whose poses are nearest to the pose vectors (F, 3N), frame by frame in place of ``original``'s.

    For a joint with points c below it, of which the original has ``o_c`` in the joint's frame, its rotation is
    ``argmin_R Σ_c ‖d_c − R o_c‖²`` with ``d_c`` from the joint's point to c's (Wahba's problem, by singular value
    decomposition). Joints between points keep the original's rotation in their parent's frame.

    Parameters
    ----------
    values : (F, 3N) rebuilt poses.
    vectors : the original's poses, which give the points and the body-centre frame.
    original : the motion they are of.
    name : of the new motion.

    Raises
    ------
    MetricError
        If the poses are not as many as the original's.

    Examples
    --------
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.folk_dance import FOLK_DANCE
    >>> from onbeat.examples.performer import perform
    >>> from onbeat.keyposes.vectors import pose_vectors
    >>> dance = perform(DANCERS[0], [FOLK_DANCE], 1.0, 1, np.random.default_rng(0)).motion
    >>> (own,) = pose_vectors([dance])
    >>> again = playable(own.values, own, dance)
    >>> bool(np.abs(again.positions - dance.positions).max() < 1e-4)  # its own points give the motion back
    True
    """
    if len(original) != len(vectors):
        raise MetricError(f"{len(vectors)} poses are not those of {original.name!r}, which has {len(original)} frames")
    targets = vectors.world(values)
    skeleton = original.skeleton
    at = {int(joint): point for point, joint in reversed(list(enumerate(vectors.joints.tolist())))}
    hips = int(vectors.joints[vectors.points.index("hips")])
    still = {joint for joint in ancestors(skeleton, hips) if joint != hips}
    world = np.array(original.world_rotations)
    for joint in range(len(skeleton)):
        if joint in still:
            continue
        above = int(skeleton.parents[joint])
        if above >= 0:
            world[:, joint] = rot.multiply(world[:, above], original.rotations[:, joint])
        below = [at[child] for child in points_below(skeleton, joint, at)] if joint in at else []
        if below:
            held = original.positions[:, vectors.joints[below]] - original.positions[:, [joint]]
            held = rot.rotate(rot.inverse(original.world_rotations[:, joint])[:, None], held)
            wanted = targets[:, below] - targets[:, [at[joint]]]
            world[:, joint] = nearest_rotation(held, wanted, world[:, joint])
    local = rot.continuous(rot.normalise(local_rotations(skeleton, world)))
    return original.replace(rotations=local, name=name or original.name)


def points_below(skeleton: Skeleton, joint: int, points: dict[int, int] | set[int]) -> list[int]:
    """The first joints with a point on each way down from a joint."""
    found: list[int] = []
    stack = list(skeleton.children[joint])
    while stack:
        child = stack.pop()
        if child in points:
            found.append(child)
        else:
            stack += skeleton.children[child]
    return sorted(found)


def nearest_rotation(held: Positions, wanted: Positions, usual: Rotations) -> Rotations:
    """(F, 4) the rotations that bring vectors ``held`` (F, C, 3) nearest to ``wanted``; ``usual`` where that is open.

    Each vector counts by its length in both. Vectors along one line leave the turn about it open, and none leave all.

    Examples
    --------
    >>> x, y = np.eye(3)[None, :1], np.eye(3)[None, 1:2]
    >>> nearest_rotation(x, y, rot.IDENTITY[None]).round(4).tolist()  # a quarter turn about z, no twist
    [[0.7071, 0.0, 0.0, 0.7071]]
    """
    if held.shape[1] == 1:
        return rot.multiply(rot.between(rot.rotate(usual, held[:, 0]), wanted[:, 0]), usual)
    spread = np.einsum("fci,fcj->fij", wanted, held)
    size = np.linalg.norm(spread, axis=(1, 2), keepdims=True)
    sum_ = spread / np.maximum(size, 1e-12) + _KEPT * rot.to_matrix(usual)
    left, _, right = np.linalg.svd(sum_)
    left[:, :, 2] *= np.linalg.det(left @ right)[:, None]
    return rot.from_matrix(left @ right)


def bone_ends(skeleton: Skeleton, joints: Ints) -> Ints:
    """(B, 2) the bones between points, as numbers of points: of each but the first, the nearest point above it."""
    at = {int(joint): point for point, joint in reversed(list(enumerate(joints.tolist())))}
    pairs = ((at[joint], at[child]) for joint in at for child in points_below(skeleton, joint, at))
    return np.array(sorted(pairs), np.int64).reshape(-1, 2)
