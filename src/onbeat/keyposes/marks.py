"""Marked keyposes as people write them: a second a line, perhaps with a word behind it."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np

from onbeat._shapes import Times
from onbeat.errors import MetricError

LARGEST = 16 << 20  # bytes


def read_marks(path: Path, last: float = math.inf) -> Times:
    """Seconds (K,) of the keyposes in a file ``NAME.keyposes.csv``: the first column; what follows is a label.

    Parameters
    ----------
    path : the file; lines that begin with ``#`` and a heading are passed over.
    last : seconds of the motion, beyond which no keypose can be.

    Raises
    ------
    MetricError
        With file and line, if a time is no number, not after the one before, or outside of the motion; or if there is
        none.
    """
    try:
        if path.stat().st_size > LARGEST:
            raise MetricError(f"{path} has {path.stat().st_size} bytes; marks of keyposes are a second a line")
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise MetricError(f"cannot read {path}: {error}; write the seconds of the keyposes there, one a line") from None
    times: list[float] = []
    for number, line in enumerate(text.splitlines(), 1):
        words = re.split(r"[\s,;]+", line.strip(), maxsplit=1)
        if not words[0] or words[0].startswith("#") or (not times and not re.match(r"[-+.\d]", words[0])):
            continue
        times.append(_second(f"{path}:{number}", line.strip(), words[0], times[-1] if times else -math.inf, last))
    if not times:
        raise MetricError(f"{path} marks no keypose; write their seconds, one a line")
    return np.array(times)


def _second(where: str, line: str, word: str, before: float, last: float) -> float:
    try:
        value = float(word)
    except ValueError:
        raise MetricError(f"{where}: {word!r} is no second; write it as 1.25, a label behind it if you like") from None
    if re.fullmatch(r"\d+,\d+", line):
        raise MetricError(f"{where}: {line!r} may be one number or two; write a point, as in {line.replace(',', '.')}")
    if not (math.isfinite(value) and value > before):
        raise MetricError(f"{where}: {word} does not follow {before:g}; the keyposes have to be in order")
    if not 0.0 <= value <= last:
        raise MetricError(f"{where}: a keypose at {value:g} s, but the motion goes from 0 to {last:.2f} s")
    return value
