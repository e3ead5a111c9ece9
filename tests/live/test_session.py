"""A live session: the same sound gives the same poses, and what is heard is danced to."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from onbeat.examples.song import demo_song
from onbeat.examples.troupe import dance_library
from onbeat.live.beat.pulse import Pulse
from onbeat.live.cast import Known, following
from onbeat.live.protocol import BeatSaid, Command, Note, Status
from onbeat.live.record import Digest
from onbeat.live.session import LEAD, NOTHING_TOLD, Session, Told
from onbeat.retime.bspline import Spline

TICK = 441


@cache
def song() -> np.ndarray:
    return demo_song(24.0, tempo=112, drift=0.0).samples.mean(axis=1).astype(np.float32)


@cache
def dances() -> tuple[Known, ...]:
    some = dance_library()[:2]
    return tuple(Known(one.motion, np.asarray(one.beats), np.asarray(one.keyposes)) for one in some)


def session(latency: float = 0.0) -> Session:
    cast = following(dances())
    return Session(Pulse(), cast.conductor, cast.dancer, latency)


def run(session: Session, sound: np.ndarray, told: dict[int, Told] | None = None):
    """All poses and events."""
    poses, events = [], []
    for k in range(len(sound) // TICK):
        step = session.step(sound[k * TICK : (k + 1) * TICK], (told or {}).get(k, NOTHING_TOLD))
        poses += step.poses
        events += step.events
    return poses, events


@pytest.fixture(scope="module")
def danced():
    one = session()
    return one, *run(one, song())


def test_poses_come_in_time_and_none_is_left_out(danced):
    _, poses, _ = danced
    assert [pose.number for pose in poses] == list(range(len(poses)))
    assert len(poses) >= len(song()) // TICK + LEAD


def test_it_rests_until_there_is_music_and_then_dances_on_its_beats(danced):
    _, _, events = danced
    statuses = [event for event in events if isinstance(event, Status)]
    assert statuses[0].dancing == "resting"
    assert statuses[-20].dancing != "resting"
    assert statuses[-20].tempo == pytest.approx(112, abs=2)
    said = [event for event in events if isinstance(event, BeatSaid)]
    assert len(said) > 20


def test_the_same_sound_gives_the_same_poses_to_the_bit(danced):
    _, poses, _ = danced
    again, _ = run(session(), song()[: 12 * 44100])
    one, other = Digest(), Digest()
    one.add(None, NOTHING_TOLD, poses[: len(again)])
    other.add(None, NOTHING_TOLD, again)
    assert one.hexdigest() == other.hexdigest()


def test_limits_hold_between_poses_and_nothing_jumps():
    one, last = session(), None
    told = {k: Told((Command("next"),)) for k in range(400, 1200, 150)}
    sound = np.concatenate((song()[: 9 * 44100], np.zeros(3 * 44100, np.float32)))
    for k in range(len(sound) // TICK):
        step = one.step(sound[k * TICK : (k + 1) * TICK], told.get(k, NOTHING_TOLD))
        if not step.poses:
            continue
        body = one.follower.body
        _, _, speed, acceleration, _ = body.bounds
        curve, times = Spline(body.knots, body.controls), body.knots.start + np.arange(101) / 1000
        assert (np.abs(curve(times, 1)) <= speed * (1 + 1e-6)).all()
        assert (np.abs(curve(times, 2)) <= acceleration * (1 + 1e-6)).all()
        first = curve(times[:1])[0]
        assert last is None or np.abs(first - last).max() < 1e-9
        last = curve(times[-1:])[0]


def test_a_wish_that_cannot_be_is_told_of():
    _, events = run(session(), song()[: 2 * TICK], {0: Told((Command("play", "waltz"),))})
    assert any(isinstance(event, Note) and "waltz" in event.text for event in events)


def test_with_latency_poses_are_of_a_later_second_of_the_music():
    early, late = session(), session(0.2)
    run(early, song()[: 8 * 44100])
    run(late, song()[: 8 * 44100])
    assert late.follower.planned == pytest.approx(early.follower.planned + 0.2)
