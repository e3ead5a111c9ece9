"""Descriptions as MJCF."""

from __future__ import annotations

import msgspec

from onbeat.robots.description.mjcf import STEP, mjcf_of
from onbeat.robots.description.toml import described
from onbeat.robots.engine import engine


def test_names_are_quoted_and_pads_touch_the_floor():
    told = described("hrp4c")
    model = engine().MjModel.from_xml_string(mjcf_of(msgspec.structs.replace(told, name='a "robot" <&>')))
    assert model.opt.timestep == STEP
    names = [model.geom(geom).name for geom in range(model.ngeom)]
    assert sum(name.startswith("pad_") for name in names) == 4
    assert sum("_sole_" in name for name in names) == 8


def test_mass_is_the_descriptions_and_rotors_count():
    told = described("g1")
    model = engine().MjModel.from_xml_string(mjcf_of(told))
    assert abs(model.body_mass.sum() - told.root.mass - sum(link.mass for link in told.links.values())) < 1e-9
    assert model.dof_armature[6:].tolist() == [link.armature for link in told.links.values()]


def test_the_same_description_is_the_same_text():
    assert mjcf_of(described("talos")) == mjcf_of(described("talos"))
