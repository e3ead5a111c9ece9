"""Which points of a C3D file are markers, and what they are called."""

from __future__ import annotations

from onbeat.formats.c3d.parameters import Parameters
from onbeat.formats.notes import tell
from onbeat.motion.marker_labels import distinct_labels, shared_prefix, without_prefix

_OUTPUTS = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS")
"""Parameters of POINT that list the points in which Vicon's models keep what is no position."""


def marker_labels(parameters: Parameters, points: int) -> tuple[list[int], tuple[str, ...]]:
    """Which of the points are markers, and their labels, no two alike.

    Left out are the angles, forces, moments, powers and scalars of models. What was left out, numbered, renamed or
    freed of the subject's name is told.
    """
    labels = (parameters.all_texts("POINT:LABELS") + [""] * points)[:points]
    outputs = {label for name in _OUTPUTS for label in parameters.all_texts(f"POINT:{name}") if label}
    kept = [place for place, label in enumerate(labels) if label not in outputs]
    if len(kept) < points:
        tell("points", f"{len(kept)} markers", f"{points - len(kept)} points are angles, forces or the like of a model")
    labels = [labels[place] for place in kept]
    prefix = shared_prefix(labels)
    if prefix:
        tell("labels", f"without {prefix!r}", "all labels begin with this subject's name")
    plain = [label or f"point_{place + 1}" for place, label in zip(kept, without_prefix(labels, prefix), strict=True)]
    named = distinct_labels(plain)
    _tell_of_changes(labels, plain, named)
    return kept, named


def _tell_of_changes(labels: list[str], plain: list[str], named: tuple[str, ...]) -> None:
    empty = labels.count("")
    if empty:
        tell("labels", "numbered", f"{empty} of {len(labels)} points have no label")
    twins = [new for old, new in zip(plain, named, strict=True) if old != new]
    if twins:
        tell("labels", ", ".join(twins[:8]), f"{len(twins)} labels occur more than once and were numbered")
