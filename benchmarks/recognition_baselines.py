"""Simple recognisers to stand beside: literal tensor vote, nearest neighbours, a linear SVM, MiniRocket.

Each is a learner of ``onbeat.recognition.protocols``. A margin is minus the distance to the nearest class (minus the
likeliest class's score where there is no distance), so that AUROC can be had; none but the tensor has a threshold.
scikit-learn and aeon are not needed by onbeat; where they are not installed, their rows are left out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from onbeat.errors import MetricError
from onbeat.recognition.alignment import elastic_distances
from onbeat.recognition.choice import nearest
from onbeat.recognition.features import views_of
from onbeat.recognition.open_set import learn
from onbeat.recognition.protocols import FACTORS, Learner, labels
from onbeat.recognition.recogniser import Recogniser
from onbeat.recognition.segments import Segments
from onbeat.recognition.tensor import TensorModel

BAND = 0.1


class Said(NamedTuple):
    """An answer of a baseline."""

    task: str
    person: str
    margins: tuple[float, float]


def said(names: Sequence[Sequence[str]], margins: Sequence[Sequence[float]]) -> list[Said]:
    return [Said(t, p, (float(a), float(b))) for t, p, a, b in zip(*names, *margins, strict=True)]


def ours(segments: Segments, rng: np.random.Generator) -> Callable[[Segments], Any]:
    return Recogniser.train(segments, rng).predict


def ours_across(segments: Segments, rng: np.random.Generator) -> Callable[[Segments], Any]:
    return Recogniser.train(segments, rng, across=True).predict


def literal(epsilons: tuple[float, float] | None) -> Learner:
    """The paper's vote; ε of task and person as the paper sets them, or None for thresholds learned from takes."""

    def train(segments: Segments, rng: np.random.Generator) -> Callable[[Segments], list[Said]]:
        model = TensorModel.fit(segments)
        modes: dict[str, Any] = {}
        for factor, epsilon in zip(FACTORS, epsilons or (None, None), strict=True):
            try:
                modes[factor] = learn(segments, factor, epsilon=epsilon)
            except MetricError:  # one take of each: nothing to learn a threshold from
                modes[factor] = None

        def answer(probes: Segments) -> list[Said]:
            names, margins = [], []
            for factor, judge in modes.items():
                found = model.match(probes, factor)
                names.append(found.best)
                margins.append(-found.values.min(axis=1) if judge is None else judge.judge(found).margins)
            return said(names, margins)

        return answer

    return train


def neighbours(view: str, band: float, *, whole: bool = False) -> Learner:
    """1-NN on a view: Euclidean with ``band`` 0, else DTW."""

    def train(segments: Segments, rng: np.random.Generator) -> Callable[[Segments], list[Said]]:
        kept = _paths(segments, view)

        def answer(probes: Segments) -> list[Said]:
            distances = elastic_distances(_paths(probes, view), kept, band)
            names, margins = [], []
            for factor in FACTORS:
                known, at = np.unique(labels(segments, factor), return_inverse=True)
                table = nearest(distances, at, len(known))
                names.append(known[table.argmin(axis=1)].tolist())
                margins.append(-table.min(axis=1))
            return said(names, margins)

        return answer

    return train


def _paths(segments: Segments, view: str) -> np.ndarray:
    return views_of(segments, [view])[view]


def classifiers(make: Callable[[], Any], shape: Callable[[np.ndarray], np.ndarray], view: str) -> Learner:
    """A classifier each for task and person."""

    def train(segments: Segments, rng: np.random.Generator) -> Callable[[Segments], list[Said]]:
        values = shape(_paths(segments, view))
        fitted = [make().fit(values, labels(segments, factor)) for factor in FACTORS]

        def answer(probes: Segments) -> list[Said]:
            values = shape(_paths(probes, view))
            names = [one.predict(values).tolist() for one in fitted]
            margins = [_confidence(one, values) for one in fitted]
            return said(names, margins)

        return answer

    return train


def _confidence(fitted: Any, values: np.ndarray) -> np.ndarray:
    if not hasattr(fitted, "decision_function"):
        return fitted.predict_proba(values).max(axis=1)
    scores = fitted.decision_function(values)
    return np.abs(scores) if scores.ndim == 1 else scores.max(axis=1)


def svm(view: str) -> Learner:
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler
    from sklearn.svm import SVC

    return classifiers(
        lambda: make_pipeline(StandardScaler(), SVC(kernel="linear")), lambda x: x.reshape(len(x), -1), view
    )


def minirocket() -> Learner:
    """MiniRocket's features, made once for both factors, and its ridge classifier on them."""
    from aeon.transformations.collection.convolution_based import MiniRocket
    from sklearn.linear_model import RidgeClassifierCV
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    def series(segments: Segments) -> np.ndarray:
        return np.ascontiguousarray(_paths(segments, ELASTIC_RAW).transpose(0, 2, 1))

    def train(segments: Segments, rng: np.random.Generator) -> Callable[[Segments], list[Said]]:
        features = MiniRocket(random_state=0)
        values = np.asarray(features.fit_transform(series(segments)))
        heads = [
            make_pipeline(StandardScaler(with_mean=False), RidgeClassifierCV(np.logspace(-3, 3, 10))) for _ in FACTORS
        ]
        for head, factor in zip(heads, FACTORS, strict=True):
            head.fit(values, labels(segments, factor))

        def answer(probes: Segments) -> list[Said]:
            values = np.asarray(features.transform(series(probes)))
            names = [one.predict(values).tolist() for one in heads]
            return said(names, [_confidence(one, values) for one in heads])

        return answer

    return train


ELASTIC_RAW, ELASTIC_COURSE = "elastic poses", "elastic course"


def learners() -> dict[str, Learner]:
    """All rows of the table, ours first."""
    found = {
        "ours": ours,
        "literal MFT, paper's ε": literal((0.12, 0.12)),
        "literal MFT, learned ε": literal(None),
        "1-NN Euclidean": neighbours(ELASTIC_RAW, 0.0),
        "1-NN DTW": neighbours(ELASTIC_RAW, BAND),
        "1-NN DTW, normalised": neighbours(ELASTIC_COURSE, BAND),
    }
    try:
        found["linear SVM"] = svm(ELASTIC_RAW)
        found["linear SVM, normalised"] = svm(ELASTIC_COURSE)
    except ImportError:
        print("scikit-learn is not installed: no SVM")
    try:
        found["MiniRocket"] = minirocket()
    except ImportError:
        print("aeon is not installed: no MiniRocket")
    return found
