import numpy as np
import pytest

from folk_dancers import dancers, spaces_of
from onbeat.errors import MetricError
from onbeat.keyposes.held_out import held_out
from onbeat.keyposes.lowdim import low_dimensional
from onbeat.keyposes.lowdim_document import LowdimDocument, document


def made(count=3, names=None, **options):
    clips = dancers(count)
    names = [clip.person for clip in clips] if names is None else names
    return low_dimensional([c.motion for c in clips], [c.keyposes for c in clips], names, **options)


def test_dimensions_can_be_chosen_by_their_share_of_the_variance():
    found = made(rho=0.9, cycle=8)
    shares = found.spaces["keyposes"].cumulative
    assert shares[found.dims - 1] >= 0.9 > shares[found.dims - 2]


def test_one_person_alone_has_no_strangers():
    found = made(1, cycle=8)
    assert found.people is None
    assert len(found.spaces["keyposes"]) == 7


def test_more_dimensions_than_there_are_are_refused():
    with pytest.raises(MetricError, match="9 dimensions of a space that has 7: 8 keyposes of 1 person span"):
        made(1, dims=9, cycle=8)
    with pytest.raises(MetricError, match="0 dimensions"):
        made(1, dims=0, cycle=8)


def test_of_dances_of_one_cycle_what_lies_between_the_taught_poses_is_said_to_be():
    clips = dancers(2)
    motions, names = [clip.motion for clip in clips], [clip.person for clip in clips]
    one = low_dimensional(motions, [clip.keyposes[:8] for clip in clips], names, cycle=8)
    assert one.between
    assert [row.unseen for row in document(one).errors] == ["between"] * 2 + ["people"] * 2
    # A dance that has unseen frames is measured on them alone, and the other is left out.
    both = low_dimensional(motions, [clips[0].keyposes, clips[1].keyposes[:8]], names, cycle=8)
    alone = held_out(both.taught, both.tested[:1], len(both.frames.dims))
    assert not both.between
    assert np.array_equal(both.frames.keypose, alone.keypose)
    assert {row.unseen for row in document(both).errors} == {"frames", "people"}


def test_people_have_names_of_their_own():
    with pytest.raises(MetricError, match="no name twice"):
        made(2, names=["a", "a"])


def test_the_document_comes_back():
    told = document(spaces_of(3))
    again = LowdimDocument.from_json(told.to_json())
    assert again == told
    assert [space.space for space in told.spaces] == ["keyposes", "uniform"]
    assert {(row.unseen, row.of) for row in told.errors} == {
        (unseen, of) for unseen in ("frames", "people") for of in ("all", "rest", "keyposes")
    }
    assert told.poses == 24
    assert all(len(row.keyposes) == len(row.uniform) == 8 for row in told.errors)


@pytest.mark.parametrize("data", [b"", b"{}", b"[1]", b"\xff", b"[" * 100000])
def test_another_document_is_refused(data):
    with pytest.raises(MetricError, match=r"x\.json"):
        LowdimDocument.from_json(data, "x.json")


def test_the_same_dances_give_the_same_bytes():
    first, again = (document(made(2, cycle=8)).to_json() for _ in range(2))
    assert first == again


def test_motions_in_more_dimensions_are_nearer_to_the_original():
    found = spaces_of(3)
    original = found.motions[2].positions
    off = [np.linalg.norm(found.motion(2, "keyposes", dims).positions - original, axis=-1).mean() for dims in (1, 3, 6)]
    assert off[0] > off[1] > off[2]
