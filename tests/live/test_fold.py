"""Folding: a danceable tempo that stays what it was when the tracker changes its octave, on the downbeats."""

from __future__ import annotations

import pytest

from onbeat.live.beat.fold import Fold
from onbeat.live.beat.reading import Reading


@pytest.mark.parametrize(
    ("bpm", "meter", "danced"), [(100, 4, 100), (60, 4, 120), (45, 4, 90), (184, 4, 92), (210, 3, 105), (239, 4, 119.5)]
)
def test_every_tempo_is_danced_between_seventy_and_a_hundred_and_forty(bpm: float, meter: int, danced: float) -> None:
    found = Fold(70.0, 140.0).danced(Reading(1.0, 60.0 / bpm, 0, meter), 1.0, 0.0)
    assert 60.0 / found.period == pytest.approx(danced)


@pytest.mark.parametrize("ratio", [0.5, 2.0, 1.0 / 3.0, 3.0])
def test_a_flip_of_the_tracker_does_not_change_what_is_danced(ratio: float) -> None:
    fold = Fold(70.0, 140.0)
    first = fold.danced(Reading(1.0, 0.6, 0, 3), 1.0, 0.0)
    flipped = fold.danced(Reading(4.0, 0.6 * ratio, 0, 3), 4.0, first.period)
    assert flipped.period == pytest.approx(0.6)


def test_a_drift_out_of_the_range_is_folded_late_and_not_back_at_once() -> None:
    fold, period, tempi = Fold(70.0, 140.0), 0.0, list[float]()
    for bpm in [*range(130, 161), *range(160, 119, -1)]:
        period = fold.danced(Reading(1.0, 60.0 / bpm, 0, 4), 1.0, period).period
        tempi.append(60.0 / period)
    flips = [index for index in range(1, len(tempi)) if abs(tempi[index] / tempi[index - 1] - 1.0) > 0.2]
    assert len(flips) == 2
    assert 145 < 130 + flips[0] < 155
    assert 160 - (flips[1] - 31) < 131


def test_of_every_two_beats_the_one_with_the_downbeat_is_danced() -> None:
    fold = Fold(70.0, 140.0)
    danced = fold.danced(Reading(2.0, 0.3, 3, 4), 2.0, 0.0)
    assert danced.time == pytest.approx(2.3) or danced.time == pytest.approx(1.7)
    assert (danced.position, danced.meter) in ((0, 2), (1, 2))


def test_new_downbeats_have_to_last_before_the_dance_goes_over_to_them() -> None:
    fold, times = Fold(70.0, 140.0), list[float]()
    fold.danced(Reading(2.0, 0.3, 0, 4), 2.0, 0.0)
    for beat in range(1, 16):  # the bars are heard a beat later now
        now = 2.0 + 0.6 * beat
        times.append(fold.danced(Reading(now, 0.3, (2 * beat + 1) % 4, 4), now, 0.6).time - now)
    assert times[:4] == pytest.approx([0.0] * 4)
    assert abs(times[-1]) == pytest.approx(0.3)


def test_a_fast_waltz_is_danced_across_its_bars() -> None:
    fold = Fold(70.0, 140.0)
    danced = [fold.danced(Reading(0.3 * beat, 0.3, beat % 3, 3), 0.3 * beat, 0.6) for beat in range(0, 12, 2)]
    assert [one.position for one in danced] == [0, 1, 2, 0, 1, 2]
    assert {one.meter for one in danced} == {3}


def test_beats_that_were_the_musics_own_stay_when_it_is_heard_twice_as_fast() -> None:
    fold = Fold(70.0, 140.0)
    fold.danced(Reading(2.0, 0.6, 0, 4), 2.0, 0.0)
    for beat in range(1, 30):
        now = 2.0 + 0.6 * beat
        assert fold.danced(Reading(now, 0.3, (2 * beat + 1) % 4, 4), now, 0.6).time == pytest.approx(now)
