import numpy as np
import pytest

from onbeat.errors import LimitError
from onbeat.examples.body import Build
from onbeat.limits.learned import counterparts, learned_limits
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot

NAMES = {
    "LeftArm": "upperarm_l",
    "LeftForeArm": "lowerarm_l",
    "LeftHand": "hand_l",
    "RightArm": "upperarm_r",
    "RightForeArm": "lowerarm_r",
    "RightHand": "hand_r",
    "LeftUpLeg": "thigh_l",
    "LeftLeg": "calf_l",
    "LeftFoot": "foot_l",
    "RightUpLeg": "thigh_r",
    "RightLeg": "calf_r",
    "RightFoot": "foot_r",
    "Hips": "pelvis",
    "Head": "head",
    "Neck": "neck_01",
}


def swinging(joint: str, hertz: float, skeleton: Skeleton | None = None, fps: float = 60.0) -> Motion:
    """Four seconds in which one joint swings by 0.5 rad."""
    skeleton = Build(1.7).skeleton if skeleton is None else skeleton
    times = np.arange(int(4 * fps)) / fps
    rotations = np.tile(rot.IDENTITY, (len(times), len(skeleton), 1))
    rotations[:, skeleton.index(joint)] = rot.about(np.array([1.0, 0, 0]), 0.5 * np.sin(2 * np.pi * hertz * times))
    return Motion(skeleton, rotations, np.zeros((len(times), 3)), fps)


def renamed(skeleton: Skeleton) -> Skeleton:
    names = [NAMES.get(name, f"x_{name}") for name in skeleton.names]
    return Skeleton(names, skeleton.parents, skeleton.offsets, skeleton.end_sites)


def test_the_fastest_of_all_motions_counts():
    limits = learned_limits([swinging("LeftArm", 1), swinging("LeftArm", 2), swinging("RightArm", 1)])
    left, right, head = limits.of(["LeftArm", "RightArm", "Head"]).speed
    assert left == pytest.approx(0.5 * 2 * np.pi * 2, rel=0.01)
    assert right == pytest.approx(0.5 * 2 * np.pi, rel=0.01)
    assert 0 < head < 0.01
    assert np.isinf(limits.low).all()
    assert np.isinf(limits.jerk).all()
    assert limits.source == "learned from 3 motions, 12 s, quantile 1"


def test_accelerations_are_learned_too():
    limits = learned_limits([swinging("LeftArm", 1)])
    assert limits.of(["LeftArm"]).acceleration[0] == pytest.approx(0.5 * (2 * np.pi) ** 2, rel=0.03)


def test_end_sites_have_no_limits():
    skeleton = Build(1.7).skeleton
    moving = [name for name, end in zip(skeleton.names, skeleton.end_sites, strict=True) if not end]
    assert learned_limits([swinging("LeftArm", 1)]).joints == tuple(moving)


def test_a_quantile_passes_over_the_fastest_of_the_time():
    rare = swinging("LeftArm", 1)
    rotations = rare.rotations.copy()
    arm = rare.skeleton.index("LeftArm")
    rotations[100:115, arm] = rot.about(np.array([0, 0, 1.0]), np.arange(15) / 60 * 30)
    rotations[115:, arm] = rotations[114, arm]
    fast = rare.replace(rotations=rotations)
    assert learned_limits([fast]).of(["LeftArm"]).speed[0] > 29
    assert learned_limits([fast], quantile=0.9).of(["LeftArm"]).speed[0] < 4


def test_the_rate_of_the_recording_does_not_matter():
    limits = [learned_limits([swinging("LeftArm", 2, fps=fps)]).of(["LeftArm"]) for fps in (30, 60, 120)]
    speeds, accelerations = ([getattr(one, key)[0] for one in limits] for key in ("speed", "acceleration"))
    np.testing.assert_allclose(speeds, speeds[-1], rtol=0.01)
    np.testing.assert_allclose(accelerations, accelerations[-1], rtol=0.06)


def test_other_names_are_matched_by_role():
    other = renamed(Build(1.7).skeleton)
    limits = learned_limits([swinging("LeftArm", 1), swinging("upperarm_l", 3, other)])
    assert limits.of(["LeftArm"]).speed[0] == pytest.approx(0.5 * 2 * np.pi * 3, rel=0.02)
    back = learned_limits([swinging("LeftArm", 1)], skeleton=other)
    assert back.of(["upperarm_l"]).speed[0] == pytest.approx(0.5 * 2 * np.pi, rel=0.02)


def test_a_joint_that_is_in_no_motion_has_no_limit():
    skeleton = Skeleton(("hips", "tail", "arm"), [-1, 0, 0], np.ones((3, 3)))
    bare = Skeleton(("hips", "arm"), [-1, 0], np.ones((2, 3)))
    limits = learned_limits([swinging("arm", 1, bare)], skeleton=skeleton)
    assert np.isinf(limits.of(["tail"]).speed).all()
    assert np.isfinite(limits.of(["arm", "hips"]).speed).all()


def test_counterparts_by_name_then_by_role():
    mine = Build(1.7).skeleton
    names = [name for name, end in zip(mine.names, mine.end_sites, strict=True) if not end]
    assert counterparts(mine, names, mine) == {name: mine.index(name) for name in names}
    other = renamed(mine)
    found = counterparts(mine, names, other)
    assert {name: other.names[joint] for name, joint in found.items()}.items() >= {
        name: NAMES[name] for name in ("LeftArm", "RightForeArm", "LeftLeg", "Hips")
    }.items()


def test_what_cannot_be_learned_is_told():
    with pytest.raises(LimitError, match=r"learn limits from \(none given\)"):
        learned_limits([])
    one = swinging("LeftArm", 1)[:1]
    with pytest.raises(LimitError, match=r"learn limits from \(1 given, none of two"):
        learned_limits([one])
    with pytest.raises(LimitError, match="none of the joints tail is in the motions"):
        learned_limits([swinging("LeftArm", 1)], skeleton=Skeleton(("root", "tail"), [-1, 0], np.ones((2, 3))))
    for quantile in (0, 1.1, np.nan):
        with pytest.raises(LimitError, match="quantile"):
            learned_limits([swinging("LeftArm", 1)], quantile)


def test_two_frames_are_enough():
    limits = learned_limits([swinging("LeftArm", 1)[:2]])
    assert 0 < limits.of(["LeftArm"]).speed[0] < 4
    assert np.isinf(limits.acceleration).all()


def test_a_real_library_at_two_rates(data):
    """Spikes of the solver are not taken for speed: naive differences have 353 rad/s for a foot."""
    from onbeat.formats import read_motion

    motions = [read_motion(path, fps=120) for path in sorted((data / "cmu").rglob("05_0[1-3].amc"))]
    assert motions
    limits = learned_limits(motions)
    half = learned_limits([motion.resampled(60) for motion in motions])
    body = ["lradius", "rradius", "ltibia", "rtibia", "head", "lowerback", "lowerneck"]
    assert limits.of(body).speed.max() < 20
    np.testing.assert_allclose(half.of(body).speed, limits.of(body).speed, rtol=0.2)
