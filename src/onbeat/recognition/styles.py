"""One's task in another's style: the core of the tensor with the person's mode vector swapped.

``P = Q ×₁ S_position ×₂ S_people ×₃ S_task``: with the row of a person in place of ``S_people`` what is left is a
matrix ``A_p`` from task vectors to segments. A segment x of person a is the task vector t that explains it best,
``min_t ‖A_a t − x‖² + λ‖t − t₀‖²`` with t₀ that of the known task, and in the style of person b it is ``A_b t``.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Positions
from onbeat.errors import MetricError
from onbeat.motion.motion import Motion
from onbeat.recognition.placing import placed
from onbeat.recognition.segments import Segments
from onbeat.recognition.tensor import TensorModel

RIDGE = 0.01
"""λ as a share of the mean squared length of the columns of A."""
_LEFT_OUT, _LEAST_RANK = 24, 2


def style_model(segments: Segments) -> TensorModel:
    """The model that tells best what it has not seen: its ranks are chosen by leaving out one cell after the other.

    All that are tried keep the positions whole and as many columns of people as of tasks. Which is nearest to the
    cells left out, in the mean over up to 24 of them, is fitted to all.

    Parameters
    ----------
    segments : S segments whose task and person are known.

    Raises
    ------
    MetricError
        If there is no segment, or a task or person is not known.

    Examples
    --------
    >>> lifts = np.zeros((4, 3, 1, 3))
    >>> lifts[:, :, 0, 2] = [[0, 1, 2], [0, 2, 4], [2, 1, 0], [4, 2, 0]]
    >>> known = Segments(lifts, [1.0] * 4, ("up", "up", "down", "down"), "ABAB", [0] * 4, ("left_wrist",), [6])
    >>> style_model(known).categories("person")
    ('A', 'B')
    """
    pairs = np.array(list(zip(segments.task, segments.person, strict=True)), object).reshape(-1, 2)
    tasks, people = (len(set(column.tolist())) for column in pairs.T)
    most = min(tasks, people)
    cells = sorted(set(map(tuple, pairs.tolist())))
    cells = [cells[i] for i in np.unique(np.linspace(0, len(cells) - 1, _LEFT_OUT).astype(np.int64)).tolist()]
    ranks = [(None, rank, rank) for rank in range(_LEAST_RANK, most)]
    errors: list[list[float]] = []
    for task, person in cells:
        gone = np.asarray((pairs == (task, person)).all(axis=1))
        rest = segments[~gone]
        if task in rest.task and person in rest.person:
            truth = segments[gone].positions.mean(axis=0)
            made = [TensorModel.fit(rest, rank).reconstruct(task, person) for rank in (None, *ranks)]
            errors.append([float(np.square(one - truth).mean()) for one in made])
    chosen = int(np.mean(errors, axis=0).argmin()) if errors else 0
    return TensorModel.fit(segments, (None, *ranks)[chosen])


def style_matrix(model: TensorModel, person: str) -> Array:
    """(T·E·3, r) A_p: from task vectors to a person's segments; the mean of further modes."""
    factors = list(model.parts.factors)
    found = model.parts.core
    for mode, name in enumerate(model.modes, start=1):
        if name == "person":
            row = factors[mode][[model.index("person", person)]]
        else:
            row = np.eye(factors[mode].shape[1]) if name == "task" else factors[mode].mean(axis=0, keepdims=True)
        factors[mode] = row
    found = model.parts.product(factors)
    return found.reshape(len(found), -1)


def task_vectors(model: TensorModel, segments: Segments, person: str) -> Array:
    """(S, r) the task vectors that explain segments of a person best; near that of the known task, where it is one."""
    a = style_matrix(model, person)
    rows = model.parts.factors[1 + model.modes.index("task")]
    known = model.categories("task")
    usual = np.stack([rows[known.index(t)] if t in known else rows.mean(axis=0) for t in segments.task])
    x = model.vectors(segments)
    gram = a.T @ a
    ridge = max(RIDGE * float(np.trace(gram)) / len(gram), 1e-30) * np.eye(len(gram))
    better = usual + np.linalg.solve(gram + ridge, a.T @ (x - usual @ a.T).T).T
    return np.asarray(better, np.float64)


def restyled(model: TensorModel, segments: Segments, source: str, target: str, keep: float = 1.0) -> Positions:
    """(S, T, E, 3) body sizes: segments that ``source`` danced, as ``target`` would.

    What the tensor does not explain of a segment (what is of this take only, or of a task that it does not know) is
    kept, or a share ``keep`` of it: 0 comes nearest to other takes of ``target``, 1 loses nothing.

    Raises
    ------
    MetricError
        If the model does not know one of the two, or there is no segment, or one that lacks points of the model's.

    Examples
    --------
    >>> lifts = np.zeros((4, 3, 1, 3))
    >>> lifts[:, :, 0, 2] = [[0, 1, 2], [0, 2, 4], [2, 1, 0], [4, 2, 0]]  # B does all twice as high
    >>> known = Segments(lifts, [1.0] * 4, ("up", "up", "down", "down"), "ABAB", [0] * 4, ("left_wrist",), [6])
    >>> restyled(TensorModel.fit(known), known[[0]], "A", "B")[0, :, 0, 2].round(6).tolist()[1:]
    [2.0, 4.0]
    """
    if not 0 <= keep <= 1:
        raise MetricError(f"a share of {keep} of the take to keep; 0 to 1 is needed")
    x = model.vectors(segments)
    vectors = task_vectors(model, segments, source)
    as_source, as_target = (vectors @ style_matrix(model, person).T for person in (source, target))
    return (as_target + keep * (x - as_source)).reshape(len(x), model.moments, -1, 3)


def danced_by(
    model: TensorModel, task: str, person: str, base: Motion, name: str = "", seconds: float | None = None
) -> Motion:
    """A playable motion: a task as a person of the model dances it, or would, on the body of ``base``.

    Feet stand where they should if the model is of segments seen from their start (``frame="start"``); those seen from
    the body have no path of their own, and feet slide over that of ``base``.

    Parameters
    ----------
    model : of tasks and people.
    task, person : that the model knows; whether it saw both together or not.
    base : a motion of the body that is to dance, see :func:`onbeat.recognition.placing.placed`.
    name : of the new motion.
    seconds : how long it is to be; None for as long as the model guesses.

    Raises
    ------
    MetricError
        If the model knows no such task or person, lacks points that a body needs, or the length cannot be.
    """
    long = model.length(task, person)[0] if seconds is None else seconds
    points = model.reconstruct(task, person)
    return placed(points, model.elements, base, long, name or f"{task} by {person}")
