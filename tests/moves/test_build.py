import pickle
import shutil
from functools import partial

import numpy as np
import pytest

from onbeat.errors import LibraryError
from onbeat.formats import write_motion
from onbeat.motion import Motion, Skeleton
from onbeat.motion.retarget import retarget
from onbeat.moves import build
from onbeat.moves.build import assemble, build_library
from onbeat.moves.library import SHORTEST
from onbeat.moves.making import joining, publish
from onbeat.moves.making import steps as making
from onbeat.moves.making.generations import Options
from onbeat.moves.making.groups import lots_of
from onbeat.moves.making.placing import batches
from onbeat.moves.recordings import Recording, find_recordings
from onbeat.moves.store import open_library
from persons import BVH, along_local_axes, person, swinging
from stored_libraries import kept, rows


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
        assert kept(lib) == kept(tmp_path / "fresh")
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


@pytest.fixture
def done(monkeypatch):
    """Notes each task that is really done: what and on what."""
    tasks: list[tuple[str, int]] = []

    def noting(module, name):
        work = getattr(module, name)

        def noted(task, *rest):
            count = len(task) if name == "look" else len(task.keys) if name == "search_blocks" else 1
            tasks.append((name, count))
            return work(task, *rest)

        monkeypatch.setattr(module, name, noted)

    noting(making, "look")
    noting(making, "place")
    noting(publish, "search_blocks")
    return tasks


def counted(tasks):
    found = {}
    while tasks:
        name, count = tasks.pop()
        found[name] = found.get(name, 0) + count
    return found


def test_unchanged_clips_are_neither_read_nor_placed_again_and_only_their_groups_are_searched(
    clips_folder, dances, tmp_path, done, monkeypatch
):
    monkeypatch.setattr(joining, "lots_of", partial(lots_of, size=300))  # a recording and its mirror image in each
    (clips_folder / "broken.bvh").write_text("x")
    build_library([clips_folder], tmp_path / "lib")
    assert counted(done) == {"look": 4, "place": 3, "search_blocks": 6}
    build_library([clips_folder], tmp_path / "lib")
    assert counted(done) == {}
    write_motion(dances[3], clips_folder / "bb.npz")
    build_library([clips_folder], tmp_path / "lib")
    assert counted(done) == {"look": 1, "place": 1, "search_blocks": 4}
    (clips_folder / "a.npz").rename(clips_folder / "zz.npz")
    build_library([clips_folder], tmp_path / "lib")
    assert counted(done) == {}
    build_library([clips_folder], tmp_path / "lib", mirror=False)
    assert list(counted(done)) == ["search_blocks"]


@pytest.mark.parametrize("when", ["reading", "placing", "comparing", "finding", "joining"])
def test_a_build_that_is_stopped_goes_on_where_it_was(clips_folder, tmp_path, done, when, monkeypatch):
    monkeypatch.setattr(joining, "lots_of", partial(lots_of, size=300))
    monkeypatch.setattr(joining, "RUN", 1)
    monkeypatch.setattr(making, "batches", partial(batches, size=1))

    def stop(what, share):
        if (what.startswith(when) and what != when and share > 0.06) or what == when == "joining":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        build_library([clips_folder], tmp_path / "lib", step=stop, workers=1)
    with pytest.raises(LibraryError, match="was not built to the end"):
        open_library(tmp_path / "lib")
    counted(done)
    had = [rows(tmp_path / "lib", f"SELECT count(*) FROM {table}")[0][0] for table in ("readings", "clips", "blocks")]
    build_library([clips_folder], tmp_path / "lib")
    again = counted(done)
    assert again.get("look", 0) == 3 - had[0]
    assert again.get("place", 0) == 3 - had[1] // 2
    assert again.get("search_blocks", 0) == 6 - had[2]
    assert sum(had) > 0
    build_library([clips_folder], tmp_path / "fresh")
    assert kept(tmp_path / "lib") == kept(tmp_path / "fresh")


def test_a_file_that_changes_while_it_is_read_is_told(clips_folder, dances, tmp_path, monkeypatch):
    read = Recording.has_changed

    def changing(recording):
        if recording.name == "b":
            write_motion(dances[7], recording.path)
        return read(recording)

    with monkeypatch.context() as patch:
        patch.setattr(Recording, "has_changed", changing)
        library = build_library([clips_folder], tmp_path / "lib")
    assert library.problems == ("b.npz: changed while it was read; build again when nobody writes to it",)
    assert [clip.name for clip in library.clips] == ["a", "a~mirror", "c", "c~mirror"]
    library = build_library([clips_folder], tmp_path / "lib")
    assert library.problems == ()
    assert len(library.clips) == 6


def test_a_clip_longer_than_a_group_has_the_joins_of_the_whole(dances, tmp_path, monkeypatch):
    motion = dances[0]
    many = motion.replace(
        rotations=np.concatenate([d.rotations for d in dances[:4]]),
        root_positions=np.concatenate([d.root_positions for d in dances[:4]]),
    )
    write_motion(many, tmp_path / "long.npz")
    write_motion(dances[6], tmp_path / "short.npz")
    whole = build_library([tmp_path], tmp_path / "whole", mirror=False).graph
    monkeypatch.setattr(joining, "lots_of", partial(lots_of, size=100))
    cut = build_library([tmp_path], tmp_path / "cut", mirror=False).graph
    assert len(rows(tmp_path / "cut", "SELECT * FROM blocks")) > 20
    for name in ("indptr", "targets", "costs"):
        np.testing.assert_array_equal(getattr(whole, name), getattr(cut, name))


def test_options_are_part_of_what_is_kept(clips_folder, tmp_path):
    lib = tmp_path / "lib"
    assert len(build_library([clips_folder], lib).clips) == 6
    assert len(build_library([clips_folder], lib, mirror=False).clips) == 3
    assert build_library([clips_folder], lib, mirror=False, fps=60).seconds == pytest.approx(6)
    build_library([clips_folder], lib)
    build_library([clips_folder], tmp_path / "fresh")
    assert kept(lib) == kept(tmp_path / "fresh")


def test_what_other_code_made_is_not_built_upon(clips_folder, tmp_path, done, monkeypatch):
    build_library([clips_folder], tmp_path / "lib")
    first = counted(done)
    for module in (making, build):
        monkeypatch.setattr(module, "method_digest", lambda: "other")
    monkeypatch.setattr(making, "reading_method", lambda: "other")
    build_library([clips_folder], tmp_path / "lib")
    assert counted(done)["place"] == first["place"]
    build_library([clips_folder], tmp_path / "lib")
    assert counted(done) == {}


def test_the_number_of_workers_does_not_change_a_byte(clips_folder, tmp_path):
    build_library([clips_folder], tmp_path / "one", workers=1)
    build_library([clips_folder], tmp_path / "three", workers=3)
    assert kept(tmp_path / "one") == kept(tmp_path / "three")


def test_tasks_can_be_sent_to_other_machines(clips_folder, tmp_path, monkeypatch):
    """As an engine of processes does, without starting one."""

    def sent(tasks, work, done, engine=None, progress=None, *, failed=None, parts=None):
        for task in tasks:
            there, job, get = pickle.loads(pickle.dumps((task, work, parts and parts.get)))
            done(task, pickle.loads(pickle.dumps(job(there, *map(get, parts.needs(there)) if parts else ()))))

    build_library([clips_folder], tmp_path / "here")
    for module in (making, publish):
        monkeypatch.setattr(module, "run", sent)
    build_library([clips_folder], tmp_path / "there")
    assert kept(tmp_path / "here") == kept(tmp_path / "there")


def test_in_memory_it_is_the_same_library(clips_folder, tmp_path):
    stored = build_library([clips_folder], tmp_path / "lib")
    made = assemble(find_recordings([clips_folder]), Options())
    assert [clip.name for clip in made.clips] == [clip.name for clip in stored.clips]
    for one, other in zip(made.clips, stored.clips, strict=True):
        assert one.motion.rotations.tobytes() == other.motion.rotations.tobytes()
        assert one.poses.tobytes() == other.poses.tobytes()
    for name in ("clip_of", "indptr", "targets", "costs"):
        np.testing.assert_array_equal(getattr(made.graph, name), getattr(stored.graph, name))


def test_who_dances_is_told_by_a_table(clips_folder, tmp_path):
    (tmp_path / "about.csv").write_text("file,performer,genre\n*,anna,\nb.npz,berta,salsa\n")
    library = build_library([clips_folder], tmp_path / "lib", mirror=False, about=tmp_path / "about.csv")
    assert [tuple(clip.about) for clip in library.clips] == [
        ("anna", None, None),
        ("berta", "salsa", None),
        ("anna", None, None),
    ]


def test_progress_goes_from_nothing_to_all(clips_folder, tmp_path):
    steps = []
    build_library([clips_folder], tmp_path / "lib", step=lambda what, share: steps.append((what, share)))
    shares = [share for _, share in steps]
    assert shares == sorted(shares)
    assert shares[0] == 0
    assert shares[-1] == 1
    assert {what.split()[0] for what, _ in steps} == {"reading", "placing", "comparing", "finding", "joining", "done"}


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
