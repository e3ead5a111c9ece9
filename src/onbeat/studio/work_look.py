"""The job of motion files: each read, looked at, and made a scene that the page plays."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path

import msgspec
import numpy as np

from onbeat._shapes import Times
from onbeat.errors import BodyError, OnbeatError, PlanError
from onbeat.files import write_atomically
from onbeat.formats.body_size import UnitWarning
from onbeat.formats.notes import Note, noted
from onbeat.formats.rates import ASK, RateWarning
from onbeat.formats.read import read_motion
from onbeat.keyposes.extract import Keyposes, find_keyposes
from onbeat.keyposes.motion_tempo import motion_beats
from onbeat.motion import Body, Motion
from onbeat.motion.edit import stature
from onbeat.motion.features import hand_features
from onbeat.motion.problems import odd_size
from onbeat.studio.advice import here
from onbeat.studio.tasks import Done, LookTask, MotionSeen
from onbeat.studio.telling import Tell
from onbeat.studio.wire import MotionView
from onbeat.viewer.pages.content import page_data

LONGEST = 1800.0
"""Seconds of a motion that is taken."""
NOTES = 4
"""Lines of what was guessed that are told."""


def looked(task: LookTask, tell: Tell) -> Done:
    """Look at each file; those that cannot be used say why, a single one by an error."""
    tell = tell.of({"looking": 1.0})
    seen: list[MotionSeen] = []
    for number, (id, path, name) in enumerate(task.files):
        tell("looking", number / len(task.files), name)
        try:
            seen.append(_seen(Path(task.out), id, Path(path), name, task.rates.get(id)))
        except OnbeatError as error:
            asks = ASK in str(error)
            if len(task.files) == 1 and not asks:
                raise OnbeatError(_named(str(error), Path(path), name)) from None
            seen.append(MotionSeen(id, error=_named(str(error), Path(path), name), rate_stored=not asks))
    return Done(seen=seen)


def _named(text: str, path: Path, name: str) -> str:
    """What is said of a file, said by the user's name of it."""
    if path.suffix == ".amc" and text.startswith("no skeleton"):
        return f"{name} tells how a skeleton moves that is in an .asf file: drop both together, or in one .zip"
    return here(text).replace(str(path), name).replace(f"{path.parent}/", "").replace(path.name, name)


def _seen(out: Path, id: str, path: Path, name: str, rate: float | None) -> MotionSeen:
    with noted() as notes, warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always", UserWarning)
        motion = read_motion(path, rate)
        if motion.duration > LONGEST:
            raise OnbeatError(f"{name} lasts {motion.duration / 60:.0f} minutes; one of up to 30 is taken: cut it")
        sizes = [w for w in warned if issubclass(w.category, UnitWarning)]
        odd = [str(sizes[0].message)] if sizes else _odd_size(motion)
        told = _named(_note(notes, [*odd, *(str(w.message) for w in warned)]), path, name)
        view = motion_view(id, name, motion, told, odd=bool(odd))
    write_atomically(out / f"{id}.json", msgspec.json.encode(view))
    stored = not any(issubclass(warning.category, RateWarning) for warning in warned)
    return MotionSeen(id, None, view.seconds, view.fps, view.body, view.note, stored)


def _odd_size(motion: Motion) -> list[str]:
    """A line on a body of no person's size, as `onbeat info` has it."""
    try:
        body = Body.of(motion.skeleton)
    except BodyError:
        body = None
    return [said] if (said := odd_size(motion, body)) else []


def motion_view(id: str, name: str, motion: Motion, note: str = "", *, odd: bool = False) -> MotionView:
    """What is seen in a motion, and how to draw it; an ``odd`` size is doubted beside its figure."""
    body, stops = _body(motion, odd)
    keyposes = _keyposes(motion)
    scene = page_data(motion, None, {"title": name, "stops": stops.round(4).tolist()}, None, keyposes)
    return MotionView(
        id=id,
        name=name,
        seconds=round(motion.duration, 4),
        fps=round(motion.fps, 4),
        body=body,
        note=note,
        stops=stops.round(4).tolist(),
        intensity=scene.motion_intensity,
        keyposes=[] if keyposes is None else keyposes.times.round(4).tolist(),
        scene=scene,
    )


def _body(motion: Motion, odd: bool) -> tuple[str, Times]:
    """Who moves, in words, and when the hands come to rest."""
    joints = f"{len(motion.skeleton)} joints"
    try:
        body = Body.of(motion.skeleton)
    except BodyError as error:
        return f"{joints}, no body to dance with: {error}", np.zeros(0)
    doubt = " (is that right?)" if odd else ""
    return f"{stature(motion):.2f} m{doubt}, {joints}", hand_features(motion, body).body_stops


def _keyposes(motion: Motion) -> Keyposes | None:
    """Where it rests by a pulse of its own, if it keeps one."""
    try:
        return find_keyposes(motion, motion_beats(motion))
    except (PlanError, BodyError):
        return None


def _note(notes: Sequence[Note], warned: Sequence[str]) -> str:
    """What was guessed and what is to be known, in a few lines."""
    lines = [f"{note.about}: {note.taken} ({note.why})" if note.taken else note.why for note in notes]
    lines = list(dict.fromkeys([*warned, *lines]))
    more = [f"… and {len(lines) - NOTES} more"] if len(lines) > NOTES else []
    return "\n".join([*lines[:NOTES], *more])
