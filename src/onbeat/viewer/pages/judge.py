"""``judge.html``: people say which of two motions is more like the original (keyposes 2009, Sec. 4.3, Fig. 12)."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Sequence
from importlib import resources
from typing import Any

import msgspec
import numpy as np

from onbeat._shapes import Positions
from onbeat.errors import MetricError, OnbeatError
from onbeat.files import write_atomically
from onbeat.keyposes.judging import SPACES, VERSION, Trial
from onbeat.keyposes.lowdim import LowDimensional
from onbeat.keyposes.playable import bone_ends
from onbeat.keyposes.vectors import CROWN
from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.motion.body import facing
from onbeat.viewer.figure import Figure, ground_height

FPS = 30.0
"""Frames a second on the page, which draws between them."""
LONGEST = 15.0
"""Seconds of each motion: of the cycle that taught, in the middle, or the beginning of that; repeats show as much."""
_SLOT = b"<!--onbeat-data-->"
_WIDTHS = {
    "hip": 125.0, "knee": 112.0, "ankle": 75.0, "collar": 100.0, "shoulder": 84.0, "elbow": 80.0, "wrist": 62.0,
    "hand": 58.0, "head": 90.0, "crown": 180.0,
}  # fmt: skip
_TRUNK, _THIN = 190.0, 60.0
_OF_TRUNK = ("hip", "collar", "shoulder")
_ENDS = {"head": (180.0, 70, 110), "wrist": (56.0, 0, 85)}
"""Head and hand where a file ends with their joints: width, and from where to where they are past the joint."""
_COLOURS = {"left": "#2f6f9f", "right": "#c46a2b", "": "#4a5666"}


def write_judge_page(path: str | os.PathLike[str], found: LowDimensional, trials: Sequence[Trial]) -> None:
    """Write the page: one file that opens without a server or a network.

    Parameters
    ----------
    path : the file.
    found : the motions, in both spaces.
    trials : what is asked, by the names of the people; see :func:`onbeat.keyposes.judging.trials`.

    Raises
    ------
    MetricError
        If there is no trial, or one of a motion that is not there.
    """
    write_atomically(path, judge_page(found, trials))


def judge_page(found: LowDimensional, trials: Sequence[Trial], plans: Sequence[Sequence[Trial]] = ()) -> bytes:
    """The page's bytes.

    Parameters
    ----------
    found : the motions, in both spaces.
    trials : what is asked, by the names of the people.
    plans : for a study with many people: what each is asked, in turn, instead of the same ``trials``. Such a page
        begins with a word of welcome, gathers the answers of all, and hands them to the server it comes from.

    Raises
    ------
    MetricError
        If there is no trial, or one of a motion that is not there.
    """
    people = [one.person for one in found.taught]
    every = [*trials, *(trial for plan in plans for trial in plan)]
    if not every or any(trial.motion not in people for trial in every):
        raise MetricError(f"trials of {sorted({trial.motion for trial in every})} cannot be asked: there are {people}")
    shown = [people.index(name) for name in dict.fromkeys(trial.motion for trial in every)]
    content = _data(found, shown, trials, plans)
    # The key, under which a browser keeps the answers, tells one study's from another's.
    key = hashlib.sha256(msgspec.json.encode(content)).hexdigest()[:16]
    data = msgspec.json.encode({"key": key, **content}).replace(b"<", b"\\u003c")
    return _shell().replace(_SLOT, b'<script type="application/json" id="data">' + data + b"</script>", 1)


def _shell() -> bytes:
    file = resources.files("onbeat.viewer") / "static" / "judge.html"
    try:
        return file.read_bytes()
    except OSError:
        raise OnbeatError(f"{file} is missing; install onbeat again") from None


def _data(
    found: LowDimensional, shown: Sequence[int], trials: Sequence[Trial], plans: Sequence[Sequence[Trial]]
) -> dict[str, Any]:
    every = [*trials, *(trial for plan in plans for trial in plan)]
    first, repeats = found.vectors[shown[0]], 1 + max(trial.stretch for trial in every)
    told = {"plans": [[trial._asdict() for trial in plan] for plan in plans]} if plans else {}
    return {
        "version": VERSION,
        "dims": found.dims,
        "fps": FPS,
        "points": len(first.points),
        "trunk": _COLOURS[""],
        "bones": drawn_bones(first.points, bone_ends(found.motions[shown[0]].skeleton, first.joints)),
        "motions": {found.taught[which].person: _stretches(found, which, repeats) for which in shown},
        "trials": [trial._asdict() for trial in trials],
        **told,
    }


def drawn_bones(points: tuple[str, ...], ends: np.ndarray) -> list[list[Any]]:
    """Points, width in millimetres and colour of each bone; each side has its own colour.

    Heads and hands that a file has no end of follow: with the millimetres past the second point at which they begin
    and end.

    Examples
    --------
    >>> drawn_bones(("neck", "head"), np.array([[0, 1]]))
    [[0, 1, 90.0, '#4a5666'], [0, 1, 180.0, '#4a5666', 70, 110]]
    >>> len(drawn_bones(("neck", "head", "crown"), np.array([[0, 1], [1, 2]])))
    2
    """
    drawn: list[list[Any]] = []
    pairs = ends.tolist()
    for first, last in pairs:
        side, _, part = points[last].rpartition("_")
        width = _WIDTHS.get(part, _THIN if side else _TRUNK)
        drawn.append([first, last, width, _COLOURS.get("" if part in _OF_TRUNK else side, _COLOURS[""])])
    above = {last: first for first, last in pairs}
    for point in sorted(set(above) - set(above.values())):
        side, _, part = points[point].rpartition("_")
        if part in _ENDS:
            width, start, end = _ENDS[part]
            drawn.append([above[point], point, width, _COLOURS.get(side, _COLOURS[""]), start, end])
    return drawn


def stretches(found: LowDimensional, which: int, repeats: int) -> list[tuple[float, float]]:
    """Seconds from and to of what is shown of a motion: the cycle that taught, and stretches all over the dance.

    They are as long as a cycle, but no longer than so many find room in the dance without lying over each other.
    """
    one = found.taught[which]
    spans = [*found.tested[which].spans, (one.start, one.end)]
    low, high = min(a for a, _ in spans), min(max(b for _, b in spans), one.vectors.duration)
    length = min(one.end - one.start, LONGEST, high - one.start)
    if repeats > 1:
        length = min(length, (high - low) / repeats)
    room = high - low - length
    starts = [one.start] + [low + (one.start - low + n * room / repeats) % max(room, 1e-9) for n in range(1, repeats)]
    return [(start, start + length) for start in starts]


def _stretches(found: LowDimensional, which: int, repeats: int) -> list[dict[str, Any]]:
    motions = {"original": found.motions[which], **{space: found.motion(which, space) for space in SPACES}}
    return [_motion(found, which, motions, *span) for span in stretches(found, which, repeats)]


def _motion(found: LowDimensional, which: int, motions: dict[str, Motion], start: float, end: float) -> dict[str, Any]:
    """The three paths of a stretch of a motion, seen from the front, and the box they keep in, millimetres."""
    one, original = found.taught[which], motions["original"]
    times = start + np.arange(max(2, int((end - start) * FPS) + 1)) / FPS
    turn = rot.yaw(-_mean_facing(one.vectors.frames))
    ground = ground_height(Figure.of(original.skeleton), original)
    # The view goes sideways with the original's hips, whose path all three have.
    middle = rot.rotate(turn, original.at(times).positions[:, one.vectors.joints[:1]])
    middle[..., 1:] = np.median(middle[..., 1]), ground
    paths = {name: _seen(m, one.vectors.joints, times, turn, middle) for name, m in motions.items()}
    every = np.concatenate(list(paths.values())).reshape(-1, 3)
    low, high = every[:, :2].min(axis=0), every[:, :2].max(axis=0)
    # Where the file has no crown a head is drawn on the neck, which reaches higher than its joint.
    above = 120 if CROWN in one.vectors.points else 220
    box = [int(low[0]) - 120, int(high[0]) + 120, min(int(low[1]), 0) - 60, int(high[1]) + above]
    return {"frames": len(times), "box": box, "paths": {name: path.ravel().tolist() for name, path in paths.items()}}


def _mean_facing(frames: np.ndarray) -> float:
    mean = np.exp(1j * facing(frames)).mean()
    return float(np.angle(mean)) if abs(mean) > 1e-6 else 0.0


def _seen(motion: Motion, joints: np.ndarray, times: np.ndarray, turn: np.ndarray, middle: Positions) -> np.ndarray:
    """(T, N, 3) whole millimetres: x across as the viewer has it, y up, z towards the viewer, who stands in front."""
    places = rot.rotate(turn, motion.at(times).positions[:, joints]) - middle
    return np.rint(1000 * np.stack((-places[..., 0], places[..., 2], places[..., 1]), axis=-1)).astype(np.int64)
