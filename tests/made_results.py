"""A paper that is done again at once, with words that would be tags."""

from __future__ import annotations

import os
import warnings
from dataclasses import replace

from onbeat.errors import OnbeatError
from onbeat.music.audio import AudioWarning
from onbeat.reproduce.data import Data
from onbeat.reproduce.paper import Step
from onbeat.reproduce.result import Claim, FigureResult, PaperResult, Row, TableResult

SVG = b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 4 3"><rect width="4" height="3"/></svg>'
RESULT = PaperResult(
    key="P1",
    title="Dance & <script>alert(1)</script>",
    citation="Somebody, 2006",
    paper_data="26 motions",
    our_data="17 motions",
    differs=("made, not captured",),
    claims=(
        Claim("beats are tracked", True, "12 of 13", ("Table I", "Fig. 9")),
        Claim("people like it", None, "nobody was asked"),
    ),
    parts=(
        TableResult("Table I", "Beats", (Row("La Bamba", "0.598 s", "0.596 s"), Row("another", None, "0.5 s"))),
        FigureResult("Fig. 5", "Paths", SVG, "a diagram", 'a decision, "real"'),
    ),
    files=(("study/study.html", b"<!doctype html>"),),
)


class MadePaper:
    """Gives ``RESULT`` and says so."""

    title = RESULT.title

    def __init__(self, key: str) -> None:
        self.key = key

    def reproduce(self, data: Data, step: Step) -> PaperResult:
        """Say half, then give the result."""
        step(0.5, "half of it")
        return replace(RESULT, key=self.key, our_data=f"seed {data.seed}")


def worked(number: int, step: Step) -> PaperResult:
    """A job of a process: says half, warns, gives the result; number 13 brings no luck."""
    step(0.5, f"half of {number}")
    if number == 13:
        raise OnbeatError("13 does not work")
    if number == 14:
        os._exit(3)
    warnings.warn(AudioWarning(f"{number} was not kept"), stacklevel=1)
    return replace(RESULT, our_data=str(number))
