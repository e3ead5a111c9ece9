"""A song in memory, at its own pace."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import AudioError
from onbeat.live.sound.array_source import ArraySource

RATE = 8000


class Clock:
    def __init__(self) -> None:
        self.now = 50.0

    def __call__(self) -> float:
        return self.now


def song(seconds: float = 4.0, **how: object) -> tuple[ArraySource, Clock, np.ndarray]:
    clock, samples = Clock(), np.arange(round(seconds * RATE), dtype=np.float32)[:, None] / 1e6
    source = ArraySource(samples, RATE, clock=clock, **how)  # type: ignore[arg-type]
    source.start()
    return source, clock, samples


def played(source: ArraySource, clock: Clock, steps: list[float]) -> np.ndarray:
    out = list[np.ndarray]()
    for step in steps:
        clock.now += step
        out += [block for block, _ in source.read()]
    return np.concatenate(out) if out else np.zeros((0, 1))


def test_just_what_is_due_is_given():
    source, clock, samples = song()
    assert source.read() == []
    assert np.array_equal(played(source, clock, [0.01] * 33), samples[: round(0.33 * RATE)])
    assert source.position == pytest.approx(0.33)
    assert (source.seconds, source.state) == (4.0, "sound")


def test_all_of_it_comes_in_order_whatever_the_pauses():
    source, clock, samples = song()
    assert np.array_equal(played(source, clock, [0.3, 1.2, 0.0, 0.0, 0.01, 1.9, 0.1, 0.1, 0.4, 0.4, 2.0, 0.5]), samples)
    source.read()
    assert source.state == "ended"
    assert source.read() == []
    assert source.notes() == []


def test_after_a_long_pause_the_song_has_waited_and_says_so_once():
    source, clock, samples = song()
    first = played(source, clock, [60.0])
    assert len(first) == 0.5 * RATE
    rest = played(source, clock, [0.01] * 152)  # two seconds are made up for; then it goes on at its pace
    assert len(first) + len(rest) == pytest.approx((2.0 + 1.52) * RATE, abs=1)
    assert len(played(source, clock, [60.0])) > 0
    assert source.notes() == ["this machine was too busy for a moment: the song has waited 58.0 s"]
    assert np.array_equal(np.concatenate((first, rest)), samples[: len(first) + len(rest)])


def test_it_is_sped_up_and_begins_again():
    source, clock, samples = song(1.0, speed_up=10.0, loop=True)
    out = played(source, clock, [0.01] * 25)
    assert np.array_equal(out, np.tile(samples, (3, 1))[: len(out)])
    assert len(out) == pytest.approx(2.5 * RATE, abs=1)
    assert source.position == pytest.approx(0.5, abs=0.001)
    source.close()
    assert (source.read(), source.state) == ([], "ended")


@pytest.mark.parametrize(
    ("samples", "rate", "speed_up"),
    [
        (np.zeros(0), RATE, 1.0),
        (np.zeros((2, 2, 2)), RATE, 1.0),
        (np.zeros(9), 0, 1.0),
        (np.zeros(9), RATE, 0.0),
        (np.zeros(9), RATE, float("nan")),
        (np.zeros(9, int), RATE, 1.0),
    ],
)
def test_what_is_no_song_is_refused(samples: np.ndarray, rate: int, speed_up: float):
    with pytest.raises(AudioError, match="expected"):
        ArraySource(samples, rate, speed_up)
