import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from persons import person, swinging

ONE = Skeleton(["a", "b"], [-1, 0], [[0, 0, 0], [0, 0, 1.0]])


def still(frames: int = 4, **more) -> Motion:
    return Motion(ONE, np.tile(rot.IDENTITY, (frames, 2, 1)), np.zeros((frames, 3)), 30, **more)


def test_times_and_duration():
    motion = swinging(person(), frames=45, fps=30)
    assert motion.duration == 1.5
    assert motion.times[-1] == pytest.approx(44 / 30)
    assert len(motion[10:20]) == 10
    np.testing.assert_array_equal(motion[10:20].positions, motion.positions[10:20])
    part = motion[10:40:3]  # of a motion whose joints' places are known
    np.testing.assert_array_equal(part.positions, part.replace(fps=10).positions)
    assert not part.positions.flags.writeable


def test_at_frame_times_is_the_motion_itself():
    motion = swinging(person())
    np.testing.assert_allclose(motion.at(motion.times).positions, motion.positions, atol=1e-9)
    np.testing.assert_allclose(motion.at(np.array([-1.0, 99.0])).positions, motion.positions[[0, -1]], atol=1e-9)


def test_resampling_keeps_path_and_time():
    motion = swinging(person(), frames=121, fps=120)
    coarse = motion.resampled(30)
    assert (len(coarse), coarse.fps) == (31, 30)
    np.testing.assert_allclose(coarse.positions, motion.positions[::4], atol=1e-9)
    fine = coarse.resampled(120)
    assert np.abs(fine.positions - motion.positions).max() < 0.01
    assert motion.resampled(120) is motion


def test_translations_go_along():
    t = np.tile(ONE.offsets, (4, 1, 1)) * np.arange(1, 5)[:, None, None]
    motion = still(translations=t)
    assert motion.at(np.array([0.5 / 30])).positions[0, 1, 2] == pytest.approx(1.5)
    assert motion[2:].positions[0, 1, 2] == 3
    assert motion.replace(fps=60).translations is not None


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"rotations": np.zeros((4, 3, 4))}, r"\(frames, 2, 4\) is needed"),
        ({"rotations": np.zeros((0, 2, 4)), "root_positions": np.zeros((0, 3))}, "has no frames"),
        ({"root_positions": np.zeros((3, 3))}, r"\(4, 3\) is needed"),
        ({"root_positions": np.array([[0, 0, 0]] * 3 + [[0, 0, np.inf]])}, "not a number at frame 3"),
        ({"fps": 0.0}, "a positive rate is needed"),
        ({"fps": np.nan}, "a positive rate is needed"),
    ],
)
def test_what_is_no_motion_is_refused(change, message):
    with pytest.raises(FormatError, match=message):
        still(name="x").replace(**change)
