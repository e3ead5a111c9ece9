"""The dancers' bodies: one tree of joints, proportions after Drillis and Contini (1966), scaled and varied."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

from onbeat.motion.skeleton import Skeleton

CENTRE = ("Hips", "Spine", "Chest", "Neck", "Head", "HeadEnd")
ARM = ("Shoulder", "Arm", "ForeArm", "Hand", "HandEnd")
LEG = ("UpLeg", "Leg", "Foot", "ToeBase", "ToeEnd")
NAMES = (*CENTRE, *(side + name for side in ("Left", "Right") for name in (*ARM, *LEG)))


def _parent_names() -> dict[str, str]:
    above = {below: upper for upper, below in pairwise(CENTRE)}
    for side in ("Left", "Right"):
        above |= {side + below: side + upper for chain in (ARM, LEG) for upper, below in pairwise(chain)}
        above |= {side + "Shoulder": "Chest", side + "UpLeg": "Hips"}
    return above


PARENTS = (-1, *(NAMES.index(_parent_names()[name]) for name in NAMES[1:]))


@dataclass(frozen=True)
class Build:
    """What of a body's size differs from person to person.

    Parameters
    ----------
    height : metres, 1.50–1.90.
    legs, arms, shoulders, hips : length of legs and arms, width of shoulders and hips, 1 for the average.
    """

    height: float
    legs: float = 1.0
    arms: float = 1.0
    shoulders: float = 1.0
    hips: float = 1.0

    @property
    def upper_arm(self) -> float:
        """Metres from shoulder to elbow."""
        return 0.176 * self.height * self.arms

    @property
    def forearm(self) -> float:
        """Metres from elbow to wrist."""
        return 0.148 * self.height * self.arms

    @property
    def shoulder_half_width(self) -> float:
        """Metres from the centre line to the shoulder joint."""
        return 0.108 * self.height * self.shoulders

    @property
    def thigh(self) -> float:
        """Metres from hip to knee."""
        return 0.243 * self.height * self.legs

    @property
    def shin(self) -> float:
        """Metres from knee to ankle."""
        return 0.243 * self.height * self.legs

    @property
    def leg(self) -> float:
        """Metres from hip to ankle."""
        return self.thigh + self.shin

    @property
    def hip_half_width(self) -> float:
        """Metres from the centre line to the hip joint."""
        return 0.052 * self.height * self.hips

    @property
    def hip_drop(self) -> float:
        """Metres from the waist joint down to the hip joints."""
        return 0.02 * self.height

    @property
    def ankle_height(self) -> float:
        """Metres from the floor to the ankle of a flat foot."""
        return 0.042 * self.height

    @property
    def ball_height(self) -> float:
        """Metres from the floor to the joint of the toes of a flat foot."""
        return 0.012 * self.height

    @property
    def ball_forward(self) -> float:
        """Metres from the ankle forward to the joint of the toes."""
        return 0.078 * self.height

    @property
    def heel_back(self) -> float:
        """Metres from the ankle back to the heel."""
        return 0.03 * self.height

    @cached_property
    def skeleton(self) -> Skeleton:
        """The skeleton at rest: standing with arms out to the sides, palms down, facing +Y."""
        trunk = self.height - self.hip_drop - self.leg - self.ankle_height  # waist to crown
        at: dict[str, tuple[float, float, float]] = {
            "Hips": (0, 0, 0),
            "Spine": (0, -0.012 * self.height, 0.125 * trunk),
            "Chest": (0, 0.004 * self.height, 0.225 * trunk),
            "Neck": (0, 0.0, 0.290 * trunk),
            "Head": (0, 0.012 * self.height, 0.115 * trunk),
            "HeadEnd": (0, 0.0, 0.245 * trunk),
        }
        for side, sign in (("Left", -1.0), ("Right", 1.0)):
            arm = ((0.2, 0.225 * trunk), (0.8, 0.0))
            for name, (share, up) in zip(ARM[:2], arm, strict=True):
                at[side + name] = (sign * share * self.shoulder_half_width, 0.0, up)
            at[side + "ForeArm"] = (sign * self.upper_arm, 0.0, 0.0)
            at[side + "Hand"] = (sign * self.forearm, 0.0, 0.0)
            at[side + "HandEnd"] = (sign * 0.1 * self.height, 0.0, 0.0)
            at[side + "UpLeg"] = (sign * self.hip_half_width, 0.0, -self.hip_drop)
            at[side + "Leg"] = (0.0, 0.0, -self.thigh)
            at[side + "Foot"] = (0.0, 0.0, -self.shin)
            at[side + "ToeBase"] = (0.0, self.ball_forward, self.ball_height - self.ankle_height)
            at[side + "ToeEnd"] = (0.0, 0.042 * self.height, -0.5 * self.ball_height)
        return Skeleton(NAMES, PARENTS, [at[name] for name in NAMES], [name.endswith("End") for name in NAMES])
