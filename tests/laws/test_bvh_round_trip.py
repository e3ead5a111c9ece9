"""What is written as BVH reads back as the same movement, for any tree, rate, unit and axis."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.formats.bvh.read import parse_bvh
from onbeat.formats.bvh.write import bvh_text
from onbeat.formats.conventions import UNITS, UP_AXES, Convention
from onbeat.motion import Skeleton
from persons import person, swinging

conventions = st.builds(Convention, st.sampled_from(UP_AXES), st.sampled_from(sorted(UNITS)))


@st.composite
def skeletons(draw) -> Skeleton:
    """Trees of up to nine joints, depth first; some leaves are ends of bones."""
    count = draw(st.integers(1, 9))
    parents, line = [-1], [0]
    for joint in range(1, count):
        line = line[: draw(st.integers(1, len(line)))]
        parents.append(line[-1])
        line.append(joint)
    steps = st.floats(-1, 1).map(lambda v: round(v, 4))
    offsets = np.array(draw(st.lists(st.tuples(steps, steps, steps), min_size=count, max_size=count)))
    offsets[0] = 0
    offsets[1:][np.abs(offsets[1:]).sum(1) < 0.01] = 0.3
    leaf = [joint not in parents for joint in range(count)]
    ends = [joint > 0 and leaf[joint] and draw(st.booleans()) for joint in range(count)]
    names, used = [], 0
    for joint in range(count):
        name = f"{names[parents[joint]]}_end" if ends[joint] else f"joint {joint}"
        used = names.count(name)
        twins = sum(n.startswith(name) and n.removeprefix(name).isdigit() for n in names) + used
        names.append(name if not twins else f"{name}{twins + 1}")
    return Skeleton(names, parents, offsets, ends)


@settings(max_examples=60, deadline=None)
@given(skeletons(), conventions, st.floats(1, 400), st.integers(1, 6), st.integers(0, 99))
def test_any_tree(skeleton, convention, fps, frames, seed):
    motion = swinging(skeleton, frames, fps, seed, angle=3.0)
    again = parse_bvh(bvh_text(motion, convention), "a.bvh", up=convention.up, unit=convention.unit)
    assert again.skeleton.names == skeleton.names
    assert again.skeleton.end_sites.tolist() == skeleton.end_sites.tolist()
    assert abs(again.fps - fps) < 1e-9 * fps
    np.testing.assert_allclose(again.positions, motion.positions, atol=2e-6)


@settings(max_examples=30, deadline=None)
@given(conventions.filter(lambda c: c.unit not in ("in", "dm", "ft")), st.floats(0.7, 1.2), st.integers(0, 99))
def test_bodies_without_being_told_the_convention(convention, size, seed):
    motion = swinging(person(size), 10, 30, seed, angle=0.3)
    again = parse_bvh(bvh_text(motion, convention), "a.bvh")
    assert again.skeleton == motion.skeleton
    np.testing.assert_allclose(again.positions, motion.positions, atol=1e-5)


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 99))
def test_reading_and_writing_again_is_stable(seed):
    motion = swinging(person(), 5, 60, seed)
    once = bvh_text(parse_bvh(bvh_text(motion, Convention()), "a.bvh"), Convention())
    assert bvh_text(parse_bvh(once, "a.bvh"), Convention()) == once
