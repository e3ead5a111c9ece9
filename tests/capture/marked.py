"""A person who dances with 41 markers on, so that what a fit should find is known."""

from __future__ import annotations

import numpy as np

from onbeat.motion import Markers, Motion, Skeleton
from onbeat.motion import rotations as rot
from persons import person

_MIDDLE = {
    "C7": ("Chest", (0, -0.08, 0.25)),
    "T10": ("Chest", (0, -0.115, 0.02)),
    "CLAV": ("Chest", (0, 0.07, 0.20)),
    "STRN": ("Chest", (0.0, 0.12, 0.05)),
    "RBAC": ("Chest", (0.10, -0.12, 0.13)),
}
_SIDE = {
    "FHD": ("Head", (0.08, 0.09, 0.10)),
    "BHD": ("Head", (0.07, -0.08, 0.09)),
    "SHO": ("Collar", (0.143, 0.0, 0.065)),
    "UPA": ("Shoulder", (0.13, -0.03, 0.05)),
    "ELB": ("Shoulder", (0.292, -0.002, 0.045)),
    "FRM": ("Elbow", (0.11, 0.01, 0.045)),
    "WRA": ("Elbow", (0.247, 0.033, 0.014)),
    "WRB": ("Elbow", (0.252, -0.036, 0.013)),
    "FIN": ("Wrist", (0.08, 0.005, 0.022)),
    "FWT": ("Hips", (0.14, 0.066, 0.033)),
    "BWT": ("Hips", (0.05, -0.09, 0.06)),
    "THI": ("Hip", (0.09, 0.01, -0.22)),
    "KNE": ("Hip", (0.056, 0.003, -0.42)),
    "SHN": ("Knee", (0.04, 0.03, -0.22)),
    "ANK": ("Knee", (0.041, -0.016, -0.418)),
    "HEE": ("Ankle", (0.0, -0.055, -0.04)),
    "TOE": ("Ankle", (0.0, 0.12, -0.045)),
    "MT5": ("Ankle", (0.048, 0.09, -0.052)),
}
JOINTS = {
    "Hips": "Hips",
    "Neck": "Neck",
    "Arm": "Shoulder",
    "ForeArm": "Elbow",
    "Hand": "Wrist",
    "UpLeg": "Hip",
    "Leg": "Knee",
    "Foot": "Ankle",
}
"""What the fitted joints are called on the person."""


def dancing(seconds: float = 3.0, fps: float = 60.0, skeleton: Skeleton | None = None) -> Motion:
    """A person whose arms and legs swing and bend as elbows and knees do, while walking and turning."""
    skeleton = skeleton or person()
    t = np.arange(round(seconds * fps)) / fps
    rotations = np.tile(rot.IDENTITY, (len(t), len(skeleton), 1))

    def turn(name: str, vector: np.ndarray) -> None:
        joint = skeleton.index(name)
        rotations[:, joint] = rot.multiply(rot.exp(vector), rotations[:, joint])

    def wave(rate: float, phase: float) -> np.ndarray:
        return np.sin(2 * np.pi * (rate * t + phase))[:, None]

    x, y, z = np.eye(3)
    turn("Hips", 0.5 * t[:, None] * z + 0.1 * wave(0.5, 0.1) * x)
    turn("Spine", 0.15 * wave(0.6, 0) * x + 0.1 * wave(0.4, 0.3) * z)
    turn("Chest", 0.15 * wave(0.6, 0) * x + 0.1 * wave(0.4, 0.3) * z)
    turn("Neck", 0.15 * wave(0.7, 0.6) * x)
    turn("Head", 0.15 * wave(0.5, 0.2) * z)
    for side, sign, phase in (("Left", -1.0, 0.0), ("Right", 1.0, 0.5)):
        turn(f"{side}Elbow", sign * (0.8 + 0.7 * wave(1.1, phase)) * z)
        turn(f"{side}Shoulder", sign * (0.7 + 0.6 * wave(0.8, phase)) * y + 0.4 * wave(0.6, phase) * z)
        turn(f"{side}Wrist", 0.2 * wave(1.3, phase) * z)
        turn(f"{side}Hip", (0.3 + 0.4 * wave(1.0, phase)) * x + sign * 0.15 * wave(0.5, phase) * y)
        turn(f"{side}Knee", -(0.6 + 0.5 * wave(1.0, phase + 0.2)) * x)
        turn(f"{side}Ankle", 0.2 * wave(1.0, phase + 0.4) * x)
    root = np.column_stack((0.3 * t, 0.5 * np.sin(t), 0.93 + 0.03 * np.sin(6 * t)))
    return Motion(skeleton, rotations, root, fps, "dancing")


def marked(motion: Motion, noise_m: float = 0.0, seed: int = 0, size: float = 1.0) -> Markers:
    """The 41 markers of a dancing person, each off by ``noise_m`` along each axis."""
    rows = {label: (joint, np.array(at, float)) for label, (joint, at) in _MIDDLE.items()}
    for initial, side, sign in (("L", "Left", -1.0), ("R", "Right", 1.0)):
        for label, (joint, (x, y, z)) in _SIDE.items():
            rows[initial + label] = (joint if joint in ("Hips", "Head") else side + joint, np.array([sign * x, y, z]))
    skeleton = motion.skeleton
    joints = [skeleton.index(joint) for joint, _ in rows.values()]
    places = np.array([at for _, at in rows.values()]) * size
    positions = motion.positions[:, joints] + rot.rotate(motion.world_rotations[:, joints], places)
    positions = positions + np.random.default_rng(seed).normal(scale=noise_m, size=positions.shape)
    return Markers(tuple(rows), positions, motion.fps, "marked")


def hidden(markers: Markers, label: str, first_s: float, end_s: float) -> Markers:
    """The same markers, one of them unseen for a while."""
    positions = markers.positions.copy()
    positions[round(first_s * markers.fps) : round(end_s * markers.fps), markers.index(label)] = np.nan
    return Markers(markers.names, positions, markers.fps, markers.name)


def joint_errors(fitted: Motion, truth: Motion) -> dict[str, np.ndarray]:
    """(F,) metres between the fitted joints and the true ones, by the fitted joint."""
    found: dict[str, np.ndarray] = {}
    for name in fitted.skeleton.names:
        side = next((side for side in ("Left", "Right") if name.startswith(side)), "")
        if name.removeprefix(side) in JOINTS:
            there = truth.positions[:, truth.skeleton.index(side + JOINTS[name.removeprefix(side)])]
            found[name] = np.linalg.norm(fitted.positions[:, fitted.skeleton.index(name)] - there, axis=1)
    return found
