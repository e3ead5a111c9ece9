"""Feet of a live dance do not sink into the floor: the press of :mod:`onbeat.motion.soles`, made ready for one body.

Poses come ten at a time and seldom have a foot too deep. Where they have, only those poses are pressed, and of the body
only its legs are looked at: what they are is found once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Ints, Positions, Rotations
from onbeat.motion.body import Body
from onbeat.motion.contacts import SIDES
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.skeleton import Skeleton
from onbeat.motion.soles import FREE, on_soles
from onbeat.motion.tree import Tree, ancestors


@dataclass(frozen=True, eq=False)
class Soles:
    """The legs of a body, and the joints of its feet.

    Parameters
    ----------
    legs : (L,) joints of the legs and of all that carries them, parents before their children.
    body : those joints alone.
    feet : (K,) joints from the ankles on, among all of the skeleton.

    Examples
    --------
    >>> from onbeat.examples.body import Build
    >>> skeleton = Build(1.7).skeleton
    >>> soles = Soles.of(Body.of(skeleton))
    >>> rest = np.tile([1.0, 0.0, 0.0, 0.0], (1, len(skeleton), 1))
    >>> sunk = np.array([[0.0, 0.0, -0.1 - skeleton.rest_positions[:, 2].min()]])
    >>> places = forward_kinematics(skeleton, rest, sunk)[1]
    >>> [float(shown[..., 2].min().round(3)) for shown in (places, soles.pressed(rest, sunk, places)[1])]
    [-0.1, -0.025]
    """

    legs: Ints
    body: Body
    feet: Ints

    @classmethod
    def of(cls, body: Body) -> Soles:
        """What is to be known of a body whose hips and ankles are known."""
        skeleton, tree = body.skeleton, Tree.of(body.skeleton)
        hips, ankles = (body.indices(*(f"{side}_{role}" for side in SIDES)).tolist() for role in ("hip", "ankle"))
        carrying = {above for hip in hips for above in ancestors(skeleton, hip)}
        hanging = [joint for joint in range(len(skeleton)) if any(tree.above(hip, joint) for hip in hips)]
        legs = sorted(carrying.union(hanging))
        feet = [joint for joint in hanging if joint in ankles or any(tree.above(ankle, joint) for ankle in ankles)]
        place = {joint: number for number, joint in enumerate(legs)} | {-1: -1}
        alone = Skeleton(
            [skeleton.names[joint] for joint in legs],
            [place[int(skeleton.parents[joint])] for joint in legs],
            skeleton.offsets[legs],
        )
        roles = {role: place[joint] for role, joint in body.joints.items() if joint in place}
        return cls(np.array(legs, np.int64), Body(alone, roles), np.array(feet, np.int64))

    def pressed(self, rotations: Rotations, roots: Positions, positions: Positions) -> tuple[Rotations, Positions]:
        """The same poses with feet that are not too deep under the floor at z = 0; those above it to the bit.

        Parameters
        ----------
        rotations : (F, J, 4) wxyz, local.
        roots : (F, 3) metres.
        positions : (F, J, 3) metres, where these put the joints.

        Returns
        -------
        (F, J, 4) rotations and (F, J, 3) positions of the joints.
        """
        deep = np.flatnonzero((positions[:, self.feet, 2] < -FREE).any(axis=1))
        if not len(deep):
            return rotations, positions
        lifted = on_soles(self.body, rotations[deep][:, self.legs], roots[deep])
        rotations, positions = rotations.copy(), positions.copy()
        cells = np.ix_(deep, self.legs)
        rotations[cells] = lifted
        positions[cells] = forward_kinematics(self.body.skeleton, lifted, roots[deep])[1]
        return rotations, positions
