"""The job of a dance at another speed or on a robot: made anew from the character's dance at the song's own speed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from onbeat._shapes import Times
from onbeat.dance.document import DanceDocument
from onbeat.limits.learned import learned_limits
from onbeat.metrics.beats import f_measure
from onbeat.motion import Motion
from onbeat.motion.features import hand_features
from onbeat.retime.document import RetimeDocument, retime_document
from onbeat.retime.lock import TimeMap
from onbeat.retime.retime import retime
from onbeat.retime.sources import source_of
from onbeat.studio.dance_folder import (
    ROOT,
    SHOWN,
    StoredDance,
    faster_document,
    faster_song,
    graph_of,
    write_scene,
)
from onbeat.studio.dance_stages import stages_of_again
from onbeat.studio.tasks import Done, RetimeTask
from onbeat.studio.telling import Tell
from onbeat.viewer.contract import GraphData, MoveData, PageData
from onbeat.viewer.pages.content import page_data
from onbeat.viewer.pages.metric_words import told
from onbeat.viewer.pages.robot import robot_page_data

ON_BEAT = 0.05
"""Seconds within which a stop is on its beat."""


def retimed(task: RetimeTask, tell: Tell) -> Done:
    """The dance of a folder at another speed, or on a robot."""
    root = StoredDance.read(Path(task.folder), ROOT)
    root.write(Path(task.out), ROOT)
    return again_as(task, root, graph_of(Path(task.folder)), tell.of(stages_of_again(task.robot)))


def again_as(task: RetimeTask, root: StoredDance, graph: GraphData | None, tell: Tell) -> Done:
    """Make what a task asks for of a dance that is its root; the root itself is written already.

    It goes through the same motion graph as its root, by the same clips and joins.
    """
    out, song = Path(task.out), faster_song(root.song, task.speed)
    made = _on_robot if task.robot is not None else _faster
    motion, metrics, page, note = made(task, root, tell)
    stops = _stops(motion)
    document = faster_document(root.document, task.speed, motion.duration, stops.round(4).tolist())
    f50 = f_measure(stops, song.beats[song.beats < motion.duration], ON_BEAT)
    metrics = {"beats": {"f50": round(f50, 4)}} | metrics
    document = msgspec.structs.replace(document, metrics=metrics)
    stored = StoredDance(motion, document, song)
    stored.write(out, SHOWN)
    if page is None:
        page = page_data(motion, song, msgspec.to_builtins(document), None, stored.keyposes)
    write_scene(out, msgspec.structs.replace(_with_moves(page, document), graph=graph, metrics=told(metrics)))
    return Done(seconds=motion.duration, tempo=song.tempo, f50=f50, note=note)


def _with_moves(page: PageData, document: DanceDocument) -> PageData:
    """With the stops and the clips of the dance, where the page has none of its own."""
    if page.moves:
        return page
    moves = [MoveData(move.clip, move.from_s, move.to_s, move.at_s) for move in document.moves]
    joins = [move.at_s for move in moves[1:]]
    return msgspec.structs.replace(page, stops=document.stops, moves=moves, joins=joins)


def _stops(motion: Motion) -> Times:
    """When the hands come to rest, on the finished motion."""
    return hand_features(motion).body_stops


Made = tuple[Motion, dict[str, Any], PageData | None, str]


def _faster(task: RetimeTask, root: StoredDance, tell: Tell) -> Made:
    """A character: inside the speeds that its joints have in the dance itself."""
    keyposes = root.keyposes
    times = np.zeros(0) if keyposes is None else np.asarray(keyposes.times)
    limits = learned_limits([root.motion], skeleton=root.motion.skeleton)
    result = retime(
        source_of(root.motion), TimeMap.steady(task.speed), limits, root.song.beats, times,
        progress=lambda share: tell("retiming", share),
    )  # fmt: skip
    assert isinstance(result.dance, Motion)
    document = retime_document(result)
    return result.dance.replace(name=task.name), _retime_metrics(document), None, _retime_note(document)


def _retime_metrics(document: RetimeDocument) -> dict[str, Any]:
    return {
        "retime": {
            "speed": document.speed,
            "rms_deg": document.rms_deg,
            "keypose_error_deg": document.keypose_error_deg,
            "keyposes_missed": len(document.missed),
            "peak_acceleration": document.peak_acceleration,
        }
    }


def _retime_note(document: RetimeDocument) -> str:
    if document.feasible:
        return ""
    would = document.speed_that_would_do
    at = "" if would is None else f"; at {would:.2f} × the beat of the dance itself all would be"
    return f"{len(document.missed)} keyposes of joints are not reached in time{at}"


def _on_robot(task: RetimeTask, root: StoredDance, tell: Tell) -> Made:
    """A robot: retargeted, inside its limits, balanced, both feet planted."""
    from onbeat.robots.document import robot_document
    from onbeat.robots.model import robot_named
    from onbeat.robots.perform import stage

    assert task.robot is not None
    model = robot_named(task.robot)
    found = root.keyposes
    keyposes = np.zeros(0) if found is None else np.asarray(found.times)
    warp = TimeMap.steady(task.speed)
    staged = stage(root.motion, model, warp, root.song.beats, keyposes, progress=lambda what, share: tell(what, share))
    document = robot_document(model, staged, None, "planted")
    metrics: dict[str, Any] = {
        "robot": {
            "name": model.name,
            "speed": document.speed,
            "balance_inside": document.zmp.inside,
            "balance_worst_mm": document.zmp.worst_mm,
            "joints_past_position_limits": document.violations.position,
            "joints_past_speed_limits": document.violations.velocity,
        }
    }
    dancer = root.motion.at(np.clip(warp(staged.start + staged.motion.times), 0.0, root.motion.duration))
    motion = staged.motion.replace(name=task.name)
    page = robot_page_data(
        dancer.replace(fps=motion.fps), motion, faster_song(root.song, task.speed), None, staged.beats - staged.start,
        staged.retimed.measures.keyposes - staged.start, task.name, metrics, model=model,
    )  # fmt: skip
    return motion, metrics, page, "" if document.zmp.inside >= 1 else _balance_note(document.zmp.inside)


def _balance_note(inside: float) -> str:
    return f"its balance point is inside its soles {inside:.1%} of the time only"
