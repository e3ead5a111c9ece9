"""What is written as .npz reads back to the last bit, for any tree, rate, name and roles."""

import tempfile
from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.formats.npz import read_npz, write_npz
from onbeat.motion import Motion, Skeleton
from onbeat.motion.body import ROLES
from persons import swinging

words = st.text(st.characters(exclude_categories=["Cs", "Cc"]), min_size=1, max_size=8)


@st.composite
def skeletons(draw) -> Skeleton:
    """Trees of up to nine joints; any names, any offsets, some roles told."""
    names = draw(st.lists(words, min_size=1, max_size=9, unique=True))
    parents = [-1, *(draw(st.integers(0, joint - 1)) for joint in range(1, len(names)))]
    steps = st.tuples(*[st.floats(-3, 3)] * 3)
    offsets = np.array(draw(st.lists(steps, min_size=len(names), max_size=len(names))))
    ends = draw(st.lists(st.booleans(), min_size=len(names), max_size=len(names)))
    roles = draw(st.dictionaries(st.sampled_from(ROLES), st.sampled_from(names), max_size=3))
    return Skeleton(names, parents, offsets, ends, roles=roles)


@settings(max_examples=100, deadline=None)
@given(
    skeletons(),
    st.floats(0.1, 10000),
    st.integers(1, 5),
    st.integers(0, 99),
    st.text("aé 漢", max_size=5),
    st.booleans(),
)
def test_every_bit_comes_back(skeleton, fps, frames, seed, name, moving):
    motion = swinging(skeleton, frames, fps, seed, angle=3.0)
    offsets = np.random.default_rng(seed).normal(size=(frames, len(skeleton), 3)) if moving else None
    motion = Motion(skeleton, motion.rotations, motion.root_positions, fps, name, offsets)
    with tempfile.TemporaryDirectory() as folder:
        write_npz(motion, Path(folder) / "a.npz")
        again = read_npz(Path(folder) / "a.npz")
    assert (again.skeleton.names, again.fps, again.name) == (skeleton.names, fps, name)
    assert dict(again.skeleton.roles) == dict(skeleton.roles)
    for key in ("rotations", "root_positions"):
        assert getattr(again, key).tobytes() == getattr(motion, key).tobytes()
    for key in ("parents", "offsets", "end_sites"):
        assert getattr(again.skeleton, key).tobytes() == getattr(skeleton, key).tobytes()
    assert (again.translations is None) == (not moving)
    if again.translations is not None:
        np.testing.assert_array_equal(again.translations, motion.translations)
