"""A step in a style that was never seen with it: how near the tensor's is to the real takes.

    python benchmarks/styles.py FOLDER [--neutral normal]

FOLDER holds gestures, one a file, named ``task_style_take.bvh``. Each task in each style but the neutral one is left
out in turn; two takes of all others teach, and the step is put together from its task and its style. Its distance from
the real takes (root mean square over moments and parts of the body, cm) stands beside that of the neutral takes of the
same step, which is what one had without a model, and beside that of the real takes from each other.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from onbeat.recognition.segments import Segments
from onbeat.recognition.styles import style_model
from recognition import gestures


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--neutral", default="normal")
    flags = parser.parse_args()
    found = gestures(flags.folder)
    takes = found[np.isin(found.cycle, (0, 1))]
    tasks, styles = np.array(takes.task), np.array(takes.person)
    rows = []
    for task in sorted(set(tasks)):
        for style in sorted(set(styles) - {flags.neutral}):
            gone = (tasks == task) & (styles == style)
            rows.append(row(takes, gone, (tasks == task) & (styles == flags.neutral), task, style))
            figures = zip(("made", "neutral", "repeated"), rows[-1], strict=True)
            print(f"  {task:24} {style:12} " + ", ".join(f"{name} {cm:5.1f} cm" for name, cm in figures))
    made, neutral, repeated = np.array(rows).T
    print(
        f"{len(rows)} left out in turn: made {made.mean():.1f} cm from the real takes, neutral {neutral.mean():.1f}, "
        f"repetitions {repeated.mean():.1f}; nearer than neutral in {int((made < neutral).sum())}"
    )


def row(takes: Segments, gone: np.ndarray, neutral: np.ndarray, task: str, style: str) -> tuple[float, float, float]:
    """Of one that is left out: centimetres of what is made, of the neutral takes, and of its takes from each other."""
    real = takes[gone].positions
    made = style_model(takes[~gone]).reconstruct(task, style)
    size = 100.0 * float(takes[gone].sizes.mean())
    plain = takes[neutral].positions
    return (
        size * distance(real, made[None]),
        size * float(np.mean([distance(real, one[None]) for one in plain])),
        size * float(np.mean([distance(np.delete(real, k, axis=0), real[k][None]) for k in range(len(real))])),
    )


def distance(real: np.ndarray, other: np.ndarray) -> float:
    """Body sizes, the root mean square over moments and elements, in the mean over takes."""
    return float(np.sqrt(np.square(real - other).sum(axis=3).mean(axis=(1, 2))).mean())


if __name__ == "__main__":
    main()
