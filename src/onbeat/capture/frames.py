"""The body-centre frame straight from markers, without a fitted body."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from onbeat._shapes import Positions, Rotations
from onbeat.capture.body import template
from onbeat.capture.gaps import fill_gaps
from onbeat.capture.labels import NEEDED, check_enough, find_sites
from onbeat.capture.placed import by_site, clusters, place_markers
from onbeat.capture.pose import bridge_places, is_seen
from onbeat.capture.sites import SITES
from onbeat.capture.trunk import waist
from onbeat.motion import rotations as rot
from onbeat.motion.body import frames_from
from onbeat.motion.markers import Markers


def marker_body_frames(
    markers: Markers, sites: Mapping[str, Sequence[str]] | None = None
) -> tuple[Rotations, Positions]:
    """The body-centre frame of each frame (Shiratori 2006, Sec. II-A), as :func:`onbeat.motion.body.body_frames`.

    The origin is the waist, where the fitted hips' joint would be; z points from it to the middle of the shoulders, y
    to the front, x across to the right. Where pelvis or shoulders are not seen the frames between are filled, beyond
    the first and the last they are held.

    Returns
    -------
    (F, 4) rotations wxyz from the body-centre frame to the world and (F, 3) origins in metres.

    Raises
    ------
    BodyError
        If pelvis or shoulders have no markers.
    """
    trunk, told = _on_trunk(markers, sites)
    placed, _ = place_markers(trunk, told, ("shoulder",))
    seen = by_site(fill_gaps(placed, clusters(placed.names)).markers)
    turns, origin = waist(seen, template())
    sides = [seen.get(f"{side}_shoulder", seen.get(f"{side}_acromion")) for side in ("left", "right")]
    left, right = (_bridged(side) for side in sides if side is not None)
    hips = rot.rotate(turns, np.array([2 * _HIP_M, 0.0, 0.0]))
    return frames_from((left + right) / 2 - origin, hips + right - left), origin


_HIP_M = 0.09
_BONES = {"Hips"} | {
    SITES[f"{side}_{place}"].segment for side in ("left", "right") for place in NEEDED["shoulder"].split()
}


def _on_trunk(
    markers: Markers, sites: Mapping[str, Sequence[str]] | None
) -> tuple[Markers, Mapping[str, Sequence[str]] | None]:
    """Only the markers on the bones that tell the frame: the others would be filled for nothing."""
    known = find_sites(markers.names, sites)
    check_enough(known, markers.names, markers.name, ("shoulder",))
    kept = [label for site, labels in known.items() if SITES[site].segment in _BONES for label in labels]
    told = None if sites is None else {site: labels for site, labels in sites.items() if SITES[site].segment in _BONES}
    return markers.chosen(list(dict.fromkeys(kept))), told


def _bridged(path: Positions) -> Positions:
    return bridge_places(path, is_seen(path))
