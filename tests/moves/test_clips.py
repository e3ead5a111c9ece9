"""What is noted of a recording when it is read."""

import pytest

from onbeat.errors import LibraryError
from onbeat.motion import Skeleton
from onbeat.moves.making.clips import GUESSED, read_recording
from onbeat.moves.recordings import Recording
from persons import along_local_axes, person, swinging


def recording(skeleton: Skeleton) -> Recording:
    motion = swinging(skeleton, frames=180)
    return Recording("a", "a.npz", "", lambda: motion)


def test_a_guessed_body_is_noted():
    body = person()
    nameless = body.replace(names=[f"joint{n}" for n in range(len(body))])
    assert read_recording(recording(body)).notes == ()
    assert read_recording(recording(nameless)).notes == (GUESSED,)


def test_a_body_of_no_bodys_size_is_noted_with_what_to_do():
    body = person()
    (note,) = read_recording(recording(body.replace(offsets=body.offsets / 2.54))).notes
    assert note.startswith("the body is 0.70 m tall")
    assert "is the unit right? (`onbeat convert FILE NEW.npz --source-unit in`" in note


def test_a_body_of_which_nothing_can_be_guessed_is_left_out():
    lying = along_local_axes(swinging(person())).skeleton
    nameless = lying.replace(names=[f"joint{n}" for n in range(len(lying))])
    with pytest.raises(LibraryError, match=r"no joint found for .*roles\.toml"):
        read_recording(recording(nameless))
