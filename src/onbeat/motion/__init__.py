"""Skeletons, motions and what can be read off a moving body."""

from onbeat.motion.body import Body, body_frames
from onbeat.motion.markers import Markers
from onbeat.motion.motion import Motion
from onbeat.motion.skeleton import Skeleton

__all__ = ["Body", "Markers", "Motion", "Skeleton", "body_frames"]
