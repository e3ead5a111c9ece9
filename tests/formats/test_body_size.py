"""Units that files do not store: guessed, and doubted where the body is no person's size."""

import warnings

import pytest

from onbeat.formats.body_size import UnitWarning, guessed_unit, odd_person
from onbeat.formats.bvh.read import parse_bvh
from onbeat.formats.bvh.write import bvh_text
from onbeat.formats.conventions import Convention
from onbeat.formats.read import read_motion
from onbeat.motion import Skeleton
from persons import person, swinging


@pytest.mark.parametrize(("unit", "taken"), [("dm", "cmu"), ("ft", "m"), ("in", "cm")])
def test_a_unit_that_is_rare_is_named_where_it_gives_a_person(unit: str, taken: str):
    text = bvh_text(swinging(person(), frames=5, angle=0.1), Convention("y", unit))
    with pytest.warns(UnitWarning, match=rf"^a\.bvh: a body .* taken as {taken}\); .*{unit} makes it 1\.75 m") as said:
        parse_bvh(text, "a.bvh")
    assert f"--source-unit {unit}`" in str(said[0].message)


@pytest.mark.parametrize("unit", ["m", "cm", "mm", "cmu"])
def test_the_usual_units_and_lying_bodies_are_no_reason_to_speak(unit: str):
    text = bvh_text(swinging(person(), frames=5, angle=1.5), Convention("z", unit))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parse_bvh(text, "a.bvh")


def test_who_says_the_unit_is_not_asked():
    text = bvh_text(swinging(person(), frames=5), Convention("y", "dm"))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert parse_bvh(text, "a.bvh", unit="dm").skeleton == person()


def test_dwarfs_and_giants_are_asked_for():
    assert "is it a small child or a robot?" in odd_person(person(0.5), "m")
    assert "is it a giant?" in odd_person(person(100 * 1.5), "cm")
    assert odd_person(person(0.7), "m") == odd_person(person(1.2), "m") == ""


def test_what_has_no_legs_has_a_unit_but_no_size():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert guessed_unit(Skeleton(("a", "b"), [-1, 0], [[0, 0, 0], [0, 0, 20]])) == "cmu"


def test_no_real_body_is_doubted(data):
    with warnings.catch_warnings():
        warnings.simplefilter("error", UnitWarning)
        for path in [*sorted((data / "cmu").glob("*.bvh")), *sorted((data / "bandai").rglob("*.bvh"))[::8]]:
            read_motion(path)
