"""The body that markers are fitted with: a standing adult in a T-pose, whose bones are scaled group by group."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Ints
from onbeat.motion.skeleton import Skeleton

_CENTRE = (
    ("Hips", "", (0.0, 0.0, 0.0), ""),
    ("Spine", "Hips", (0.0, 0.0, 0.10), "trunk"),
    ("Chest", "Spine", (0.0, 0.0, 0.15), "trunk"),
    ("Neck", "Chest", (0.0, -0.01, 0.25), "trunk"),
    ("Head", "Neck", (0.0, 0.02, 0.09), "neck"),
    ("HeadEnd", "Head", (0.0, 0.0, 0.18), "neck"),
)
_SIDE = (
    ("Shoulder", "Chest", (0.03, 0.01, 0.20), "trunk"),
    ("Arm", "Shoulder", (0.145, -0.02, -0.02), "collar"),
    ("ForeArm", "Arm", (0.29, 0.0, 0.0), "upper_arm"),
    ("Hand", "ForeArm", (0.25, 0.0, 0.0), "forearm"),
    ("HandEnd", "Hand", (0.18, 0.0, 0.0), "hand"),
    ("UpLeg", "Hips", (0.087, 0.0, -0.05), "pelvis"),
    ("Leg", "UpLeg", (0.0, 0.0, -0.43), "thigh"),
    ("Foot", "Leg", (0.0, 0.0, -0.41), "shin"),
    ("ToeBase", "Foot", (0.0, 0.12, -0.055), "foot"),
    ("ToeEnd", "ToeBase", (0.0, 0.07, 0.0), "foot"),
)
SIDES: Mapping[str, float] = {"Left": -1.0, "Right": 1.0}
"""The sides and the sign of their x: the body looks along +Y."""


class Template(NamedTuple):
    """A skeleton of 1.75 m and the group of each bone.

    Parameters
    ----------
    skeleton : J joints, the rest pose a T-pose that faces +Y.
    groups : the groups' names; the bones of a group are scaled together.
    group : (J,) the index of each joint's group; the root's is -1.
    """

    skeleton: Skeleton
    groups: tuple[str, ...]
    group: Ints

    def scaled(self, scales: Array, offsets: Array | None = None) -> Skeleton:
        """The skeleton with each bone as long as the scale (groups,) of its group makes it."""
        s = self.skeleton
        base = s.offsets if offsets is None else offsets
        factors = np.where(self.group < 0, 1.0, np.asarray(scales)[self.group])
        return s.replace(offsets=base * factors[:, None])


@cache
def template(symmetric: bool = True) -> Template:
    """The template; the bones of left and right are of one group where ``symmetric``, else each of its own.

    Heights and breadths are those of an adult of 1.75 m (Drillis and Contini 1966, as in Winter, Biomechanics and
    Motor Control of Human Movement, fig. 4.1), rounded to a centimetre.

    Examples
    --------
    >>> body = template()
    >>> float(np.ptp(body.skeleton.rest_positions[:, 2]).round(2))
    1.72
    >>> body.skeleton.names[:3], len(template(symmetric=False).groups) - len(body.groups)
    (('Hips', 'Spine', 'Chest'), 8)
    """
    rows = list(_CENTRE)
    for side, sign in SIDES.items():
        for name, above, (x, y, z), group in _SIDE:
            parent = above if above in ("Hips", "Chest") else side + above
            own = group if symmetric or group == "trunk" else side.lower() + "_" + group
            rows.append((side + name, parent, (sign * x, y, z), own))
    rows = _depth_first(rows, "")
    names = [row[0] for row in rows]
    parents = [names.index(row[1]) if row[1] else -1 for row in rows]
    skeleton = Skeleton(names, parents, [row[2] for row in rows], [name.endswith("End") for name in names])
    groups = tuple(dict.fromkeys(row[3] for row in rows if row[3]))
    return Template(skeleton, groups, np.array([groups.index(row[3]) if row[3] else -1 for row in rows]))


_Row = tuple[str, str, tuple[float, float, float], str]


def _depth_first(rows: list[_Row], parent: str) -> list[_Row]:
    return [found for row in rows if row[1] == parent for found in (row, *_depth_first(rows, row[0]))]
