"""Figures as files: drawn without a screen, the same bytes for the same figure."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

from onbeat.errors import OnbeatError
from onbeat.files import write_atomically

ENDINGS = (".png", ".svg", ".pdf")
DPI = 150
_STYLE: dict[Any, Any] = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "svg.hashsalt": "onbeat",
}


def new_figure(size: tuple[float, float]) -> Any:
    """An empty matplotlib figure, ``size`` in inches, laid out so that labels fit."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(_STYLE):
        return Figure(figsize=size, layout="constrained")


def figure_bytes(figure: Any, kind: str) -> bytes:
    """A figure as the bytes of a PNG, SVG or PDF file (``kind`` is ``png``, ``svg`` or ``pdf``), without a date."""
    import matplotlib as mpl

    undated: dict[str, Any] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(kind, {"Software": None})
    buffer = io.BytesIO()
    with mpl.rc_context(_STYLE):
        figure.savefig(buffer, format=kind, dpi=DPI, metadata=undated)
    return buffer.getvalue()


def save_figure(figure: Any, path: Path) -> None:
    """Write a figure as PNG, SVG or PDF, without a date.

    Raises
    ------
    OnbeatError
        If the ending is none of these.
    """
    kind = path.suffix.lower()
    if kind not in ENDINGS:
        raise OnbeatError(f"{path}: cannot draw {kind or 'a file without ending'}; use {', '.join(ENDINGS)}")
    write_atomically(path, figure_bytes(figure, kind[1:]))
