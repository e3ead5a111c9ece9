"""Progress on stderr: what is done now, how far it is and how long it will take; warnings as lines after it."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from itertools import accumulate, pairwise
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from onbeat.cli.heartbeat import Heartbeat


@contextmanager
def warnings_as_lines() -> Generator[None]:
    """What onbeat warns of becomes a line on stderr, each once, when all is done; what others warn of is not told."""
    with warnings.catch_warnings(record=True) as noted:
        warnings.simplefilter("always", UserWarning)
        yield
    ours = [str(w.message) for w in noted if w.category.__module__.split(".")[0] == "onbeat"]
    for line in dict.fromkeys(ours):
        print(f"onbeat: {line}", file=sys.stderr)  # noqa: T201


class Stages:
    """A line of progress for each stage of a job, as it is reached, where stderr is a screen; else one now and then.

    Called with a stage's name and its share done, 0…1; naming a new stage ends the one before.

    Parameters
    ----------
    parts : how long the stages last against each other, in their order; where told, a line says how far all of the job
        is and how long it will take.
    passing : whether nothing of it stays on the screen.
    """

    def __init__(self, parts: Mapping[str, float] | None = None, *, passing: bool = False) -> None:
        edges = list(accumulate((parts or {}).values(), initial=0.0))
        whole = max(edges[-1], 1e-9)
        spans = zip(parts or {}, pairwise(edges), strict=True)
        self._spans = {name: (low / whole, high / whole) for name, (low, high) in spans}
        self._all: TaskID | None = None
        screen = Console(stderr=True)
        self._progress = Progress(
            TextColumn("{task.description:<10}"),
            BarColumn(bar_width=30),
            TimeElapsedColumn(),
            TimeRemainingColumn(),
            TextColumn("{task.fields[detail]}", markup=False),  # names of files may look like markup
            console=screen,
            transient=passing,
            disable=not screen.is_terminal,
        )
        self._lines = None if screen.is_terminal else Heartbeat()
        self._task: TaskID | None = None
        self._name = ""

    def __enter__(self) -> Stages:
        """Begin to draw."""
        self._progress.start()
        if self._lines:
            self._lines.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the last stage, if all went well."""
        if self._lines:
            self._lines.stop()
        if kind is None:
            self._finish()
            if self._all is not None:
                self._progress.update(self._all, completed=1.0)
        self._progress.stop()

    def __call__(self, stage: str, share: float, detail: str = "") -> None:
        """Say that ``share`` of ``stage`` is done, and what of it is done now."""
        if self._lines:
            self._lines.say(stage, min(max(share, 0.0), 1.0), detail)
        if stage != self._name:
            self._finish()
            if self._spans and self._all is None:
                self._all = self._progress.add_task("in all", total=1.0, detail="")
            self._task, self._name = self._progress.add_task(stage, total=1.0, detail=""), stage
        if self._task is not None:
            share = min(max(share, 0.0), 1.0)
            self._progress.update(self._task, completed=share, detail=detail)
            self._tell_all(stage, share)

    def _tell_all(self, stage: str, share: float) -> None:
        if self._all is not None and stage in self._spans:
            begin, end = self._spans[stage]
            self._progress.update(self._all, completed=begin + (end - begin) * share)

    def _finish(self) -> None:
        if self._task is not None:
            self._progress.update(self._task, completed=1.0, detail="")
