"""The multi-factor tensor model of keyposes 2009, Sec. 5: position × people × task, decomposed, and probed by elements.

The mean segment of each cell is a column of the tensor, which :mod:`onbeat.recognition.hosvd` takes apart (Eq. 12). A
probe's elements are compared with those of every cell (Eq. 13) and vote (Eq. 14,
:mod:`onbeat.recognition.voting`): to tell its task, a task is as near as its nearest person's cell; to tell its person,
a person is as near as its nearest task's.

At full rank the product of core and matrices gives the data back, so that this *is* the nearest neighbour by elements;
what the tensor adds is rank. With ``ranks`` the cells are their low-rank versions, and probes are seen in the subspace
of positions that is kept.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from onbeat._shapes import Array, Bools, Ints, Positions, frozen
from onbeat.errors import MetricError
from onbeat.recognition.cells import cells_of, filled
from onbeat.recognition.hosvd import Hosvd, hosvd
from onbeat.recognition.segments import Segments
from onbeat.recognition.voting import (
    Matches,
    Reference,
    checked_weights,
    distances,
    reference,
    votes,
    weights_by_links,
)

_AT_ONCE = 1 << 24  # distances that are held at a time: 128 MB


@dataclass(frozen=True, eq=False)
class TensorModel:
    """A decomposed table of mean segments; made by :meth:`fit`.

    Parameters
    ----------
    parts : core and matrices, of modes position (T·E·3), people, task and further ones.
    modes : names of the modes after position: "person", "task", …
    names : of each of them, its categories.
    seen : (n₁, n₂, …) the cells somebody danced; the others are filled.
    timing : (2, n₁, n₂, …) of each cell, seconds of its segment and metres of a body size.
    elements : E names.
    weights : (E,) what each element's vote counts, in all 1.
    projects : whether probes are seen in the subspace of positions.
    guesses : whether filled cells are compared with, too.
    """

    parts: Hosvd
    modes: tuple[str, ...]
    names: tuple[tuple[str, ...], ...]
    seen: Bools
    timing: Array
    elements: tuple[str, ...]
    weights: Array
    projects: bool = False
    guesses: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "seen", frozen(self.seen, np.bool_))
        object.__setattr__(self, "timing", frozen(self.timing))
        object.__setattr__(self, "weights", checked_weights(self.weights, len(self.elements)))

    @classmethod
    def fit(
        cls,
        segments: Segments,
        ranks: Sequence[int | None] | None = None,
        *,
        weights: Array | None = None,
        more: Mapping[str, Sequence[str]] | None = None,
        guesses: bool = True,
    ) -> TensorModel:
        """The model of segments whose task and person are known.

        Parameters
        ----------
        segments : S segments; those of one cell are averaged.
        ranks : how many columns are kept of position, person, task and each further mode; None keeps all.
        weights : (E,) what each element's vote counts; None: its links from the body's centre.
        more : further modes by name, such as "cycle" or "tempo", and the category of each segment in them.
        guesses : whether cells that nobody danced are compared with; how they are filled tells
            :func:`onbeat.recognition.cells.filled`.

        Raises
        ------
        MetricError
            If there is no segment, a task or person is not known, or ranks or weights do not fit.

        Examples
        --------
        >>> lifts = np.zeros((4, 3, 1, 3))
        >>> lifts[:, :, 0, 2] = [[0, 1, 2], [0, 1, 3], [2, 1, 0], [3, 1, 0]]  # up, up, down, down; B does more
        >>> known = Segments(lifts, [1.0] * 4, ("up", "up", "down", "down"), "ABAB", [0] * 4, ("left_wrist",), [6])
        >>> model = TensorModel.fit(known)
        >>> model.match(known, "task").best, model.match(known, "person").best
        (('up', 'up', 'down', 'down'), ('A', 'B', 'A', 'B'))
        >>> model.reconstruct("up", "B")[:, 0, 2].round(6).tolist()[1:]
        [1.0, 3.0]
        """
        factors = {"person": segments.person, "task": segments.task, **(more or {})}
        if len(factors) != 2 + len(more or {}):
            raise MetricError("person and task are modes already; name further modes otherwise")
        numbers = int(np.prod(segments.positions.shape[1:]))
        cells = cells_of(segments.positions.reshape(len(segments), numbers), factors)
        lengths = cells_of(np.log(np.stack((segments.durations, segments.sizes), axis=1)), factors)
        chosen = weights_by_links(segments.links) if weights is None else weights
        timing = np.exp(filled(lengths, shrinkage=0.0))
        of = (cells.modes, cells.names, cells.seen, timing, segments.elements, chosen)
        projects = ranks is not None and len(ranks) > 0 and ranks[0] is not None
        return cls(hosvd(filled(cells), ranks), *of, projects, guesses)

    @cached_property
    def cells(self) -> Array:
        """(T·E·3, n₁, n₂, …) the mean segments as the model keeps them."""
        return frozen(self.parts.tensor())

    @property
    def moments(self) -> int:
        """T, at how many moments segments are read."""
        return len(self.parts.factors[0]) // (3 * len(self.elements))

    def categories(self, mode: str) -> tuple[str, ...]:
        """The names of a mode's categories; a ``MetricError`` lists the modes there are."""
        return self.names[self._axis(mode)]

    def element_distances(self, segments: Segments, mode: str) -> Array:
        """(N, E, C) squared body sizes, of each element of probes the least distance to each category of a mode.

        The mean over the moments; the least over the cells of the category (Eq. 13).
        """
        vectors, basis = self.vectors(segments), self.parts.factors[0]
        probes = self._by_element((vectors @ basis) @ basis.T if self.projects else vectors)
        order, starts = self._groups(mode)
        step = max(1, _AT_ONCE // (len(self.elements) * len(order)))
        found = [
            np.minimum.reduceat(distances(probes[i : i + step], self._reference)[:, :, order], starts, axis=2)
            for i in range(0, len(probes), step)
        ]
        return np.concatenate(found) / self.moments

    def match(self, segments: Segments, mode: str) -> Matches:
        """How well probes match the categories of a mode ("task", "person", …), by the vote of their elements.

        Raises
        ------
        MetricError
            If there is no such mode, no probe, or the probes lack elements of the model or have other moments.
        """
        least = self.element_distances(segments, mode)
        values = np.einsum("e,nec->nc", self.weights, least)
        return Matches(mode, self.categories(mode), votes(least, self.weights), values)

    def reconstruct(self, task: str, person: str) -> Positions:
        """(T, E, 3) body sizes: a task as a person dances it, or would; the mean over further modes."""
        values = self.cells[:, self.index("person", person), self.index("task", task)]
        return values.reshape(len(values), -1).mean(axis=1).reshape(self.moments, -1, 3)

    def length(self, task: str, person: str) -> tuple[float, float]:
        """Seconds of a task as a person dances it, or would, and the metres of the person's body size."""
        of = self.timing[:, self.index("person", person), self.index("task", task)].reshape(2, -1).mean(axis=1)
        return float(of[0]), float(of[1])

    def index(self, mode: str, name: str) -> int:
        """The number of a category; a ``MetricError`` lists those there are."""
        names = self.categories(mode)
        if name not in names:
            raise MetricError(f"no {mode} {name!r} in the model; there are {', '.join(names)}")
        return names.index(name)

    def _axis(self, mode: str) -> int:
        if mode not in self.modes:
            raise MetricError(f"no mode {mode!r} in the model; there are {', '.join(self.modes)}")
        return self.modes.index(mode)

    @cached_property
    def _usable(self) -> Bools:
        """(n₁, n₂, …) true for the cells that are compared with."""
        return np.asarray(self.seen | self.guesses)

    @cached_property
    def _reference(self) -> Reference:
        columns = self.cells.reshape(len(self.cells), -1)[:, self._usable.ravel()]
        return reference(self._by_element(columns.T))

    def _groups(self, mode: str) -> tuple[Ints, Ints]:
        """The numbers of the usable cells, sorted by category of a mode, and where each category begins."""
        categories = np.indices(self.seen.shape)[self._axis(mode)][self._usable]
        return np.argsort(categories, kind="stable"), np.searchsorted(
            np.sort(categories), np.arange(len(self.categories(mode)))
        )

    def _by_element(self, vectors: Array) -> Array:
        """(N, E, T·3) of vectors (N, T·E·3)."""
        count, elements = len(vectors), len(self.elements)
        return vectors.reshape(count, -1, elements, 3).transpose(0, 2, 1, 3).reshape(count, elements, -1)

    def vectors(self, segments: Segments) -> Array:
        """(N, T·E·3) the segments as columns of the tensor; elements that the model does not have are left out.

        Raises
        ------
        MetricError
            If there is none, or they lack elements of the model, or have other moments; what is missing is named.
        """
        if not len(segments):
            raise MetricError("no segment to recognise; give one at least")
        missing = ", ".join(name for name in self.elements if name not in segments.elements)
        if missing or segments.positions.shape[1] != self.moments:
            raise MetricError(
                f"probes of {segments.positions.shape[1]} moments and {len(segments.elements)} elements "
                f"({f'without {missing}' if missing else 'all that are needed'}); the model has "
                f"{self.moments} moments of {', '.join(self.elements)}: make both with the same points"
            )
        chosen = [segments.elements.index(name) for name in self.elements]
        return segments.positions[:, :, chosen].reshape(len(segments), -1)
