"""Labels of markers: printable, no two alike, without what says nothing."""

from __future__ import annotations

import re
from collections.abc import Sequence

_UNSAFE = re.compile(r"[^A-Za-z0-9_.\-]+")


def distinct_labels(labels: Sequence[str]) -> tuple[str, ...]:
    """The same labels with twins told apart as ``LASI``, ``LASI_2``, …; empty ones are numbered by their place.

    Examples
    --------
    >>> distinct_labels(["LASI", "", "LASI", "LASI_2"])
    ('LASI', 'point_2', 'LASI_3', 'LASI_2')
    """
    named = [label or f"point_{place}" for place, label in enumerate(labels, 1)]
    taken, kept = set(named), set[str]()
    numbers: dict[str, int] = {}
    found: list[str] = []
    for label in named:
        if label in kept:
            number = numbers.get(label, 2)
            while f"{label}_{number}" in taken:
                number += 1
            numbers[label] = number + 1
            label = f"{label}_{number}"
        taken.add(label)
        kept.add(label)
        found.append(label)
    return tuple(found)


def shared_prefix(labels: Sequence[str]) -> str:
    """What all labels have up to their first colon, as the subject's name in ``Anna:LASI``; else nothing.

    Labels that name nobody (empty ones and ``*17``, a trajectory that was not labelled) are passed over.

    Examples
    --------
    >>> shared_prefix(["Anna:LASI", "Anna:RASI", "*17"]), shared_prefix(["Anna:LASI", "Ben:LASI"])
    ('Anna:', '')
    """
    named = [label for label in labels if label and not label.startswith("*")]
    prefixes = {label[: label.find(":") + 1] for label in named}
    prefix = prefixes.pop() if len(prefixes) == 1 else ""
    return "" if any(label == prefix for label in named) else prefix


def without_prefix(labels: Sequence[str], prefix: str) -> list[str]:
    """The labels without the prefix, where they have it."""
    return [label.removeprefix(prefix) for label in labels]


def safe_labels(names: Sequence[str]) -> tuple[str, ...]:
    """Labels that every program reads: letters, digits and ``_ . -`` only, at most 32 of them, no two alike.

    Examples
    --------
    >>> safe_labels(["mixamorig:Left Arm", "mixamorig:Hips"])
    ('Left_Arm', 'Hips')
    """
    plain = without_prefix(names, shared_prefix(names))
    return distinct_labels([_UNSAFE.sub("_", name.strip())[:32] for name in plain])
