"""A drawn body as arrays: which capsule hangs on which joints, how thick, in which colour."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Ints, Positions
from onbeat.errors import BodyError
from onbeat.motion import Body, Motion, Skeleton
from onbeat.viewer.shape import Capsule, capsules

Colour = tuple[int, int, int]

DRESSED: Mapping[str, Colour] = {
    "head": (240, 190, 152),
    "torso": (238, 92, 66),
    "hips": (48, 72, 112),
    "left_arm": (238, 92, 66),
    "right_arm": (238, 92, 66),
    "left_hand": (240, 190, 152),
    "right_hand": (240, 190, 152),
    "left_leg": (48, 72, 112),
    "right_leg": (48, 72, 112),
    "left_foot": (246, 240, 230),
    "right_foot": (246, 240, 230),
}
"""sRGB colour of each group: a shirt, trousers and light shoes."""


@dataclass(frozen=True, eq=False)
class Figure:
    """N capsules hung on the joints of a skeleton.

    Parameters
    ----------
    joints : (N, 2) the joints whose line each capsule lies on.
    reach : (N, 2) where on that line it begins and ends, 0 at the first joint, 1 at the second.
    radii : (N, 2) metres.
    colours : (N, 3) sRGB, 0…255.
    adjacent : (N, N) true where two capsules share a joint or a group: there the skin runs smoothly from one to
        the other.
    """

    joints: Ints
    reach: Array
    radii: Array
    colours: Array
    adjacent: Bools

    @classmethod
    def of(cls, skeleton: Skeleton, palette: Mapping[str, Colour] = DRESSED) -> Figure:
        """The figure of a skeleton; plain bones where its joints' roles are not known.

        Examples
        --------
        >>> arm = Skeleton(("elbow", "wrist"), [-1, 0], [[0, 0, 0], [0.25, 0, 0]])
        >>> Figure.of(arm).joints.tolist()
        [[0, 1]]
        """
        try:
            body = Body.of(skeleton)
        except BodyError:
            body = None
        return cls.from_capsules(capsules(skeleton, body), palette)

    @classmethod
    def from_capsules(cls, shape: list[Capsule], palette: Mapping[str, Colour] = DRESSED) -> Figure:
        """A figure of any capsules."""
        joints = np.array([(c.joint_a, c.joint_b) for c in shape], np.int64).reshape(-1, 2)
        groups = np.array([c.group for c in shape])
        share = (joints[:, None, :, None] == joints[None, :, None, :]).any((2, 3))
        return cls(
            joints,
            np.array([(c.start, c.end) for c in shape], np.float64).reshape(-1, 2),
            np.array([(c.radius_a, c.radius_b) for c in shape], np.float64).reshape(-1, 2),
            np.array([palette[c.group] for c in shape], np.float64).reshape(-1, 3),
            share | (groups[:, None] == groups[None, :]),
        )

    def ends(self, positions: Positions) -> Positions:
        """(..., N, 2, 3) metres, both ends of each capsule, from joint positions (..., J, 3)."""
        a, b = positions[..., self.joints[:, 0], :], positions[..., self.joints[:, 1], :]
        return a[..., None, :] + self.reach[..., None] * (b - a)[..., None, :]

    def bounds(self, positions: Positions) -> tuple[Positions, Positions]:
        """Lowest and highest corner (..., 3) in metres of the box around the figure.

        Raises
        ------
        BodyError
            If there is nothing of it to see.
        """
        if not len(self.joints):
            raise BodyError("there is nothing of the body to draw: none of its bones has a length")
        ends = self.ends(positions)
        radii = self.radii[..., None]
        return (ends - radii).min((-3, -2)), (ends + radii).max((-3, -2))


def ground_height(figure: Figure, motion: Motion) -> float:
    """Metres: the height on which the figure stands.

    That of its soles where most of the motion has them low: so it neither hovers nor sinks where a capture's floor
    is a few centimetres off, and neither leaps nor a few bad frames move the floor.
    """
    step = max(1, round(motion.fps / 15))
    low, _ = figure.bounds(motion.positions[::step])
    return float(np.percentile(low[:, 2], 30))
