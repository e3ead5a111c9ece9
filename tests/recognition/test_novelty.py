"""Thresholds are learned from scores; shares are probabilities."""

from __future__ import annotations

import numpy as np

from onbeat.recognition.novelty import Novelty, auroc, one_more, shares, sharpness


def test_the_threshold_lies_between_two_kinds_that_are_apart():
    learned = Novelty.of(np.linspace(0, 1, 50), np.linspace(3, 4, 50))
    assert 0.9 < learned.threshold < 3
    assert learned.probability(np.array([0.0]))[0] > 0.9 > 0.1 > learned.probability(np.array([4.0]))[0]


def test_where_they_overlap_both_kinds_count_alike():
    rng = np.random.default_rng(0)
    known, new = rng.normal(0, 1, 2000), rng.normal(1.5, 1, 40)
    assert abs(Novelty.of(known, new).threshold - 0.85) < 0.4


def test_with_nothing_known_nothing_is_new():
    assert Novelty.of(np.full(3, np.inf), np.zeros(0)).known(np.array([1e9])).all()


def test_auroc_counts_pairs():
    rng = np.random.default_rng(0)
    known, new = rng.integers(0, 5, 30).astype(float), rng.integers(2, 8, 20).astype(float)
    pairs = (new[None] > known[:, None]).mean() + 0.5 * (new[None] == known[:, None]).mean()
    assert abs(auroc(known, new) - pairs) < 1e-12
    assert np.isnan(auroc(known, new[:0]))


def test_shares_are_sharper_where_the_scores_are_better():
    own = np.repeat(np.arange(3), 10)
    apart = np.where(np.arange(3) == own[:, None], 0.0, 2.0)
    vague = apart + np.random.default_rng(0).normal(0, 2, apart.shape)
    assert sharpness(apart, own) > sharpness(vague, own)
    np.testing.assert_allclose(shares(vague, 3.0).sum(axis=1), 1.0)


def test_a_bound_on_the_known_is_judged_by_what_is_new():
    rng = np.random.default_rng(0)
    bound, new = rng.normal(0, 1, 2000), rng.normal(1.5, 0.3, 2000)
    loose, strict = (Novelty.of(bound, new, bound=how) for how in (False, True))
    assert strict.threshold <= loose.threshold
    assert (~strict.known(new)).mean() >= 0.94
    near = Novelty.of(bound, rng.normal(-3, 0.3, 2000), bound=True)
    assert near.known(bound).mean() >= 0.5


def test_among_one_class_more_the_nearest_is_nearer():
    rng = np.random.default_rng(0)
    # The least of n uniform distances falls as 1 / n.
    scores = np.log(rng.uniform(size=(200_000, 5)))
    assert abs(np.median(one_more(scores[:, :4])) - np.median(scores.min(axis=1))) < 0.1
    assert np.median(one_more(scores[:, :4])) < np.median(scores[:, :4].min(axis=1))


def test_one_class_alone_and_none_stay_as_they_are():
    assert one_more(np.array([[0.3, np.inf], [np.inf, np.inf]])).tolist() == [0.3, np.inf]
    assert one_more(np.array([[0.3]])).tolist() == [0.3]
