"""Groups depend on what is in them, and a clip more changes one of them."""

import hashlib
import itertools

import numpy as np

from onbeat.moves.making.groups import RIM, Member, lots_of


def members(count, frames=400):
    names = [hashlib.sha256(str(n).encode()).hexdigest() for n in range(count)]
    return [Member(n, name, name, frames) for n, name in enumerate(names)]


def test_each_clip_lies_in_one_group_of_the_size():
    lots = lots_of(members(200))
    assert sorted(piece.clip for lot in lots for piece in lot.pieces) == list(range(200))
    assert max(lot.frames for lot in lots) <= 4096
    assert np.mean([lot.frames for lot in lots]) > 2000


def test_a_clip_and_its_mirror_image_lie_together():
    both = [Member(2 * m.clip + k, m.content, f"{m.digest}{k}", 300) for m in members(40) for k in (0, 1)]
    for lot in lots_of(both):
        clips = [piece.clip for piece in lot.pieces]
        assert [clip // 2 for clip in clips[::2]] == [clip // 2 for clip in clips[1::2]]


def test_a_clip_more_changes_one_group_or_splits_it():
    before = {lot.key for lot in lots_of(members(200))}
    for count in range(201, 211):
        after = {lot.key for lot in lots_of(members(count))}
        assert len(before - after) <= 1
        assert len(after - before) <= 3
        before = after


def test_the_order_of_clips_does_not_matter():
    some = members(50)
    other = [member._replace(clip=49 - member.clip) for member in reversed(some)]
    assert [lot.key for lot in lots_of(some)] == [lot.key for lot in lots_of(other)]


def test_a_long_clip_is_cut_so_that_each_frame_is_inside_one_piece():
    for frames in (1001, 2000, 2996, 4321):
        lots = lots_of([Member(0, "a", "a", frames)], size=1000)
        pieces = sorted(piece for lot in lots for piece in lot.pieces)
        inside = [range(piece.start + RIM, piece.stop - RIM) for piece in pieces]
        assert list(itertools.chain(*inside)) == list(range(RIM, frames - RIM))
        assert max(lot.frames for lot in lots) <= 1000
