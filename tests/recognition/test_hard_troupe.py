"""The hard troupe: as hard as it is said to be."""

from __future__ import annotations

import numpy as np

from onbeat.recognition.alignment import elastic_distances
from onbeat.recognition.features import views_of
from onbeat.recognition.hard_troupe import VARIATIONS, hard_pieces, hard_troupe


def nearest(hardness: float) -> tuple[float, float]:
    """Task and person of a second take, by the nearest of the first ones."""
    some = hard_troupe(hardness, np.random.default_rng(0), VARIATIONS, takes=2)
    first, second = (some[some.cycle == take] for take in (0, 1))
    view = "elastic poses"
    at = elastic_distances(views_of(second, [view])[view], views_of(first, [view])[view], 0.0).argmin(axis=1)
    pairs = ((first.task, second.task), (first.person, second.person))
    found = [np.mean([a[i] == b for i, b in zip(at.tolist(), of, strict=True)]) for a, of in pairs]
    return float(found[0]), float(found[1])


def test_variations_share_all_but_one_hand_in_one_keypose():
    assert len({figure.name for figure in VARIATIONS}) == 6
    plain = VARIATIONS[0].hands
    for figure in VARIATIONS[1:]:
        (beat,) = (beat for beat in plain if figure.hands[beat] != plain[beat])
        hands = zip(plain[beat].split(" | "), figure.hands[beat].split(" | "), strict=True)
        assert sum(a != b for a, b in hands) == 1


def test_as_written_the_nearest_is_right_and_the_harder_the_less():
    easy, middle, hard = (nearest(hardness) for hardness in (0.0, 0.5, 1.0))
    assert min(easy) == 1
    assert 0.3 < middle[1] < middle[0] < 0.95
    assert hard[0] < middle[0]
    assert hard[1] < middle[1]


def test_the_same_generator_gives_the_same_takes():
    a, b = (hard_pieces(0.5, np.random.default_rng(3), pieces=2, takes=1) for _ in range(2))
    assert np.array_equal(a.positions, b.positions)
