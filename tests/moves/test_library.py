import numpy as np
import pytest

from onbeat.errors import LibraryError
from onbeat.moves.graph import GRID
from onbeat.moves.joins import joins_table
from onbeat.moves.library import CLIP_RATE, REACH, Clip, MoveLibrary


@pytest.fixture(scope="module")
def library(dances):
    return MoveLibrary.of([Clip.of(dance, source=n) for n, dance in enumerate(dances[:5])])


def test_a_clip_is_read_off_a_motion(dances):
    motion = dances[0]
    clip = Clip.of(motion.resampled(120.0), source=3)
    assert clip.name == motion.name
    assert clip.source == 3
    assert clip.motion.fps == CLIP_RATE
    assert len(clip.poses) == len(clip.intensity) == len(motion)
    assert (clip.stops > 0).all()
    assert (clip.stops < motion.duration).all()
    assert clip.intensity.min() >= 0


def test_frames_of_clips_lie_in_a_row(library):
    lengths = [len(clip.poses) for clip in library.clips]
    assert np.diff(library.starts).tolist() == lengths
    assert len(library.graph) == len(library.intensity) == sum(lengths)
    assert library.seconds == pytest.approx(sum(lengths) / GRID)


def test_joins_are_between_poses_that_are_near(library):
    poses = np.concatenate([clip.poses for clip in library.clips])
    graph = library.graph
    apart = np.linalg.norm(poses[graph.sources] - poses[graph.targets], axis=1)
    np.testing.assert_allclose(apart, graph.costs, atol=2e-3)
    assert (graph.costs < REACH).all()
    assert graph.join_count > 10


def test_a_mirror_image_is_not_counted_twice(dances):
    clips = [Clip.of(dances[0]), Clip.of(dances[0], mirrored=True)]
    assert MoveLibrary.of(clips).seconds == pytest.approx(dances[0].duration)


def test_a_library_needs_a_clip():
    with pytest.raises(LibraryError, match="no clips"):
        MoveLibrary.of([])


def test_the_table_of_joins_names_clips_and_seconds(library):
    table, graph = joins_table(library), library.graph
    assert {len(column) for column in table} == {graph.join_count}
    for row in (0, graph.join_count // 2, graph.join_count - 1):
        names = [clip.name for clip in library.clips]
        for name, second, frame in (
            (table.leave[row], table.leave_s[row], graph.sources[row]),
            (table.enter[row], table.enter_s[row], graph.targets[row]),
        ):
            assert library.starts[names.index(name)] + round(second * GRID) == frame
    assert (table.link_error > 0).all()
    assert (table.link_error < 60).all()
    # poses that are nearer fit better
    near = table.distance < np.median(table.distance)
    assert table.link_error[near].mean() < table.link_error[~near].mean()


def test_a_library_without_joins_has_an_empty_table(dances):
    alone = MoveLibrary.of([Clip.of(dances[0][:60])], reach=1e-6)
    assert [len(column) for column in joins_table(alone)] == [0] * 6
