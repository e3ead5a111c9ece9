import numpy as np
import pytest

from onbeat.moves.pairs.blocks import Group
from onbeat.moves.pairs.candidates import Care
from onbeat.moves.pairs.caps import capped, density_for
from onbeat.moves.pairs.cells import cell_table, cells_of
from onbeat.moves.pairs.coarse import APPROXIMATE, COARSE, cell_pairs
from onbeat.moves.pairs.exact import exact_pairs
from onbeat.moves.poses import pose_vectors

EVERYTHING = Care(1e3, 1e3, 0.0, 1e3, 1e3, 1e3)
LIMIT = 0.54


@pytest.fixture(scope="module")
def groups(dances):
    poses = [pose_vectors(motion) for motion in dances]
    sides = poses[:8], poses[8:]
    return [Group(np.concatenate(p), np.repeat(np.arange(len(p)), [len(x) for x in p])) for p in sides]


def frames(pairs):
    return set(zip(pairs.first.tolist(), pairs.second.tolist(), strict=True))


@pytest.mark.parametrize("other", [0, 1])
def test_looking_into_every_cell_gives_the_bytes_of_the_exact_search(groups, other):
    a, b = groups[0], groups[other]
    every, found = exact_pairs(a, b, LIMIT, 2), cell_pairs(a, b, LIMIT, EVERYTHING, np.inf, 2)
    assert len(every.first) > 100
    for one, two in zip(every, found, strict=True):
        np.testing.assert_array_equal(one, two)


@pytest.mark.parametrize(("care", "least"), [(COARSE, 0.995), (APPROXIMATE, 0.98)])
@pytest.mark.parametrize("density", [np.inf, 2e-3])
def test_with_care_nearly_all_wanted_pairs_are_found_and_no_others(groups, care, least, density):
    a, b = groups
    every = exact_pairs(a, b, LIMIT, 2)
    wanted = capped(every, a, b, density)
    found = capped(cell_pairs(a, b, LIMIT, care, density, 2), a, b, density)
    assert frames(found) <= frames(every)
    assert len(frames(found) & frames(wanted)) >= least * len(wanted.first)


def test_where_two_clips_share_one_or_two_pairs_those_found_are_about_as_smooth(groups):
    a, b = groups
    wanted = capped(exact_pairs(a, b, LIMIT, 2), a, b, 1e-4)
    found = capped(cell_pairs(a, b, LIMIT, APPROXIMATE, 1e-4, 2), a, b, 1e-4)
    assert len(found.first) == len(wanted.first)
    assert found.distance.mean() - wanted.distance.mean() < 0.01 * LIMIT


def test_where_few_pairs_are_wanted_few_cells_are_looked_into(groups):
    a, b = groups
    every = cell_pairs(a, b, LIMIT, APPROXIMATE, np.inf, 2)
    few = cell_pairs(a, b, LIMIT, APPROXIMATE, 1e-4, 2)
    assert len(few.first) < len(every.first) / 4


def test_a_table_of_cells_is_exact_in_whole_quanta(groups):
    one, two = (cells_of(group, 2) for group in groups)
    table, quantum = cell_table(one, two)
    x, y = (np.rint(cells.poses.astype(np.float64) / quantum) for cells in (one, two))
    np.testing.assert_array_equal(table, ((x[:, None] - y[None]) ** 2).sum(-1))


def test_poses_far_out_get_a_larger_quantum_and_stay_exact():
    rng = np.random.default_rng(0)
    near, far = (Group(rng.normal(size=(40, 8)).astype(np.float32) * size, np.zeros(40)) for size in (1, 900))
    one, two = cells_of(near, 2), cells_of(far, 2)
    table, quantum = cell_table(one, two)
    assert quantum == two.quantum > one.quantum
    x, y = (np.rint(cells.poses.astype(np.float64) / quantum) for cells in (one, two))
    np.testing.assert_array_equal(table, ((x[:, None] - y[None]) ** 2).sum(-1))


def test_cells_hold_each_inner_frame_once(groups):
    for group in groups:
        cells = cells_of(group, 2)
        held = [np.arange(a, b) for a, b in zip(cells.start, cells.stop, strict=True)]
        np.testing.assert_array_equal(np.concatenate(held), np.flatnonzero(group.inner()))


def test_still_clips_give_one_pair_at_most_without_end():
    still = Group(np.zeros((600, 4), np.float32), np.repeat([0, 1], 300))
    assert len(cell_pairs(still, still, LIMIT, COARSE, 1e-3, 2).first) == 0


def test_caps_keep_the_smoothest_and_a_tighter_one_keeps_a_part(groups):
    a, b = groups
    every = exact_pairs(a, b, LIMIT, 2)
    wide, tight = capped(every, a, b, 1e-3), capped(every, a, b, 1e-4)
    assert 0 < len(tight.first) < len(wide.first) < len(every.first)
    assert frames(capped(wide, a, b, 1e-4)) == frames(tight)
    clip = a.clip_of[every.first] * 100 + b.clip_of[every.second]
    kept = np.isin(every.first * len(b) + every.second, tight.first * len(b) + tight.second)
    for one in np.unique(clip):
        mine = clip == one
        assert kept[mine].any()
        assert every.distance[mine & kept].max() <= every.distance[mine & ~kept].min(initial=np.inf)


def test_pairs_within_a_clip_are_not_capped(groups):
    a = groups[0]
    every = exact_pairs(a, a, LIMIT, 2)
    inside = a.clip_of[every.first] == a.clip_of[every.second]
    kept = capped(every, a, a, 1e-4)
    assert (a.clip_of[kept.first] == a.clip_of[kept.second]).sum() == inside.sum() > 0


def test_density_falls_by_halves_as_a_library_grows():
    assert density_for(1000) == np.inf
    found = [density_for(frames) for frames in range(40_000, 5_000_000, 100_000)]
    assert found == sorted(found, reverse=True)
    assert {np.log2(d) % 1 for d in found} == {0.0}
