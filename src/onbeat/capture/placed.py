"""Markers by their sites: what is seen of a body, under one name whatever the file calls it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from onbeat._shapes import Ints, Positions
from onbeat.capture.labels import NEEDED, check_enough, find_sites
from onbeat.capture.sites import SITES
from onbeat.errors import BodyError
from onbeat.motion.markers import Markers

FARTHEST_M = 1000.0
"""Metres from the origin beyond which nothing is recorded."""


def place_markers(
    markers: Markers, sites: Mapping[str, Sequence[str]] | None = None, joints: Sequence[str] = tuple(NEEDED)
) -> tuple[Markers, dict[str, tuple[str, ...]]]:
    """The markers under the names of their sites, and the labels of each site.

    Sites of which nothing is ever seen are left out; a site with several labels is in the middle of them.

    Raises
    ------
    BodyError
        If too little of the body is seen (:func:`onbeat.capture.labels.check_enough`), or markers are kilometres away.
    """
    far = np.abs(np.nan_to_num(markers.positions)).max(axis=(0, 2))
    if far.max() > FARTHEST_M:
        label = markers.names[int(np.argmax(far))]
        raise BodyError(f"the marker {label!r} is {far.max():.3g} m from the origin; is the file's unit right?")
    ever = np.asarray(markers.seen.any(axis=0))
    known = find_sites(markers.names, sites)
    unseen = [label for labels in known.values() for label in labels if not ever[markers.index(label)]]
    found = {site: labels for site, labels in known.items() if not set(labels) & set(unseen)}
    check_enough(found, markers.names, markers.name, joints, unseen)
    columns = [markers.positions[:, [markers.index(n) for n in labels]].mean(axis=1) for labels in found.values()]
    return Markers(tuple(found), np.stack(columns, axis=1), markers.fps, markers.name), found


def by_site(placed: Markers, frames: Ints | slice = slice(None)) -> dict[str, Positions]:
    """Positions (F, 3) of each site at some frames."""
    return {name: placed.positions[frames, index] for index, name in enumerate(placed.names)}


def clusters(names: Sequence[str]) -> list[list[int]]:
    """The indices of the sites of each bone."""
    bones = [SITES[name].segment for name in names]
    return [[k for k, bone in enumerate(bones) if bone == each] for each in dict.fromkeys(bones)]
