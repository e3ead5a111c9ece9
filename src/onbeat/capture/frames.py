"""The body-centre frame straight from markers, without a fitted body."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from onbeat._shapes import Positions, Rotations
from onbeat.capture.body import template
from onbeat.capture.gaps import fill_gaps
from onbeat.capture.placed import by_site, clusters, place_markers
from onbeat.capture.pose import bridge_places, is_seen
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
    placed, _ = place_markers(markers, sites, ("shoulder",))
    seen = by_site(fill_gaps(placed, clusters(placed.names)).markers)
    turns, origin = waist(seen, template())
    sides = [seen.get(f"{side}_shoulder", seen.get(f"{side}_acromion")) for side in ("left", "right")]
    left, right = (_bridged(side) for side in sides if side is not None)
    hips = rot.rotate(turns, np.array([2 * _HIP_M, 0.0, 0.0]))
    return frames_from((left + right) / 2 - origin, hips + right - left), origin


_HIP_M = 0.09


def _bridged(path: Positions) -> Positions:
    return bridge_places(path, is_seen(path))
