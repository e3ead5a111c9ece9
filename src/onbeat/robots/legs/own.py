"""Legs of a robot's own for a dance, after the task models of Nakaoka et al. 2005.

:func:`tasks` tells what the dancer's legs do; :func:`planted` dances with both feet where they are, :func:`stepping`
with the dancer's steps. What the upper body does is kept, joint by joint; the root is kept as far as the legs allow.
"""

from __future__ import annotations

from onbeat.robots.legs.contacts import Danced
from onbeat.robots.legs.planted import planted
from onbeat.robots.legs.stepping import stepping
from onbeat.robots.legs.tasks import Task, tasks

__all__ = ["Danced", "Task", "planted", "stepping", "tasks"]
