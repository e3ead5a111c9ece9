"""Ticks for a session: of whatever a listener gives, with what was told meanwhile."""

from __future__ import annotations

import threading

import numpy as np

from onbeat.live.hearing import MOST, Hearing, Inbox
from onbeat.live.protocol import Clocked, Command


class Told:
    """A listener that gives what it is told to."""

    def __init__(self) -> None:
        self.blocks, self.said, self.state, self.latency, self.started = [], [], "waiting", 0.0, False

    def start(self) -> None:
        self.started, self.state = True, "sound"

    def read(self):
        out, self.blocks = self.blocks, []
        return out

    def notes(self) -> list[str]:
        out, self.said = self.said, []
        return out

    def close(self) -> None: ...


def test_blocks_of_any_size_become_ticks_in_order():
    listener = Told()
    hearing = Hearing(listener, Inbox())
    assert not listener.started
    hearing.start()
    sound = np.sin(np.arange(441 * 20) / 9).astype(np.float32) * 0.4
    listener.blocks = [(part[:, None], 44100) for part in np.split(sound, [100, 1000, 5000])]
    ticks = []
    while (tick := hearing.tick()) is not None:
        ticks.append(tick)
    assert len(ticks) == 20
    assert np.corrcoef(np.concatenate(ticks)[2000:], sound[2000:])[0, 1] > 0.99


def test_what_is_told_is_given_once_and_too_much_is_left_out():
    inbox = Inbox()
    for _ in range(MOST + 20):
        inbox.command(Command("tap"))
    inbox.clocked(Clocked(1.0, 2.0))
    told = inbox.told()
    assert len(told.commands) == MOST
    assert told.clocked == (Clocked(1.0, 2.0),)
    assert not inbox.told().commands


def test_nothing_is_lost_between_threads():
    inbox, taken = Inbox(), []

    def tell() -> None:
        for k in range(500):
            inbox.clocked(Clocked(float(k), 0.0))
            while len(taken) + MOST // 2 < k:
                taken.extend(inbox.told().clocked)

    thread = threading.Thread(target=tell)
    thread.start()
    thread.join(20)
    taken.extend(inbox.told().clocked)
    assert [one.time for one in taken] == [float(k) for k in range(500)]


def test_notes_of_all_are_together():
    listener, inbox = Told(), Inbox()
    hearing = Hearing(listener, inbox)
    listener.said = ["the input is lost"]
    inbox.note("OSC: garbage is ignored")
    assert hearing.notes() == ["the input is lost", "OSC: garbage is ignored"]
    assert hearing.notes() == []


def test_it_is_lost_and_over_as_the_listener_is():
    listener = Told()
    hearing = Hearing(listener, Inbox())
    assert hearing.lost
    hearing.start()
    assert not hearing.lost
    listener.state = "ended"
    assert hearing.over
