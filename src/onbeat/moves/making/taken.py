"""Recordings that are there twice: all of their clips move as those of earlier ones do."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from onbeat._shapes import Float32
from onbeat.moves.making.stock import Row, Stock
from onbeat.moves.making.twins import find_twins


def twin_recordings(
    stock: Stock, rows: Mapping[int, Sequence[Row]], step: Callable[[float], None] | None = None
) -> dict[int, int]:
    """Of recordings, by their clips, those that move as earlier ones do, all along; and which these are.

    Parameters
    ----------
    stock : where the clips lie.
    rows : for each recording its clips; mirror images are not looked at.
    step : called with the share that is done, 0…1.
    """
    takes = [(n, row) for n, found in rows.items() for row in found if not row.shape.mirrored]

    def poses(clip: int) -> Float32:
        row = takes[clip][1]
        return row.shape.split(stock.clips.read(row.span))["poses"]

    twins = find_twins([row.shape.poses for _, row in takes], poses, step)
    told = [(n, takes[twins[clip]][0] if clip in twins else n) for clip, (n, _) in enumerate(takes)]
    kept = {n for n, earlier in told if n == earlier}  # some of it is nowhere else
    return {n: earlier for n, earlier in reversed(told) if n not in kept}
