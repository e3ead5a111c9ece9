"""``onbeat dance``: from a song to a dance."""

from __future__ import annotations

import contextlib
import math
import os
import shutil
import sys
import tempfile
from collections.abc import Generator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import cyclopts
from threadpoolctl import threadpool_limits

from onbeat.cli.corrections import NO_FLAGS, CorrectionFlags
from onbeat.cli.dance_song import Sound, hear
from onbeat.cli.dance_told import next_command, tell_left_out, tell_made, tell_remarks
from onbeat.cli.fetching import moves_path, song_path
from onbeat.cli.progress import Stages, warnings_as_lines
from onbeat.cli.swapped import refuse_swapped
from onbeat.cli.video_flags import NO_VIDEO, Film, VideoFlags
from onbeat.cli.wish_flags import NO_WISH_FLAGS, WishFlags
from onbeat.dance.make import LONGEST, Dance, danceable, make_dance
from onbeat.errors import LibraryError, OnbeatError, PlanError
from onbeat.files import make_folder
from onbeat.moves.library import MoveLibrary

if TYPE_CHECKING:
    from onbeat.keyposes.extract import Keyposes

FPS, RATES = (1.0, 1000.0), (0.1, 10000.0)
PARTS = {
    "listening": 14.0, "moves": 4.0, "searching": 24.0, "dancing": 11.0, "warping": 15.0, "measuring": 10.0,
    "writing": 22.0,
}  # fmt: skip
"""How long the stages last against each other."""


def dance_command(
    song: Path | None = None,
    /,
    moves: Path | None = None,
    *,
    output: Annotated[Path, cyclopts.Parameter(name=["-o", "--output"])] = Path("dance"),
    seconds: float | None = None,
    start: float = 0.0,
    seed: int = 0,
    method: Literal["optimal", "shiratori2006", "greedy", "walk"] = "optimal",
    rhythm_only: Annotated[bool, cyclopts.Parameter(negative="")] = False,
    fps: float | None = None,
    source_fps: float | None = None,
    warp: bool = True,
    mirror: bool = True,
    video: VideoFlags = NO_VIDEO,
    json: Annotated[bool, cyclopts.Parameter(negative="")] = False,
    flags: CorrectionFlags = NO_FLAGS,
    wished: WishFlags = NO_WISH_FLAGS,
) -> None:
    """Dance to a song with the moves of a folder of motion capture.

    Parameters
    ----------
    song
        Any audio file: wav, flac, ogg, mp3; m4a and video with the extra ``video``; or ``song:NAME`` of one that
        ``onbeat songs fetch`` fetched. Without one the embedded song is played.
    moves
        A motion file (.bvh, .amc, .c3d, .trc, .csv, .npz, .pkl), a folder of them, a library made by ``onbeat moves
        build``, or the name of a set that ``onbeat moves fetch`` fetched. Without it the embedded troupe dances.
    output
        Folder for dance.bvh, dance.glb, dance.html, dance.json and song.json.
    seconds
        How much of the song to dance to.
    start
        Second of the song to begin at.
    seed
        Of the embedded song, of the method ``walk``, of what is danced beside stretches that are kept, and of the
        chance that scores are held against; the same seed gives the same bytes.
    method
        How moves are chosen: ``optimal`` over the whole song, ``shiratori2006`` three seconds ahead as in the paper,
        ``greedy`` three seconds ahead on our objective, ``walk`` at random.
    rhythm_only
        Follow the beat alone, not the music's intensity.
    fps
        Frames per second of the dance; by default those of the moves.
    source_fps
        Frames a second of motion files that store none (AMC, a robot's CSV); all of --moves are read at it.
    warp
        Move stops onto the beats by a small time warp.
    mirror
        Dance mirror images of the moves, too.
    video
        A video, dance.mp4.
    json
        Print dance.json on stdout instead of a table.
    flags
        What was heard wrong of the song, and how it is right.
    wished
        What to dance, what not, and what to keep of an earlier dance.
    """
    refuse_swapped(song, moves, "onbeat dance {song} --moves {motion}")
    _check(seconds, start, seed, fps)
    _check_source_rate(source_fps, moves)
    _check_output(output)
    wishes = wished.wishes()
    film = video.film()
    song_file = None if song is None else song_path(song)
    clips = None if moves is None else moves_path(moves)
    if clips is not None and not clips.exists():
        raise LibraryError(f"no file or folder {moves}; give a folder of motion files (BVH, AMC, C3D …) to --moves")
    with warnings_as_lines(), threadpool_limits(1, "blas"), Stages(PARTS) as stages:  # bits do not depend on threads
        fixes = flags.corrections()
        heard, sound = hear(song_file, start, seconds, seed, fixes, stages)
        danceable(heard, fixes.tells_tempo)  # a song that is not is told before the moves are read
        library = _library(clips, mirror, source_fps, stages)
        dance = make_dance(
            heard, library, fps=fps, seed=seed, method=method, rhythm_only=rhythm_only, warp=warp, wishes=wishes,
            as_told=fixes.tells_tempo, step=stages,
        )  # fmt: skip
        with _staged(output) as folder:
            _write(folder, dance, library, sound, film, stages)
    tell_left_out(library)
    tell_remarks(dance, library, output)
    if json:
        print(dance.document.to_json().decode(), end="")  # noqa: T201
        return
    words = next_command(sys.argv[1:], song is not None, moves is not None, film is not None)
    tell_made(dance, output, words)


def _check(seconds: float | None, start: float, seed: int, fps: float | None) -> None:
    if seconds is not None and not 0 < seconds <= LONGEST:
        raise PlanError(f"--seconds {seconds:g}: give more than 0 and at most {LONGEST:g}")
    if not 0 <= start < math.inf:
        raise PlanError(f"--start {start:g}: give a second of the song, 0 or later")
    if not 0 <= seed < 2**63:
        raise PlanError(f"--seed {seed}: give a whole number from 0 to 2^63 - 1")
    if fps is not None and not FPS[0] <= fps <= FPS[1]:
        raise PlanError(f"--fps {fps:g}: give a rate from {FPS[0]:g} to {FPS[1]:g} frames a second")


def _check_source_rate(rate: float | None, moves: Path | None) -> None:
    """Refuse a rate that cannot be, or of no files that are read now."""
    from onbeat.moves.store import is_library

    if rate is None:
        return
    if not RATES[0] <= rate <= RATES[1]:
        raise PlanError(f"--source-fps {rate:g}: give a rate from {RATES[0]:g} to {RATES[1]:g} frames a second")
    if moves is None:
        raise PlanError("--source-fps: it is the rate of the files of --moves; give them, too")
    if is_library(moves):
        raise LibraryError(f"--source-fps: {moves} is built already; build it again, `onbeat moves build` takes it")


def _check_output(output: Path) -> None:
    """Refuse a folder that cannot be written before the work, not after it."""
    try:
        there = next(place for place in (output, *output.absolute().parents) if place.exists())
    except OSError as error:
        raise OnbeatError(f"cannot write into {output}: {error.strerror}; choose another folder with -o") from None
    if not there.is_dir():
        raise OnbeatError(f"cannot write into {output}: {there} is not a folder; choose another folder with -o")
    if not os.access(there, os.W_OK | os.X_OK):
        raise OnbeatError(f"cannot write into {output}: no right to write in {there}; choose another folder with -o")


def _library(moves: Path | None, mirror: bool, fps: float | None, stages: Stages) -> MoveLibrary:
    from onbeat.moves.cache import build_or_open
    from onbeat.moves.embedded import embedded_library

    def step(what: str, share: float) -> None:
        stages("moves", share, what)

    if moves is None:
        return embedded_library(mirror=mirror, step=step)
    return build_or_open(moves, mirror=mirror, fps=fps, step=step)


@contextlib.contextmanager
def _staged(output: Path) -> Generator[Path]:
    """A folder beside the output whose files are moved into it when all are written, else removed."""
    new = not output.exists()
    folder: Path | None = None
    try:
        make_folder(output)
        folder = Path(tempfile.mkdtemp(prefix=".dance-", dir=output))
        yield folder
        for file in sorted(folder.iterdir()):
            os.replace(file, output / file.name)
    except OSError as error:
        raise OnbeatError(
            f"cannot write into {output}: {error.strerror or error}; choose another folder with -o"
        ) from None
    except OnbeatError as error:
        raise OnbeatError(str(error).replace(str(folder), str(output))) from None
    finally:
        if folder is not None:
            shutil.rmtree(folder, ignore_errors=True)
        if new:
            with contextlib.suppress(OSError):  # goes only if nothing was put into it
                output.rmdir()


def _write(folder: Path, dance: Dance, library: MoveLibrary, sound: Sound, film: Film | None, stages: Stages) -> None:
    from onbeat.files import write_atomically
    from onbeat.formats.write import write_motion
    from onbeat.viewer.pages.dance import write_dance_page

    stages("writing", 0.0)
    write_motion(dance.motion, folder / "dance.bvh")
    stages("writing", 0.3)
    write_motion(dance.motion, folder / "dance.glb")
    stages("writing", 0.5)
    write_dance_page(folder / "dance.html", dance, library, sound, _keyposes(dance))
    write_atomically(folder / "dance.json", dance.document.to_json())
    write_atomically(folder / "song.json", dance.song.to_json())
    stages("writing", 1.0)
    if film:
        _film(folder / "dance.mp4", dance, sound, film, stages)


def _film(path: Path, dance: Dance, sound: Sound, film: Film, stages: Stages) -> None:
    from onbeat.viewer.film.flashes import Flashes
    from onbeat.viewer.video import write_video

    flashes = Flashes.on(dance.song.beats, dance.song.downbeats) if film.flash else None
    write_video(
        path, dance.motion, dance.song, sound, fps=film.fps, size=film.size, stops=dance.stops, flashes=flashes,
        progress=lambda share: stages("filming", share),
    )  # fmt: skip


def _keyposes(dance: Dance) -> Keyposes | None:
    """The keyposes of the dance on the beats it dances to; None where it is too short to have any."""
    from onbeat.keyposes.extract import find_keyposes

    try:
        return find_keyposes(dance.motion, dance.song.beats)
    except OnbeatError:
        return None
