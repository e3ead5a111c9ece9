"""The figures of a dance as its page tells them: in words where there are any, else by their names."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from onbeat.viewer.contract import MetricData

GROUPS = (
    "search", "beats_before_warp", "beats", "warp", "intensity", "feet", "smoothness", "variety", "retime", "robot",
)  # fmt: skip
"""Of what dances measure, those in another time and on robots, too; of these only what there are words for is told,
``dance.json`` has all."""


class Told(NamedTuple):
    """A figure in words: whose it is, how it is printed, and what is printed beside it."""

    name: str
    group: str
    key: str
    form: str
    beside: tuple[str, str, str] | None = None


TOLD = (
    Told("on the beat, ±50 ms", "beats", "f50", "{:.2f}", ("beats_before_warp", "f50", "{:.2f} before the warp")),
    Told("on the beat, ±100 ms", "beats", "f100", "{:.2f}", ("beats_before_warp", "f100", "{:.2f} before the warp")),
    Told("against chance", "beats", "f50_jitter_z", "{:.1f} deviations above"),
    Told("with the intensity", "intensity", "intensity_pearson", "{:.2f}"),
    Told("joins a minute", "variety", "joins_per_minute", "{:.0f}"),
    Told("feet at joins", "feet", "skate_joins", "{:.3f} m/s", ("feet", "skate_source", "{:.3f} in the clips")),
    Told("shown twice", "variety", "repeated_s", "{:.1f} s"),
    Told("of the best with repeats", "search", "of_optimum", "{:.2f}"),
    Told("speed", "retime", "speed", "{:.2f} ×"),
    Told("off the same dance merely faster", "retime", "rms_deg", "{:.1f}° (rms)"),
    Told("worst keypose", "retime", "keypose_error_deg", "{:.1f}° off", ("retime", "keyposes_missed", "{:.0f} missed")),
    Told("speed", "robot", "speed", "{:.2f} ×"),
    Told(
        "in balance",
        "robot",
        "balance_inside",
        "{:.1%} of the time",
        ("robot", "balance_worst_mm", "{:.0f} mm at least"),
    ),
    Told("joints past their angles", "robot", "joints_past_position_limits", "{:.0f}"),
    Told("joints past their speeds", "robot", "joints_past_speed_limits", "{:.0f}"),
)
"""The words of the tables that ``onbeat dance``, ``retime`` and ``robot`` print, as short as a page needs them."""


def told(metrics: Mapping[str, Any]) -> list[MetricData]:
    """Figures for people: those of a dance in words, others by name, those of parts as ``part · name``.

    Lists are left to ``dance.json``.

    Examples
    --------
    >>> [(row.name, row.value) for row in told({"beats": {"f50": 0.8123}, "limits": {"over_by": 2}})]
    [('on the beat, ±50 ms', '0.81'), ('limits · over by', '2')]
    """
    known = [_row(metrics, row) for row in TOLD]
    others = {name: value for name, value in metrics.items() if name not in GROUPS or not isinstance(value, Mapping)}
    return [*(row for row in known if row is not None), *_named(others)]


def _row(metrics: Mapping[str, Any], row: Told) -> MetricData | None:
    value = _number(metrics, row.group, row.key)
    if value is None:
        return None
    beside = None if row.beside is None else _number(metrics, *row.beside[:2])
    more = f" ({row.beside[2].format(beside)})" if row.beside is not None and beside is not None else ""
    return MetricData(row.name, row.form.format(value) + more)


def _number(metrics: Mapping[str, Any], group: str, key: str) -> float | None:
    part: Any = metrics.get(group)
    value: Any = part.get(key) if isinstance(part, Mapping) else None  # pyright: ignore[reportUnknownMemberType, reportUnknownVariableType]
    return float(value) if isinstance(value, int | float) and np.isfinite(value) else None


def _named(metrics: Mapping[str, Any], prefix: str = "") -> list[MetricData]:
    made: list[MetricData] = []
    for name, value in metrics.items():
        label = f"{prefix}{name}".replace("_", " ")
        if isinstance(value, Mapping):
            made += _named(value, f"{label} · ")  # pyright: ignore[reportUnknownArgumentType]
        elif isinstance(value, bool | str):
            made.append(MetricData(label, str(value)))
        elif isinstance(value, int | float):
            made.append(MetricData(label, f"{value:.4g}" if np.isfinite(value) else "–"))
    return made
