"""A stored skeleton keeps what is told of its joints."""

import msgspec
import pytest

from onbeat.errors import LibraryError
from onbeat.moves.disk.bodies import Body, skeleton_of, skeleton_text
from onbeat.moves.making.clips import skeleton_digest
from onbeat.moves.recordings import content_digest, motion_digest
from persons import person, swinging


def test_told_roles_are_kept():
    told = person().with_roles({"head": "Head_end"})
    back = msgspec.json.decode(msgspec.json.encode(Body.of(told)), type=Body).skeleton()
    assert back == told
    assert back.roles == {"head": "Head_end"}


def test_a_skeleton_of_which_nothing_is_told_is_written_as_before():
    assert b"roles" not in msgspec.json.encode(Body.of(person()))
    plain = {"names": ["a"], "parents": [-1], "offsets": [[0, 0, 0]], "end_sites": [False]}
    assert not msgspec.convert(plain, Body).skeleton().roles


def test_what_is_told_changes_the_digests(tmp_path):
    told = person().with_roles({"head": "Head_end"})
    assert skeleton_digest(told) != skeleton_digest(person())
    assert motion_digest(swinging(told)) != motion_digest(swinging(person()))
    file = tmp_path / "a.bvh"
    file.write_text("a motion")
    before = content_digest(file)
    (tmp_path / "roles.toml").write_text("[joints]")
    assert content_digest(file) != before


@pytest.mark.parametrize("damage", [lambda text: text[:50], lambda text: text.replace("[-1", "[7"), lambda text: "{}"])
def test_a_damaged_skeleton_is_told(damage):
    with pytest.raises(LibraryError, match="skeleton is damaged"):
        skeleton_of(damage(skeleton_text(person())))
