"""Markers written as C3D or TRC read back as the same, whatever their gaps, labels, rate, axis and unit."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from onbeat.formats.c3d.read import read_c3d
from onbeat.formats.c3d.write import c3d_bytes, write_c3d
from onbeat.formats.conventions import Convention
from onbeat.formats.trc.read import read_trc
from onbeat.formats.trc.write import trc_text, write_trc
from onbeat.motion import Markers
from onbeat.motion.joint_markers import joint_markers
from persons import person, swinging

conventions = st.builds(Convention, st.sampled_from(["x", "y", "z"]), st.sampled_from(["mm", "cm", "m"]))
labels = st.text(st.characters(codec="utf-8", categories=["L", "N", "P", "S"], exclude_characters=":*"), min_size=1)
calm = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


@st.composite
def markers(draw) -> Markers:
    """Up to nine markers within 20 m, some of them not seen, some at the origin."""
    names = draw(st.lists(labels.map(lambda text: text[:24]), min_size=1, max_size=9, unique=True))
    frames, seed = draw(st.integers(1, 12)), draw(st.integers(0, 999))
    rng = np.random.default_rng(seed)
    positions = rng.uniform(-20, 20, (frames, len(names), 3))
    positions[rng.random((frames, len(names))) < draw(st.sampled_from([0, 0.3, 1]))] = np.nan
    positions[rng.random((frames, len(names))) < 0.05] = 0
    rate = draw(st.one_of(st.floats(1, 1000).map(lambda fps: round(fps, 3)), st.sampled_from([29.97, 59.94, 120.0])))
    return Markers(names, positions, rate, "t")


@calm
@given(markers(), conventions)
def test_as_c3d(tmp_path, written, convention):
    write_c3d(written, tmp_path / "t.c3d", convention)
    found = read_c3d(tmp_path / "t.c3d", up=convention.up)
    assert found.names == written.names
    assert abs(found.fps - written.fps) < 1e-6 * written.fps
    np.testing.assert_array_equal(found.seen, written.seen)
    # 32-bit floats within 20 m are good to 1 µm.
    np.testing.assert_allclose(found.positions, written.positions, atol=1e-6)


@calm
@given(markers(), conventions)
def test_as_trc(tmp_path, written, convention):
    write_trc(written, tmp_path / "t.trc", convention)
    found = read_trc(tmp_path / "t.trc", up=convention.up)
    assert found.names == written.names
    assert found.fps == written.fps
    np.testing.assert_array_equal(found.seen, written.seen)
    np.testing.assert_allclose(found.positions, written.positions, atol=1e-8)


@pytest.mark.parametrize("kind", ["c3d", "trc"])
@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(convention=conventions, size=st.floats(0.7, 1.2), seed=st.integers(0, 99))
def test_bodies_without_being_told_the_convention(tmp_path, kind, convention, size, seed):
    up = "z" if kind == "trc" and convention.up == "x" else convention.up
    written = joint_markers(swinging(person(size), 12, 30, seed, angle=0.3))
    write, read = {"c3d": (write_c3d, read_c3d), "trc": (write_trc, read_trc)}[kind]
    write(written, tmp_path / f"t.{kind}", Convention(up, convention.unit))
    np.testing.assert_allclose(read(tmp_path / f"t.{kind}").positions, written.positions, atol=1e-6)


@calm
@given(markers(), conventions)
def test_writing_what_was_read_gives_the_same_bytes(tmp_path, written, convention):
    data, text = c3d_bytes(written, convention), trc_text(written, convention)
    (tmp_path / "t.c3d").write_bytes(data)
    (tmp_path / "t.trc").write_text(text, encoding="utf-8")
    assert c3d_bytes(read_c3d(tmp_path / "t.c3d", up=convention.up), convention) == data
    assert trc_text(read_trc(tmp_path / "t.trc", up=convention.up), convention) == text
