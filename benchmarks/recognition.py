"""Who dances what: the recogniser, the paper's tensor vote and simple baselines, on the same probes in one run.

    python benchmarks/recognition.py [FOLDER] [--quick] [--only NAME]

FOLDER holds gestures, one a file, named ``task_style_take.bvh``, such as Bandai-Namco-Research-Motiondataset-2. The
embedded troupe, made hard, comes after: six variations of one figure, and six pieces of a dance. What is chosen and
where the thresholds lie is found by cross-validation inside the segments that teach. Each table says on stderr how far
it has come. All is done in under ten minutes, ``--quick`` in about two.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from collections.abc import Mapping
from itertools import product
from pathlib import Path

import numpy as np

from onbeat.formats import read_motion
from onbeat.recognition.calibration import calibration_error, reliability
from onbeat.recognition.hard_troupe import VARIATIONS, hard_pieces, hard_troupe
from onbeat.recognition.protocols import (
    FACTORS,
    PAPER,
    Learner,
    OpenScore,
    both_new,
    crossed,
    known_set,
    labels,
    open_set,
    paper_tables,
)
from onbeat.recognition.recogniser import Prediction, Recogniser
from onbeat.recognition.segments import Segments, segments_of
from recognition_baselines import learners, literal, ours_across

HARDNESS = (0.0, 0.25, 0.5, 0.75, 1.0)
QUICK = (0.0, 0.5)
SEED = 0
BEGIN = time.perf_counter()


def gestures(folder: Path) -> Segments:
    """Every ``task_style_take.bvh`` of a folder as one segment, seen from the body."""
    named = [(path, path.stem.rsplit("_", 2)) for path in sorted(folder.glob("*_*_*.bvh"))]
    counts = [sum(other[:2] == name[:2] for _, other in named) for _, name in named]
    named = [one for one, count in zip(named, counts, strict=True) if count > 1]
    motions = [read_motion(path) for path, _ in named]
    spans = [(0.0, (len(motion) - 1) / motion.fps) for motion in motions]
    tasks, people, takes = zip(*(name for _, name in named), strict=True)
    return segments_of(motions, spans, tasks, people, [int(take) - 1 for take in takes], frame="body")


def rng() -> np.random.Generator:
    return np.random.default_rng(SEED)


def main_table(segments: Segments, rows: Mapping[str, Learner]) -> None:
    """Known set and crossed factors."""
    print(f"\n{'':24s}" + "".join(f"{title:>21s}" for title in (
        "closed: task", "closed: person", "task, unseen person", "person, unseen task")) + "   ms a probe")  # fmt: skip
    for name, learner in rows.items():
        known = known_set(segments, learner, rng())
        cells = [str(known[f]) for f in FACTORS] + [str(crossed(segments, learner, f, rng())) for f in FACTORS]
        print(f"{name:24s}" + "".join(f"{cell:>21s}" for cell in cells) + f"{probe_time(segments, learner):13.2f}",
              flush=True)  # fmt: skip


def probe_time(segments: Segments, learner: Learner) -> float:
    """Milliseconds to answer one probe alone: the median of thirty."""
    answer, took = learner(segments[segments.cycle == 0], rng()), []
    probes = np.flatnonzero(segments.cycle > 0)[:31]
    for at in probes:
        begin = time.perf_counter()
        answer(segments[[at]])
        took.append(1000 * (time.perf_counter() - begin))
    return float(np.median(took[1:]))


def open_table(segments: Segments, rows: Mapping[str, Learner], cycles: tuple[int, ...], *, both: bool) -> None:
    """New tasks, new people, and both new at once."""
    takes = " and ".join(str(cycle + 1) for cycle in cycles)
    print(
        f"\nopen set, two left out in all combinations, take {takes} to learn from: AUROC · known and right · new found"
    )
    titles = ("new task", "new person", *(("both alien: task", "both alien: person") if both else ()))
    print(f"{'':24s}" + "".join(f"{title:>54s}" for title in titles))
    for name, learner in rows.items():
        found = [open_set(segments, learner, factor, rng(), cycles) for factor in FACTORS]
        found += list(both_new(segments, learner, rng(), cycles).values()) if both else []
        print(f"{name:24s}" + "".join(f"{shown(one, name, len(cycles)):>54s}" for one in found), flush=True)


def shown(one: OpenScore, name: str, takes: int) -> str:
    """With rates at the threshold where there is one: the tensor's is learned from a second take."""
    if name == "ours" or ("MFT" in name and takes > 1):
        return f"{one.auroc:.3f} · {one.known_and_right!s:>19s} · {one.new_found!s:>19s}"
    return f"{one.auroc:.3f} · {'no threshold':>19s} · {'':>19s}"


def told(what: str) -> None:
    """Progress, on stderr."""
    print(f"[{time.perf_counter() - BEGIN:5.0f} s] {what}", file=sys.stderr, flush=True)


def variations(hardness: float) -> Segments:
    return hard_troupe(hardness, rng(), VARIATIONS, takes=5)


def pieces(hardness: float) -> Segments:
    return hard_pieces(hardness, rng(), takes=5)


def troupe(rows: Mapping[str, Learner], *, quick: bool) -> None:
    """The paper's protocols, the harder the less the dancers are themselves; then the crossed ones."""
    for make, what in ((variations, "6 variations of one figure"), (pieces, "6 pieces of the folk dance")):
        for hardness in QUICK if quick else HARDNESS:
            told(f"{what}, hardness {hardness:g}")
            paper(make(hardness), f"{what} by 8 people, hardness {hardness:g}", rows)
        told(f"{what}: known, crossed and new")
        segments = make(0.5)
        print(f"\n{what} by 8 people, hardness 0.5: take 1 to learn from, and across the factors")
        main_table(segments, rows)
        some = {k: v for k, v in rows.items() if k == "ours" or "learned" in k}
        for cycles in ((0, 1),) if quick else ((0,), (0, 1)):
            open_table(segments, some, cycles, both=False)
        if "ours" in rows:
            calibration(segments, what)
            guesses(segments, what)


def calibration(segments: Segments, what: str, cycles: tuple[int, ...] = (0, 1)) -> None:
    """Of the probabilities said, how many are right: with all known, and with each second class new in turn.

    What is said supposes that a probe is as likely new as known; so as many known ones as new ones are asked about.
    """
    print(f"\n{what}: probability said / right (answers); a new one's nearest is never right")
    teach = np.isin(segments.cycle, cycles)
    probes = segments[~teach]
    for factor in FACTORS:
        own = labels(segments, factor)
        for title, outs in (("all known", [""]), ("half new", np.unique(own)[::2].tolist())):
            found = [spoken(segments[teach & (own != out)], _half(probes, factor, out), factor) for out in outs]
            said, right = (np.concatenate(parts) for parts in zip(*found, strict=True))
            bins = "  ".join(f"{b.said:.2f}/{b.right:.2f} ({b.answers})" for b in reliability(said, right) if b.answers)
            print(f"{factor:8s}{title:12s} off by {calibration_error(said, right):.3f}:  {bins}", flush=True)


def guesses(segments: Segments, what: str, cycles: tuple[int, ...] = (0, 1)) -> None:
    """What is said of steps by new persons, and persons in a new one: each task with each person left out in turn."""
    teach, said = np.isin(segments.cycle, cycles), dict[str, Counter[str]]()
    task, person = labels(segments, "task"), labels(segments, "person")
    for one, other in product(np.unique(task).tolist(), np.unique(person).tolist()):
        taught = segments[teach & (task != one) & (person != other)]
        found = Recogniser.train(taught, rng(), newcomers=True).predict(segments[~teach])
        for answer, t, p in zip(found, task[~teach].tolist(), person[~teach].tolist(), strict=True):
            kind = f"{'new' if t == one else 'known'} task, {'new' if p == other else 'known'} person"
            said.setdefault(kind, Counter())[_guess(answer, t, p)] += 1
    print(f"\n{what}: what is said where one task and one person are new")
    for kind, counts in sorted(said.items()):
        shares = (f"{name} {count / counts.total():.3f}" for name, count in counts.most_common())
        print(f"{kind:26s}{counts.total():5d}: {', '.join(shares)}", flush=True)


def _guess(answer: Prediction, task: str, person: str) -> str:
    """In words: known in one or both, a guess and whether its name is right, or new in both."""
    if answer.perhaps is None:
        known = [factor for factor in FACTORS if answer.said(factor)]
        return f"known {' and '.join(known)}" if known else "new in both"
    right = answer.said(answer.perhaps) == (task if answer.perhaps == "task" else person)
    return f"perhaps a {answer.perhaps} ({'right' if right else 'wrong'})"


def _half(probes: Segments, factor: str, new: str) -> Segments:
    """Those of a new class, and as many others; all where none is new."""
    if not new:
        return probes
    own = labels(probes, factor)
    news = np.flatnonzero(own == new)
    return probes[np.concatenate((news, rng().permutation(np.flatnonzero(own != new))[: len(news)]))]


def spoken(teach: Segments, probes: Segments, factor: str) -> tuple[np.ndarray, np.ndarray]:
    """Of each probe the probability of the likeliest class, and whether it is right."""
    found = Recogniser.train(teach, rng()).predict(probes)
    likeliest = [(one.task_scores if factor == "task" else one.person_scores)[0] for one in found]
    return np.array([one.probability for one in likeliest]), np.array([one.name for one in likeliest]) == labels(
        probes, factor
    )


def paper(segments: Segments, title: str, rows: Mapping[str, Learner]) -> None:
    """Tables 3 to 5, two takes to learn from; Table 4's ε is 0.05, Table 5's 0.12."""
    print(f"\n{title}: Tables 3–5")
    print(f"{'':24s}" + "".join(f"{title.replace('_', ' '):>26s}" for title in PAPER) + "   ms a probe")
    print(f"{'the paper':24s}" + "".join(f"{f'{right}/{of} {right / of:.3f}':>26s}" for right, of in PAPER.values())
          + "  40–70 thousand")  # fmt: skip
    for name, learner in rows.items():
        if name == "ours":
            loose = ours_across
        elif name == "literal MFT, paper's ε":
            learner, loose = literal((0.05, 0.05)), literal((0.12, 0.12))
        else:
            loose = None
        found = paper_tables(segments, learner, rng(), loose, (0, 1))
        cells = [f"{one.right}/{one.of} {one!s}" for one in found]
        if not ("ours" in name or "MFT" in name):
            cells = [*cells[:2], *["–"] * 4]
        took = probe_time(segments, learner)
        print(f"{name:24s}" + "".join(f"{cell:>26s}" for cell in cells) + f"{took:13.2f}", flush=True)


def big(count: int = 10_000) -> None:
    """How long training on many segments takes, and a probe thereafter."""
    few, draw = variations(0.5), rng()
    at = draw.integers(0, len(few), count)
    places = few.positions[at] + draw.normal(0, 0.01, (count, *few.positions.shape[1:]))
    many = Segments(places, few.durations[at], [few.task[i] for i in at], [few.person[i] for i in at],
                    np.arange(count) % 7, few.elements, few.links)  # fmt: skip
    begin = time.perf_counter()
    model = Recogniser.train(many, rng())
    print(f"\ntraining on {count} segments: {time.perf_counter() - begin:.1f} s; ", end="")
    took = []
    for i in range(30):
        begin = time.perf_counter()
        model.predict(many[[i]])
        took.append(1000 * (time.perf_counter() - begin))
    views = [[option.view for option in e.choice.options] for e in (model.task, model.person) if e]
    print(f"a probe {np.median(took):.1f} ms; by {views}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?")
    parser.add_argument("--quick", action="store_true", help="less of everything")
    parser.add_argument("--only", help="only the rows whose name holds this")
    parser.add_argument("--no-troupe", action="store_true")
    options = parser.parse_args()
    rows = {name: learner for name, learner in learners().items() if not options.only or options.only in name}
    if options.folder is not None:
        segments = gestures(options.folder)
        print(f"{options.folder.name}: {len(segments)} gestures, {len(set(segments.task))} tasks by "
              f"{len(set(segments.person))} people or styles")  # fmt: skip
        told("gestures: known and crossed")
        main_table(segments, rows)
        for cycles in ((0,), (0, 1)):
            told(f"gestures: what is new, {len(cycles)} to learn from")
            open_table(segments, {k: v for k, v in rows.items() if "Mini" not in k}, cycles, both=not options.quick)
        if "ours" in rows:
            calibration(segments, "gestures")
            guesses(segments, "gestures")
    if not options.no_troupe:
        troupe(rows, quick=options.quick)
        told("many segments")
        big()


if __name__ == "__main__":
    main()
