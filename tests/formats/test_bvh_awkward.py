"""Each awkward file is read as what it holds, or refused with what is wrong and where."""

import time

import numpy as np
import pytest

from awkward import CASES, Case
from onbeat.errors import FormatError
from onbeat.formats import read_motion

READ = [case for case in CASES if case.spec]
REFUSED = [case for case in CASES if not case.spec]


def test_there_are_enough_of_them():
    assert len(CASES) >= 50
    assert len({case.name for case in CASES}) == len(CASES)


@pytest.mark.parametrize("case", READ, ids=[case.name for case in READ])
def test_joints_are_where_the_matrices_say(case: Case, tmp_path):
    path, spec = tmp_path / "a.bvh", case.spec
    assert spec
    path.write_bytes(case.data)
    motion = read_motion(path, up="z", unit="m")  # as in the file: nothing turned, nothing scaled
    assert motion.fps == pytest.approx(spec.fps, rel=1e-5)
    assert len(motion) == spec.frames
    names = [name for name, _, _, _ in spec.rows if name]
    assert [
        name for name, end in zip(motion.skeleton.names, motion.skeleton.end_sites, strict=True) if not end
    ] == names
    for name in names:
        np.testing.assert_allclose(motion.positions[:, motion.skeleton.index(name)], spec.truth[name], atol=1e-6)
    ends = [np.array(truth) for name, truth in spec.truth.items() if name.startswith("end ")]
    kept = motion.positions[:, motion.skeleton.end_sites]
    lengths = [np.linalg.norm(offset) for name, _, offset, _ in spec.rows if not name]
    assert kept.shape[1] == sum(length > 0 for length in lengths)
    for place, truth in zip(np.moveaxis(kept, 1, 0), ends, strict=False):
        np.testing.assert_allclose(place, truth, atol=1e-6)


@pytest.mark.parametrize("case", REFUSED, ids=[case.name for case in REFUSED])
def test_what_cannot_be_read_is_refused_with_its_place(case: Case, tmp_path):
    path = tmp_path / "a.bvh"
    path.write_bytes(case.data)
    started = time.process_time()
    with pytest.raises(FormatError) as caught:
        read_motion(path)
    assert case.says in str(caught.value)
    assert str(path) in str(caught.value)
    assert time.process_time() - started < 2
