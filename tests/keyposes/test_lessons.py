import numpy as np
import pytest

from folk_dancers import dancers
from onbeat.errors import MetricError
from onbeat.keyposes.lessons import lesson
from onbeat.keyposes.vectors import pose_vectors


@pytest.fixture(scope="module")
def own():
    return pose_vectors([dancers(1)[0].motion])[0]


def test_the_cycle_in_the_middle_teaches(own):
    times = dancers(1)[0].keyposes
    taught, unseen = lesson("Aiko", own, times, 8)
    assert np.array_equal(taught.keyposes, times[8:16])
    assert (taught.start, taught.end) == (times[8], times[16])
    assert unseen.spans == ((times[0], times[8]), (times[16], times[-1]))
    assert len(unseen.keyposes) == 16


def test_of_one_cycle_the_poses_between_are_tested(own):
    taught, unseen = lesson("Aiko", own, dancers(1)[0].keyposes[:8], 8)
    assert unseen.spans == ((taught.start, taught.end),)
    assert len(unseen.keyposes) == 0
    assert unseen.between
    assert not lesson("Aiko", own, dancers(1)[0].keyposes, 8)[1].between


@pytest.mark.parametrize(
    ("times", "cycle", "told"),
    [
        ([], None, "0 keyposes"),
        ([1.0], None, "1 keypose;"),
        ([1.0, 2.0, 3.0], 8, "3 keyposes, of which a cycle has 8.* another --in-cycle"),
        ([1.0, 2.0, 3.0], 1, "a cycle has 1"),
        ([1.0, 3.0, 2.0], None, "not increasing"),
        ([1.0, np.nan, 2.0], None, "not increasing"),
        ([-1.0, 1.0, 2.0], None, "not increasing"),
        ([1.0, 2.0, 400.0], None, "of another motion"),
    ],
)
def test_keyposes_that_teach_nothing_are_told(own, times, cycle, told):
    with pytest.raises(MetricError, match=told):
        lesson("Aiko", own, np.array(times), cycle)
