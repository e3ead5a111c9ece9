"""Wishes: what is kept is danced again to the frame, what is forbidden never, what is liked not less than before."""

from __future__ import annotations

import warnings
from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import msgspec
import numpy as np
import pytest

import walkable
from onbeat.dance import search as module
from onbeat.dance.document import DanceDocument
from onbeat.dance.greedy import greedy_path
from onbeat.dance.make import Dance, make_dance
from onbeat.dance.optimal import Path, Problem, ValueToGo, best_path
from onbeat.dance.search import METHODS, search
from onbeat.dance.variety import beam_path
from onbeat.dance.walk import random_walk
from onbeat.dance.wished import OtherBeatsWarning, Wished
from onbeat.dance.wishes import Kept, Wishes
from onbeat.errors import PlanError
from onbeat.examples import embedded_motions
from onbeat.moves.cache import build_from
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import Song
from walkable import brute_force, check_path, random_problem

SECONDS = 9.0
FPS = 30
STRETCHES = ("salsa@0.00", "salsa@0.00~mirror", "salsa@3.95", "salsa@3.95~mirror", "bow", "bow~mirror")


def song_of(seconds: float) -> Song:
    beats, clock = np.arange(0.3, seconds, 0.6), np.arange(0.0, seconds, 0.1)
    return Song(seconds, 100.0, 4, beats, beats[::4], np.zeros(len(beats)), clock, 0.5 + 0.3 * np.sin(clock))


@pytest.fixture(scope="module")
def few(tmp_path_factory: pytest.TempPathFactory) -> MoveLibrary:
    """Three clips of the troupe and their mirror images: joining all takes long."""
    kept = tmp_path_factory.mktemp("library")
    return MoveLibrary.of(build_from(lambda: embedded_motions()[:3], "three clips", kept, workers=1).clips)


@pytest.fixture(scope="module")
def dance(few: MoveLibrary) -> Dance:
    return make_dance(song_of(SECONDS), few, fps=FPS)


@pytest.fixture(scope="module")
def earlier(dance: Dance) -> DanceDocument:
    return DanceDocument.from_json(dance.document.to_json())


def shown(dance: Dance, library: MoveLibrary) -> tuple[list[str], np.ndarray]:
    """The name of the clip that each frame of a dance shows, and the second of it."""
    used = sorted({move.clip for move in dance.plan.moves})
    return [library.clips[used[clip]].name for clip in dance.realised.clips.tolist()], dance.realised.seconds


def frames_of(path: Path, total: int) -> np.ndarray:
    """(T,) the virtual frame that a path shows at each song frame."""
    ends = [*path.times[1:].tolist(), total]
    runs = zip(path.times.tolist(), path.entries.tolist(), ends, strict=True)
    return np.concatenate([f + np.arange(end - t) for t, f, end in runs])


def keeping(count: int, seed: int) -> list[Problem]:
    """Random problems in which a few frames of a random dance, or two, are kept."""
    rng = np.random.default_rng(seed)
    found: list[Problem] = []
    while len(found) < count:
        problem = random_problem(rng)
        try:
            frames = frames_of(random_walk(problem, rng), problem.music.frames)
        except PlanError:
            continue
        begin, length = int(rng.integers(0, len(frames))), int(rng.integers(1, 9))
        kept = np.full(len(frames), -1, np.int32)
        kept[begin : begin + length] = frames[begin : begin + length]
        kept[-1] = frames[-1] if rng.uniform() < 0.3 else kept[-1]
        found.append(replace(problem, kept=kept))
    return found


def test_the_optimum_with_something_kept_is_what_trying_all_ways_finds(monkeypatch: pytest.MonkeyPatch) -> None:
    worth, bound = walkable.shown_worth, 0

    def of_kept(problem: Problem, t: int, f: int) -> float:
        return -np.inf if problem.must[t] not in (-1, f) else worth(problem, t, f)

    monkeypatch.setattr(walkable, "shown_worth", of_kept)
    for problem in keeping(15, seed=1):
        best, value = brute_force(problem), ValueToGo(problem)
        assert value.optimum == pytest.approx(best, abs=1e-3)
        paths = [best_path(value), beam_path(problem, value, beam=500, repeat=0.0)]
        assert [path.score for path in paths] == pytest.approx([best, best], abs=1e-3)
        paths += [beam_path(problem, value), greedy_path(problem, 0.2), random_walk(problem, np.random.default_rng(0))]
        for path in paths:
            check_path(problem, path)
            assert path.score <= best + 1e-3
            frames = frames_of(path, problem.music.frames)
            np.testing.assert_array_equal(frames[problem.must >= 0], problem.must[problem.must >= 0])
        bound += best < ValueToGo(replace(problem, kept=None)).optimum - 0.01
    assert bound > 4  # what is kept is not what would be danced anyway


@pytest.mark.parametrize("method", ["optimal", "shiratori2006"])
def test_a_kept_stretch_is_danced_again_to_the_frame(
    few: MoveLibrary, dance: Dance, earlier: DanceDocument, method: str
) -> None:
    again = make_dance(
        song_of(SECONDS), few, fps=FPS, seed=3, method=method, wishes=Wishes(kept=(Kept(earlier, 3.0, 6.5),))
    )
    stretch = slice(round(3.0 * FPS), round(6.5 * FPS) + 1)
    (was, then), (now, seconds) = shown(dance, few), shown(again, few)
    assert now[stretch] == was[stretch]
    np.testing.assert_allclose(seconds[stretch], then[stretch], atol=1e-6)
    arm = dance.motion.skeleton.index("LeftForeArm")
    turned = np.abs(np.sum(again.motion.rotations[stretch, arm] * dance.motion.rotations[stretch, arm], axis=-1))
    assert turned.min() > 1 - 1e-6
    assert now != was  # the rest is found anew
    assert again.document.metrics["wishes"]["kept_s"] == 3.5


def test_a_stretch_can_be_kept_of_a_dance_that_kept_one(few: MoveLibrary, dance: Dance, earlier: DanceDocument) -> None:
    second = make_dance(song_of(SECONDS), few, fps=FPS, seed=1, wishes=Wishes(kept=(Kept(earlier, 0.0, 4.0),)))
    document = DanceDocument.from_json(second.document.to_json())
    third = make_dance(
        song_of(SECONDS), few, fps=FPS, seed=2, wishes=Wishes(kept=(Kept(earlier, 0.0, 2.0), Kept(document, 6.5, 9.0)))
    )
    (was, then), (between, after), (now, seconds) = (shown(d, few) for d in (dance, second, third))
    first, last = slice(0, 2 * FPS + 1), slice(round(6.5 * FPS), 9 * FPS)
    assert now[first] == was[first]
    assert now[last] == between[last]
    np.testing.assert_allclose(seconds[first], then[first], atol=1e-6)
    np.testing.assert_allclose(seconds[last], after[last], atol=1e-6)


def test_with_nothing_else_wished_the_same_dance_comes_out(
    few: MoveLibrary, dance: Dance, earlier: DanceDocument
) -> None:
    again = make_dance(song_of(SECONDS), few, fps=FPS, wishes=Wishes(kept=(Kept(earlier, 3.0, 5.0),)))
    assert again.plan == dance.plan
    assert again.document.moves == dance.document.moves
    none = search(few, song_of(SECONDS), wished=Wished.of(Wishes(), few, song_of(SECONDS), seed=4))
    assert none.plan == dance.plan
    assert none.objective == dance.found.objective
    assert b"warp" not in dance.document.to_json().replace(b"before_warp", b"").replace(b'"warp": {', b"")


@pytest.mark.parametrize("largest", [10**9, 1000])
@pytest.mark.parametrize("method", METHODS)
def test_forbidden_clips_never_appear_whole_or_in_part(
    few: MoveLibrary, monkeypatch: pytest.MonkeyPatch, largest: int, method: str
) -> None:
    monkeypatch.setattr(module, "LARGEST", largest)
    monkeypatch.setattr(module, "PART", 3000)
    song, names = song_of(6.0), [clip.name for clip in few.clips]
    wished = Wished.of(Wishes(forbidden=frozenset({names[0], names[3]})), few, song)
    assert names[1] == f"{names[0]}~mirror"
    assert wished.marks.forbidden.tolist() == [True, True, False, True, False, False]
    found = search(few, song, method=method, wished=wished)
    assert not {move.clip for move in found.plan.moves} & {0, 1, 3}
    assert (found.searched is None) == (largest > 1000)


def test_the_name_of_a_recording_means_all_its_stretches() -> None:
    clips = [SimpleNamespace(name=name, source=n // 2, mirrored=n % 2 == 1) for n, name in enumerate(STRETCHES)]
    library = cast("MoveLibrary", SimpleNamespace(clips=clips))
    marks = Wishes(forbidden=frozenset({"salsa"}), favourites=frozenset({"salsa@3.95", "bow"})).marks(library)
    assert marks.forbidden.tolist() == [True, True, True, True, False, False]
    assert marks.favourites.tolist() == [False, False, False, False, True, True]
    marks = Wishes(forbidden=frozenset({"salsa@3.95"})).marks(library)
    assert marks.forbidden.tolist() == [False, False, True, True, False, False]
    with pytest.raises(PlanError, match="no clip 'sals'"):
        Wishes(forbidden=frozenset({"sals"})).marks(library)


def test_a_kept_stretch_is_in_the_part_of_a_great_library(
    few: MoveLibrary, earlier: DanceDocument, dance: Dance, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "LARGEST", 1000)
    monkeypatch.setattr(module, "PART", 400)
    wishes = Wishes(kept=(Kept(earlier, 4.0, 6.0),))
    again = make_dance(song_of(SECONDS), few, fps=FPS, seed=9, wishes=wishes)
    assert again.found.searched is not None
    stretch = slice(4 * FPS, 6 * FPS + 1)
    assert shown(again, few)[0][stretch] == shown(dance, few)[0][stretch]


def test_the_share_of_favourites_does_not_fall(few: MoveLibrary) -> None:
    song, rose = song_of(SECONDS), 0
    plain = search(few, song, variety=False)
    for clip in few.clips[::2]:
        wished = Wished.of(Wishes(favourites=frozenset({clip.name})), few, song)
        before, after = (
            wished.told(found.plan, few)["favourites_s"]
            for found in (plain, search(few, song, variety=False, wished=wished))
        )
        assert before is not None
        assert after is not None
        assert after >= before - 1e-9
        rose += after > before
    assert rose >= 2


def test_refusals(few: MoveLibrary, earlier: DanceDocument) -> None:
    names = frozenset(clip.name for clip in few.clips)
    kept = Kept(earlier, 3.0, 5.0)

    def of(wishes: Wishes, seconds: float = SECONDS, clips: int = 6) -> Wished:
        return Wished.of(wishes, MoveLibrary(few.clips[:clips], few.graph), song_of(seconds))

    shown_then = next(move.clip for move in reversed(earlier.moves) if move.at_s < 3.0)
    moved = [msgspec.structs.replace(move, to_s=move.to_s + 0.01) for move in earlier.moves]
    odd = Kept(msgspec.structs.replace(earlier, moves=moved), 3.0, 5.0)
    for make, message in (
        (lambda: Wishes(frozenset({"a"}), frozenset({"a"})), "clip 'a' is forbidden and a favourite"),
        (lambda: Kept(earlier, 5.0, 5.0), "cannot keep 5 to 5 s"),
        (lambda: Kept(earlier, 5.0, 11.0), "the earlier dance lasts 9 s"),
        (lambda: Kept(earlier, float("nan"), 5.0), "cannot keep nan to 5 s"),
        (lambda: of(Wishes(forbidden=frozenset({"Ajko"}))), "no clip 'Ajko' among the 6"),
        (lambda: of(Wishes(forbidden=names)), "all 6 clips are forbidden"),
        (lambda: of(Wishes(kept=(kept,)), 4.0), "the song lasts 4.00 s"),
        (lambda: of(Wishes(frozenset({shown_then}), kept=(kept,))), "which is forbidden; keep another"),
        (lambda: of(Wishes(kept=(kept,)), clips=1), "which the library does not have"),
        (lambda: of(Wishes(kept=(odd,))), "do not fill its 9 s at the playback rates"),
    ):
        with pytest.raises(PlanError, match=message):
            make()


def test_a_stretch_of_a_dance_to_other_beats_is_told(few: MoveLibrary, earlier: DanceDocument) -> None:
    song, wishes = song_of(SECONDS), Wishes(kept=(Kept(earlier, 3.0, 5.0),))
    with pytest.warns(OtherBeatsWarning, match="3 to 5 s is kept of a dance to other beats: 0 of its 3 beats"):
        Wished.of(wishes, few, replace(song, beats=song.beats + 0.3))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Wished.of(wishes, few, song)


def test_no_way_between_what_is_kept_is_said() -> None:
    problem = next(p for p in keeping(50, seed=2) if p.hold > 2 and p.music.frames > 12)
    frames = np.full(problem.music.frames, -1, np.int32)
    frames[5], frames[7] = 3, 2  # back by one frame: no join is so soon after another
    with pytest.raises(PlanError, match="no dance keeps the stretches that are to be kept"):
        ValueToGo(replace(problem, kept=frames))
