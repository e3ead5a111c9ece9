import numpy as np
import pytest

from folk_dancers import dancers
from onbeat.errors import MetricError
from onbeat.keyposes.held_out import Taught, Unseen, held_out, spaces
from onbeat.keyposes.lessons import lesson
from onbeat.keyposes.vectors import pose_vectors


def lessons(count=8, fps=30.0):
    clips = dancers(count, fps=fps)
    vectors = pose_vectors([clip.motion for clip in clips])
    return [lesson(clip.person, own, clip.keyposes, 8) for clip, own in zip(clips, vectors, strict=True)]


@pytest.fixture(scope="module")
def troupe():
    return tuple(zip(*lessons(), strict=True))


@pytest.fixture(scope="module")
def measured(troupe):
    return {strangers: held_out(*troupe, 8, strangers=strangers) for strangers in (False, True)}


@pytest.mark.parametrize("strangers", [False, True])
def test_keyposes_rebuild_rests_and_keyposes_better_and_all_frames_as_well(measured, strangers):
    found = measured[strangers]
    everything, rest, keyposes = found.ratio
    assert (rest < 0.95).all()
    assert (keyposes < 0.92).all()
    assert keyposes[2] < 0.78
    assert (np.abs(everything - 1) < 0.06).all()  # uniform sampling is a fair sample of just these frames
    assert found.uniform.shape == (8, 3, 8)


def test_the_first_dimensions_hold_more_of_the_keyposes_variance(troupe):
    ours, theirs = spaces(troupe[0])
    assert ours.cumulative[2] > max(space.cumulative[2] for space in theirs)


def test_more_dimensions_are_nearer(measured):
    found = measured[False]
    assert (np.diff(found.keypose, axis=1) < 0).all()
    assert 0.03 < found.keypose[0, 2] < 0.08  # metres, at three dimensions


def test_people_who_did_not_teach_are_further_off(measured):
    assert (measured[True].keypose > measured[False].keypose).all()


def test_errors_do_not_depend_on_the_rate():
    slow, fast = (held_out(*zip(*lessons(2, fps), strict=True), 4, phases=2) for fps in (30.0, 120.0))
    assert np.abs(slow.keypose / fast.keypose - 1).max() < 0.02


def test_what_was_taught_is_rebuilt_by_all_dimensions():
    (taught, unseen), *_ = lessons(1)
    seen = Unseen(taught.person, taught.vectors, unseen.spans, taught.keyposes)
    found = held_out([taught], [seen], 99)
    assert len(found.dims) == 7
    assert found.keypose[2, -1] < 1e-9 < found.keypose[0, -1]


def test_without_unseen_keyposes_their_error_is_not_known():
    (taught, unseen), *_ = lessons(1)
    found = held_out([taught], [Unseen("x", unseen.vectors, unseen.spans, np.zeros(0))], 2)
    assert np.isnan(found.keypose[2]).all()
    assert np.isfinite(found.keypose[:2]).all()


def test_nothing_to_learn_from_or_to_test_is_told():
    (taught, unseen), *_ = lessons(1)
    with pytest.raises(MetricError, match="no people"):
        held_out([taught], [unseen], 3, strangers=True)
    with pytest.raises(MetricError, match="nothing of x is unseen"):
        held_out([taught], [Unseen("x", unseen.vectors, (), np.zeros(0))], 3)
    with pytest.raises(MetricError, match="has no keypose"):
        held_out([Taught("y", taught.vectors, np.zeros(0), 0.0, 1.0)], [unseen], 3)
    with pytest.raises(MetricError, match="0 tests"):
        held_out([taught], [], 3)
