"""Segments that tests of recognition share: a few moves by a few people, made of sines, no take like another."""

from __future__ import annotations

import numpy as np

from onbeat.recognition.features import NEEDED
from onbeat.recognition.segments import Segments, links_of

ELEMENTS = (*NEEDED, "left_elbow", "right_elbow", "left_wrist", "right_wrist")
REST = np.array(
    [[0, 0, 0], [-0.2, 0, 0.6], [0.2, 0, 0.6], [-0.1, 0, 0], [0.1, 0, 0], [-0.3, 0, 0.3], [0.3, 0, 0.3],
     [-0.3, 0.1, 0], [0.3, 0.1, 0]]
)  # fmt: skip
TASKS = ("circle", "lift", "push", "wave", "clap", "bow")
PEOPLE = ("Ana", "Ben", "Cid", "Dora", "Eva", "Finn", "Gil", "Hanna")


def takes(count: int = 3, seed: int = 0, noise: float = 0.01, tasks: int = 4, people: int = 4) -> Segments:
    """``count`` takes of each task by each person: arms move by the task, posture and size by the person."""
    rng = np.random.default_rng(seed)
    fixed = np.random.default_rng(7)
    waves = fixed.normal(size=(len(TASKS), 2, 3, 4, 3))  # sines and cosines of three rates at four elements
    stances = 0.05 * fixed.normal(size=(len(PEOPLE), 4, 3))
    sizes = (0.7, 0.9, 1.1, 1.4) * 2
    turn = 2 * np.pi * np.arange(1, 4)[:, None] * np.linspace(0, 1, 16)
    places, task, person, cycle = [], [], [], []
    for t in range(tasks):
        for p in range(people):
            for take in range(count):
                late = turn + 0.2 * rng.normal()
                move = np.einsum("rt,rec->tec", np.sin(late), waves[t, 0])
                move += np.einsum("rt,rec->tec", np.cos(late), waves[t, 1])
                made = np.tile(REST, (16, 1, 1))
                made[:, 5:] += 0.1 * sizes[p] * move + stances[p]
                places.append(made + noise * rng.normal(size=made.shape))
                task.append(TASKS[t])
                person.append(PEOPLE[p])
                cycle.append(take)
    durations = 1.0 + 0.05 * rng.normal(size=len(places))
    return Segments(np.array(places), durations, tuple(task), tuple(person), cycle, ELEMENTS, links_of(ELEMENTS))
