"""Where not everyone danced everything: what missing cells cost the multi-factor tensor, and the recogniser.

The first take of each person and task teaches, the others are probes. A share of the cells is taken from the teaching,
at random, ten times. Right answers to task and person, on all probes and on those of the lost cells: by the vote of the
elements (Eq. 14), by the distance alone (Eq. 13 under the weights), each with the lost cells filled and left out, by
the vote at eight columns of position, and by the recogniser. Then the root mean square error of a filled cell beside
that of another take of the same cell, in body sizes.

    python benchmarks/mft_cells.py [FOLDER] [--plot mft_cells.png]

FOLDER holds gestures as ``benchmarks/recognition.py`` reads them; without it only the embedded troupe is measured.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from onbeat.recognition.features import in_body
from onbeat.recognition.hard_troupe import hard_troupe
from onbeat.recognition.recogniser import Recogniser
from onbeat.recognition.segments import Segments
from onbeat.recognition.tensor import TensorModel
from recognition import gestures

SHARES = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)
DRAWS = 10
HARDNESS = 0.25
MODES = ("task", "person")
COLUMNS = ("task", "person", "task, lost", "person, lost")

Answers = list[tuple[str, ...]]
"""The names of all probes, in each mode."""
Table = dict[str, np.ndarray]
"""Of each way (shares, columns) right answers."""


def tensor(way: str, **how: object) -> Callable[[Segments, Segments], Answers]:
    def answer(known: Segments, probes: Segments) -> Answers:
        model = TensorModel.fit(known, **how)  # type: ignore[arg-type]
        return [getattr(model.match(probes, mode), way) for mode in MODES]

    return answer


def recogniser(known: Segments, probes: Segments) -> Answers:
    found = Recogniser.train(known, np.random.default_rng(0)).predict(probes)
    return [tuple(getattr(one, mode) for one in found) for mode in MODES]


WAYS: Mapping[str, Callable[[Segments, Segments], Answers]] = {
    "vote, filled": tensor("best"),
    "vote, left out": tensor("best", guesses=False),
    "vote, filled, rank 8": tensor("best", ranks=(8, None, None)),
    "nearest, filled": tensor("nearest"),
    "nearest, left out": tensor("nearest", guesses=False),
    "recogniser": recogniser,
}


def cells(segments: Segments) -> list[tuple[str, str]]:
    return list(zip(segments.person, segments.task, strict=True))


def kept(known: Segments, share: float, rng: np.random.Generator) -> Segments:
    """The segments without a share of the cells; every person and every task keeps one."""
    order, left = [cells(known)[i] for i in rng.permutation(len(known))], set(cells(known))
    for person, task in order:
        if len(left) <= round((1 - share) * len(known)):
            break
        if sum(p == person for p, _ in left) > 1 and sum(t == task for _, t in left) > 1:
            left.discard((person, task))
    return known[np.array([cell in left for cell in cells(known)])]


def right(answers: Answers, probes: Segments, lost: np.ndarray) -> list[float]:
    """Shares of right answers, in the order of the columns."""
    good = [np.array(names) == np.array(getattr(probes, mode)) for names, mode in zip(answers, MODES, strict=True)]
    return [float(one.mean()) for one in good] + [float(one[lost].mean()) if lost.any() else np.nan for one in good]


def off(known: Segments, probes: Segments, which: np.ndarray) -> float:
    """Root mean square error of cells of the model to the probes of the same cells."""
    model, pairs = TensorModel.fit(known), zip(cells(probes), probes.positions, which, strict=True)
    errors = [model.reconstruct(task, person) - x for (person, task), x, on in pairs if on]
    return float(np.sqrt(np.mean(np.square(errors))))


def table(title: str, segments: Segments) -> Table:
    """Print and return the shares of right answers of each way."""
    known, probes = segments[segments.cycle == 0], segments[segments.cycle > 0]
    print(f"\n{title}: {len(set(known.task))} tasks by {len(set(known.person))} people, {len(probes)} probes")
    print(f"{'':32s}" + "".join(f"{name:>16s}" for name in COLUMNS))
    rows: dict[str, list[np.ndarray]] = {name: [] for name in WAYS}
    for share in SHARES:
        found: dict[str, list[list[float]]] = {name: [] for name in WAYS}
        filled: list[float] = []
        for draw in range(DRAWS if share else 1):
            some = kept(known, share, np.random.default_rng(draw))
            lost = np.array([cell not in set(cells(some)) for cell in cells(probes)])
            for name, way in WAYS.items():
                found[name].append(right(way(some, probes), probes, lost))
            filled += [off(some, probes, lost)] if lost.any() else []
        for name, values in found.items():
            rows[name].append(np.mean(values, axis=0))
            shown = (f"{value:16.3f}" if np.isfinite(value) else f"{'':16s}" for value in rows[name][-1])
            print(f"{share:4.0%} lost, {name:21s}" + "".join(shown), flush=True)
        if filled:
            print(f"{'':11s}a filled cell is {np.mean(filled):.4f} body sizes off")
    print(f"another take of a cell is {off(known, probes, np.ones(len(probes), bool)):.4f} body sizes off")
    return {name: np.array(values) for name, values in rows.items()}


def plot(found: Mapping[str, Table], path: Path) -> None:
    """Right answers over the share of lost cells, a row for each kind of data, a picture for each mode."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    _, axes = plt.subplots(len(found), 2, figsize=(11, 4 * len(found)), squeeze=False, sharey=True)
    for row, (title, ways) in zip(axes, found.items(), strict=True):
        for column, ax in enumerate(row):
            for name, values in ways.items():
                ax.plot(SHARES, values[:, column], ":" if "left out" in name else "-", label=name)
            ax.set(title=f"{title}: {MODES[column]}", xlabel="share of cells lost", ylabel="right answers")
            ax.set_ylim(0, 1.02)
    axes[0, 0].legend(loc="lower left", fontsize=8)
    plt.tight_layout()
    plt.savefig(path, dpi=90)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, help="recorded gestures")
    parser.add_argument("--plot", type=Path, help="picture to write")
    given = parser.parse_args()
    troupe = hard_troupe(HARDNESS, np.random.default_rng(0), takes=3)
    found = {"troupe": table(f"troupe, hardness {HARDNESS:g}", replace(troupe, positions=in_body(troupe)))}
    if given.folder:
        found["gestures"] = table("gestures", gestures(given.folder))
    if given.plot:
        plot(found, given.plot)


if __name__ == "__main__":
    main()
