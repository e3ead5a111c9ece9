"""The way from a device's thread to who reads."""

from __future__ import annotations

import threading

import numpy as np

from onbeat.live.sound.listener import Handover


def numbered(number: int, frames: int = 100) -> np.ndarray:
    return np.full((frames, 1), number, np.float32)


def test_two_threads_hand_over_everything_in_order():
    way, taken = Handover(seconds=1e9), list[float]()
    giver = threading.Thread(target=lambda: [way.put(numbered(number), 8000) for number in range(2000)])
    giver.start()
    while giver.is_alive():
        taken += [float(block[0, 0]) for block, _ in way.take()]
    taken += [float(block[0, 0]) for block, _ in way.take()]
    assert taken == list(range(2000))


def test_who_reads_late_gets_the_newest_and_is_told_once():
    way = Handover(seconds=1.0)
    for _ in range(5):
        for number in range(1000):
            way.put(numbered(number), 10000)
        assert [float(block[0, 0]) for block, _ in way.take()] == list(range(900, 1000))
    assert way.notes() == ["nobody listened in time: the oldest sound is left out"]
    for _ in range(30):
        way.put(numbered(0, 1000), 10000)
        way.take()
    assert way.notes() == ["all sound is listened to again"]


def test_one_block_that_is_too_long_is_kept():
    way = Handover(seconds=0.1)
    way.put(numbered(0), 8000)
    way.put(numbered(1, 80000), 8000)
    assert [len(block) for block, _ in way.take()] == [80000]
