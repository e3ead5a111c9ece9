"""Segments are recognised as they end, as they would be from the whole motion."""

from __future__ import annotations

import numpy as np
import pytest

from made_segments import danced
from onbeat.errors import MetricError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.performer import Performance, perform
from onbeat.examples.troupe import FIGURES
from onbeat.keyposes.extract import find_keyposes
from onbeat.keyposes.segments import segments
from onbeat.recognition.recogniser import Recogniser
from onbeat.recognition.segments import segments_of
from onbeat.recognition.streaming import LONGEST, Ended, Listener

SPAN = 3


@pytest.fixture(scope="module")
def recogniser() -> Recogniser:
    motions, spans, tasks, people = [], [], [], []
    for clip in danced():
        for part in segments(find_keyposes(clip.motion, clip.beats), SPAN):
            motions.append(clip.motion)
            spans.append((part.start, part.end))
            tasks.append(clip.task)
            people.append(clip.person)
    found = segments_of(motions, spans, tasks, people, [0] * len(spans))
    return Recogniser.train(found, np.random.default_rng(0))


@pytest.fixture(scope="module")
def clip() -> Performance:
    return perform(DANCERS[1], [FIGURES[2]], 1.0, 4, np.random.default_rng(5), 60.0)


def heard(listener: Listener, clip: Performance, frames: int) -> list[list[Ended]]:
    """What came out after each push, and in the end."""
    motion, beats = clip.motion, np.asarray(clip.beats)
    found: list[list[Ended]] = []
    for first in range(0, len(motion), frames):
        span = first / motion.fps, (first + frames) / motion.fps
        found.append(listener.push(motion[first : first + frames], beats[(beats >= span[0]) & (beats < span[1])]))
    return [*found, listener.finish()]


@pytest.fixture(scope="module")
def parts(recogniser: Recogniser, clip: Performance) -> list[list[Ended]]:
    """What came out after each tenth of a second."""
    return heard(Listener(recogniser, SPAN), clip, 6)


def test_segments_have_the_answers_that_they_have_in_the_whole_motion(
    recogniser: Recogniser, clip: Performance, parts: list[list[Ended]]
):
    ended = [one for part in parts for one in part]
    assert len(ended) > 8
    spans = [(one.start, one.end) for one in ended]
    count = len(spans)
    whole = recogniser.predict(segments_of([clip.motion] * count, spans, [""] * count, [""] * count, [0] * count))
    for one, wanted in zip(ended, whole, strict=True):
        assert (one.prediction.task, one.prediction.task_known) == (wanted.task, wanted.task_known)
        assert one.prediction.person == wanted.person
        assert one.prediction.margins == pytest.approx(wanted.margins, abs=0.05)


def test_the_keyposes_are_those_of_the_whole_motion_but_for_a_few(clip: Performance, parts: list[list[Ended]]):
    ended = [one for part in parts for one in part]
    offline = segments(find_keyposes(clip.motion, clip.beats), SPAN)
    near = [min(abs(one.end - part.end) for part in offline) < 0.05 for one in ended]
    assert np.mean(near) >= 0.9
    assert abs(len(ended) - len(offline)) <= 2


def test_how_many_frames_come_at_a_time_does_not_matter_much(
    recogniser: Recogniser, clip: Performance, parts: list[list[Ended]]
):
    by_many = [one for part in heard(Listener(recogniser, SPAN), clip, 30) for one in part]
    by_one = [one for part in parts for one in part]
    assert len(by_one) == len(by_many)
    assert np.allclose([one.end for one in by_one], [one.end for one in by_many], atol=0.05)


def test_an_answer_comes_soon_after_its_segment_has_ended(clip: Performance, parts: list[list[Ended]]):
    period = float(np.median(np.diff(clip.beats)))
    for number, part in enumerate(parts[:-1]):
        for one in part:
            assert (number + 1) * 6 / clip.motion.fps - one.end < 3.6 * period


def test_memory_is_bounded_however_long_nothing_rests(recogniser: Recogniser, clip: Performance):
    listener = Listener(recogniser, SPAN, memory=8.0)
    frames = 60
    most = 0.0
    for turn in range(12):
        for first in range(0, len(clip.motion) - frames, frames):
            at = listener.now
            listener.push(clip.motion[first : first + frames], [at + 0.3, at + 0.8] if turn else [at + 0.5])
            most = max(most, listener.held)
    assert listener.now > 100.0
    assert most < 30.0 < LONGEST


def test_what_cannot_follow_is_refused(recogniser: Recogniser, clip: Performance):
    listener = Listener(recogniser, SPAN)
    listener.push(clip.motion[:10], [0.5])
    with pytest.raises(MetricError, match="increasing seconds"):
        listener.push(clip.motion[10:20], [0.5])
    with pytest.raises(MetricError, match="new listener"):
        listener.push(clip.motion[10:20].replace(fps=30.0))
    with pytest.raises(MetricError, match="span of 0"):
        Listener(recogniser, 0)
    with pytest.raises(MetricError, match="memory of nan"):
        Listener(recogniser, 1, memory=float("nan"))


def test_nothing_comes_out_where_nothing_or_no_beat_came_in(recogniser: Recogniser, clip: Performance):
    listener = Listener(recogniser, SPAN)
    assert listener.finish() == []
    assert listener.push(clip.motion) == []
    assert listener.finish() == []
