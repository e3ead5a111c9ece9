"""A body's joints as markers, so that a motion can be written where only points are."""

from __future__ import annotations

from onbeat.motion.marker_labels import safe_labels
from onbeat.motion.markers import Markers
from onbeat.motion.motion import Motion


def joint_markers(motion: Motion) -> Markers:
    """The position of every joint as a marker; names become labels that every program reads.

    Returns
    -------
    As many markers as there are joints, End Sites among them, in their order: metres, Z up, seen in every frame.

    Examples
    --------
    >>> import numpy as np
    >>> from onbeat.motion import Skeleton
    >>> body = Skeleton(("hips", "left knee"), [-1, 0], [[0, 0, 0], [0, 0, -0.4]])
    >>> motion = Motion(body, np.tile([1.0, 0, 0, 0], (2, 2, 1)), np.ones((2, 3)), fps=30)
    >>> joints = joint_markers(motion)
    >>> joints.names, joints.positions[0, 1].tolist()
    (('hips', 'left_knee'), [1.0, 1.0, 0.6])
    """
    return Markers(safe_labels(motion.skeleton.names), motion.positions, motion.fps, motion.name)
