import shutil

import numpy as np
import pytest

from onbeat.errors import LibraryError
from onbeat.formats import write_motion
from onbeat.motion import Motion, Skeleton
from onbeat.motion.retarget import retarget
from onbeat.moves import manifest
from onbeat.moves.build import Old, build_library
from onbeat.moves.library import SHORTEST
from persons import BVH, along_local_axes, person, swinging


def files(folder):
    """All that a library's folder holds, by name; the lock holds a process number."""
    return {
        p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file() and p.name != ".lock"
    }


@pytest.mark.parametrize("count", [1, 3, 17])
def test_as_many_clips_as_there_are(dances, tmp_path, count):
    for n, motion in enumerate(dances[:count]):
        write_motion(motion, tmp_path / f"{n:02}.npz")
    library = build_library([tmp_path], tmp_path / "lib")
    assert [clip.name for clip in library.clips[:2]] == ["00", "00~mirror"]
    assert [clip.source for clip in library.clips] == [n for n in range(count) for _ in "ab"]
    assert [clip.mirrored for clip in library.clips] == [False, True] * count
    assert len({clip.motion.skeleton for clip in library.clips}) == 1
    assert library.seconds == pytest.approx(4 * count)
    assert library.problems == ()
    assert library.graph.join_count > 100 or count < 17


def test_a_single_clip_of_two_seconds(dances, tmp_path):
    write_motion(dances[0][:60], tmp_path / "short.bvh")
    library = build_library([tmp_path / "short.bvh"], tmp_path / "lib", mirror=False)
    assert [clip.name for clip in library.clips] == ["short"]
    assert len(library.graph) == 60


def test_rates_may_be_mixed(dances, tmp_path):
    for dance, fps in zip(dances, (30, 60, 120), strict=False):
        write_motion(dance.resampled(fps), tmp_path / f"at{fps:03}.npz")
    library = build_library([tmp_path], tmp_path / "lib", mirror=False)
    assert [clip.motion.fps for clip in library.clips] == [30, 60, 60]
    joins = library.graph.clip_of[library.graph.sources] != library.graph.clip_of[library.graph.targets]
    assert joins.sum() > 20


def test_a_rate_changes_hardly_anything(dances, tmp_path):
    poses = []
    for fps in (30, 60, 120):
        write_motion(dances[0].resampled(fps), tmp_path / f"at{fps:03}.npz")
        library = build_library([tmp_path / f"at{fps:03}.npz"], tmp_path / f"lib{fps}", mirror=False)
        poses.append(library.clips[0].poses)
    slow, middle, fast = poses
    np.testing.assert_allclose(fast, middle, atol=1e-3)
    # 30 fps do not see how the velocity changes between two frames
    assert np.sqrt(np.mean(np.sum((slow - fast) ** 2, axis=1))) < 0.1


def test_one_take_in_two_formats_is_used_once(dances, tmp_path):
    write_motion(dances[0], tmp_path / "a.npz")
    write_motion(dances[0], tmp_path / "b.bvh")
    write_motion(dances[1], tmp_path / "c.npz")
    library = build_library([tmp_path], tmp_path / "lib", mirror=False)
    assert [clip.name for clip in library.clips] == ["a", "c"]
    assert library.problems == ("b.bvh: moves as a does, all along",)


def test_bodies_of_two_naming_schemes_become_one(dances, tmp_path):
    for n, motion in enumerate(dances[:3]):
        body = motion if n < 2 else retarget(motion, person())
        write_motion(body, tmp_path / f"{n}.npz")
    library = build_library([tmp_path], tmp_path / "lib", mirror=False)
    assert library.problems == ()
    assert {clip.motion.skeleton for clip in library.clips} == {dances[0].skeleton}
    for clip, motion in zip(library.clips, dances, strict=False):
        wrists = [motion.skeleton.index(name) for name in ("LeftHand", "RightHand")]
        apart = np.linalg.norm(np.diff(clip.motion.positions[:, wrists], axis=1), axis=-1)
        was = np.linalg.norm(np.diff(motion.positions[:, wrists], axis=1), axis=-1)
        assert np.abs(apart - was).mean() < 0.1


def test_the_skeleton_of_most_seconds_is_the_library_s(dances, tmp_path):
    small = retarget(dances[2], person(0.8))
    write_motion(small, tmp_path / "a.npz")
    write_motion(dances[0].resampled(15.0), tmp_path / "b.npz")
    write_motion(dances[1].resampled(15.0), tmp_path / "c.npz")
    library = build_library([tmp_path], tmp_path / "lib")
    assert library.clips[0].motion.skeleton == dances[0].skeleton


def test_a_tie_of_skeletons_goes_to_the_first_name(dances, tmp_path):
    write_motion(retarget(dances[0], person()), tmp_path / "a.npz")
    write_motion(dances[1], tmp_path / "b.npz")
    assert build_library([tmp_path], tmp_path / "lib").clips[0].motion.skeleton == person()


def test_clips_stand_on_the_floor(dances, tmp_path):
    write_motion(
        dances[0].replace(root_positions=dances[0].root_positions + np.array([0, 0, 0.5])), tmp_path / "high.npz"
    )
    for clip in build_library([tmp_path], tmp_path / "lib").clips:
        assert abs(np.percentile(clip.motion.positions[..., 2].min(1), 5)) < 0.01


def test_what_cannot_be_used_is_told_in_a_line_each(clips_folder, dances, tmp_path):
    (clips_folder / "broken.bvh").write_text("HIERARCHY\nnonsense\n")
    (clips_folder / "body.bvh").write_text(BVH)
    (clips_folder / "nothing.npz").write_bytes(b"")
    (clips_folder / "alone.amc").write_text("1\nroot 0 0 0 0 0 0\n")
    write_motion(dances[5][:27], clips_folder / "brief.npz")
    shutil.copy(clips_folder / "a.npz", clips_folder / "twin.npz")
    library = build_library([clips_folder], tmp_path / "lib")
    assert [clip.name for clip in library.clips if not clip.mirrored] == ["a", "b", "c"]
    told = dict(line.split(": ", 1) for line in library.problems)
    assert set(told) == {"broken.bvh", "body.bvh", "nothing.npz", "alone.amc", "brief.npz", "twin.npz"}
    assert told["brief.npz"] == f"too short: 0.9 s, at least {SHORTEST:.1f} s are needed"
    assert told["twin.npz"] == "the same as a.npz"
    assert "no skeleton" in told["alone.amc"]
    assert "no joint found for" in told["body.bvh"]
    assert not any("\n" in line or str(tmp_path) in line for line in library.problems)


def test_nothing_good_is_an_error_with_the_count_and_the_first_reason(tmp_path, dances):
    with pytest.raises(LibraryError, match="no motion files in"):
        build_library([tmp_path], tmp_path / "lib")
    with pytest.raises(LibraryError, match="no file or folder"):
        build_library([tmp_path / "none"], tmp_path / "lib")
    for name in "xy":
        (tmp_path / f"{name}.bvh").write_text(f"not a motion {name}")
    with pytest.raises(LibraryError, match=r"^none of 2 files can be used; x\.bvh: [^\n]+$"):
        build_library([tmp_path], tmp_path / "lib")
    write_motion(dances[0][:10], tmp_path / "z.npz")
    with pytest.raises(LibraryError, match=r"^the only file cannot be used; z\.npz: too short: 0\.3 s"):
        build_library([tmp_path / "z.npz"], tmp_path / "lib")
    assert not (tmp_path / "lib").exists()


def test_a_body_whose_roles_are_not_known_is_left_out(clips_folder, tmp_path):
    limbs = along_local_axes(swinging(person(), frames=90, fps=30))  # a rest pose that does not tell them either
    names = [f"joint{n}" for n in range(len(limbs.skeleton))]
    strange = Skeleton(names, limbs.skeleton.parents, limbs.skeleton.offsets, limbs.skeleton.end_sites)
    write_motion(Motion(strange, limbs.rotations, limbs.root_positions, 30), clips_folder / "who.npz")
    library = build_library([clips_folder], tmp_path / "lib")
    assert len(library.problems) == 1
    assert library.problems[0].startswith("who.npz: no joint found for")


def test_files_of_one_stem_keep_their_suffix(dances, tmp_path):
    write_motion(dances[0], tmp_path / "a.npz")
    write_motion(dances[2], tmp_path / "a.bvh")
    (tmp_path / "deep").mkdir()
    write_motion(dances[1], tmp_path / "deep" / "a.npz")
    library = build_library([tmp_path], tmp_path / "lib", mirror=False)
    assert [clip.name for clip in library.clips] == ["a.bvh", "a.npz", "deep/a.npz"]


def test_only_what_changed_is_made_again_and_nothing_else_differs(clips_folder, dances, tmp_path):
    lib = tmp_path / "lib"
    build_library([clips_folder], lib)

    def changed():
        """Build again where the old library is, and afresh; both must be the same to the last byte."""
        build_library([clips_folder], lib)
        build_library([clips_folder], tmp_path / "fresh")
        assert files(lib) == files(tmp_path / "fresh")
        shutil.rmtree(tmp_path / "fresh")

    write_motion(dances[3], clips_folder / "0.npz")  # before all others
    changed()
    write_motion(dances[4], clips_folder / "b.npz")  # another content
    changed()
    (clips_folder / "a.npz").unlink()
    changed()
    (clips_folder / "c.npz").rename(clips_folder / "00.npz")  # another order and name
    changed()
    (clips_folder / "broken.bvh").write_text("x")
    changed()
    for n in (5, 6, 7):  # another skeleton has the most seconds
        write_motion(retarget(dances[n], person()), clips_folder / f"{n}.npz")
    changed()


def test_unchanged_clips_are_neither_placed_nor_joined_again(clips_folder, dances, tmp_path, monkeypatch):
    from onbeat.moves import build
    from onbeat.moves.clips import Stage

    lib = tmp_path / "lib"
    build_library([clips_folder], lib)
    write_motion(dances[3], clips_folder / "bb.npz")
    placed, searched = [], []
    clips, pairs = Stage.clips, build.clip_pairs
    monkeypatch.setattr(Stage, "clips", lambda s, read, n, mirror: placed.append(n) or clips(s, read, n, mirror=mirror))

    def counting(poses, limit, wanted, **options):
        searched.extend((a, b) for a in range(8) for b in range(a, 8) if wanted(a, b))
        return pairs(poses, limit, wanted, **options)

    monkeypatch.setattr(build, "clip_pairs", counting)
    build_library([clips_folder], lib)
    assert placed == [2]
    assert searched == [(a, b) for a in range(8) for b in range(a, 8) if {a, b} & {4, 5}]


def test_options_are_part_of_what_is_kept(clips_folder, tmp_path):
    lib = tmp_path / "lib"
    assert len(build_library([clips_folder], lib).clips) == 6
    assert len(build_library([clips_folder], lib, mirror=False).clips) == 3
    assert build_library([clips_folder], lib, mirror=False, fps=60).seconds == pytest.approx(6)
    build_library([clips_folder], lib)
    build_library([clips_folder], tmp_path / "fresh")
    assert files(lib) == files(tmp_path / "fresh")


def test_what_other_code_made_is_not_built_upon(clips_folder, tmp_path, monkeypatch):
    made = []
    monkeypatch.setattr(Old, "of", lambda folder, fps, of=Old.of: made.append(of(folder, fps)) or made[-1])
    build_library([clips_folder], tmp_path / "lib")
    monkeypatch.setattr(manifest, "method_digest", lambda: "other")
    build_library([clips_folder], tmp_path / "lib")
    build_library([clips_folder], tmp_path / "lib")
    assert [old.found for old in made] == [None, None]


def test_threads_do_not_change_a_byte(clips_folder, tmp_path):
    build_library([clips_folder], tmp_path / "one", workers=1)
    build_library([clips_folder], tmp_path / "three", workers=3)
    assert files(tmp_path / "one") == files(tmp_path / "three")


def test_progress_goes_from_nothing_to_all(clips_folder, tmp_path):
    steps = []
    build_library([clips_folder], tmp_path / "lib", step=lambda what, share: steps.append((what, share)))
    shares = [share for _, share in steps]
    assert shares == sorted(shares)
    assert shares[0] == 0
    assert shares[-1] == 1
    assert {what.split()[0] for what, _ in steps} == {"reading", "placing", "finding", "done"}


@pytest.mark.data
def test_real_clips_of_six_bodies(data, tmp_path):
    source = data / "cmu"
    names = ("01.asf", "01_01.bvh", "05.asf", "05_03.amc", "05_16.amc", "11.asf", "11_01.amc", "131_01.bvh")
    for name in names:
        shutil.copy(source / name, tmp_path / name)
    library = build_library([tmp_path], tmp_path / "lib")
    assert library.problems == ()
    assert len(library.clips) == 10
    assert library.graph.join_count > 500
    assert any("120 frames a second are assumed" in note for note in library.notes)
