"""The clips that a plan shows, so that no other clip of a library is read."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from onbeat.dance.plan import DancePlan
from onbeat.moves.graph import MotionGraph
from onbeat.moves.library import MoveLibrary


def shown(library: MoveLibrary, plan: DancePlan) -> tuple[MoveLibrary, DancePlan]:
    """The clips that a plan shows as a library without joins, and the plan over them."""
    used = sorted({move.clip for move in plan.moves})
    place = {clip: k for k, clip in enumerate(used)}
    nothing = MotionGraph(np.zeros(0, np.int64), np.zeros(1, np.int64), np.zeros(0, np.int64), np.zeros(0, np.float32))
    moves = tuple(replace(move, clip=place[move.clip]) for move in plan.moves)
    return MoveLibrary(tuple(library.clips[clip] for clip in used), nothing), DancePlan(moves, plan.duration)
