"""``onbeat dance``: from a song to a dance."""

from __future__ import annotations

import contextlib
import math
import os
import shlex
import shutil
import sys
import tempfile
from collections.abc import Generator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import cyclopts
from rich.console import Console
from rich.table import Table
from rich.text import Text
from threadpoolctl import threadpool_limits

from onbeat._shapes import Float32
from onbeat.cli.corrections import NO_FLAGS, CorrectionFlags
from onbeat.cli.fetching import moves_path, song_path
from onbeat.cli.progress import Stages, warnings_as_lines
from onbeat.cli.video_flags import NO_VIDEO, Film, VideoFlags
from onbeat.cli.wish_flags import NO_WISH_FLAGS, WishFlags
from onbeat.dance.make import LONGEST, Dance, make_dance
from onbeat.errors import LibraryError, OnbeatError, PlanError
from onbeat.files import make_folder
from onbeat.moves.library import MoveLibrary
from onbeat.music.fixes import Corrections
from onbeat.music.song import Song

if TYPE_CHECKING:
    from onbeat.keyposes.extract import Keyposes

Sound = tuple[Float32, int]
FPS = (1.0, 1000.0)
EMBEDDED = 60.0  # seconds of the embedded song where no others are asked for
SOUND = 48000  # Hz, the highest rate that pages and films hold
TOLD = 5  # files left out that are told one by one


def dance_command(
    song: Path | None = None,
    /,
    *,
    moves: Path | None = None,
    output: Annotated[Path, cyclopts.Parameter(name=["-o", "--output"])] = Path("dance"),
    seconds: float | None = None,
    start: float = 0.0,
    seed: int = 0,
    method: Literal["optimal", "shiratori2006", "greedy", "walk"] = "optimal",
    rhythm_only: Annotated[bool, cyclopts.Parameter(negative="")] = False,
    fps: float | None = None,
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
        Motion files of any kind, a folder of them, a library made by ``onbeat moves build``, or the name of a set that
        ``onbeat moves fetch`` fetched. Without it the embedded troupe dances.
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
    _check(seconds, start, seed, fps)
    _check_output(output)
    wishes = wished.wishes()
    film = video.film()
    song_file = None if song is None else song_path(song)
    clips = None if moves is None else moves_path(moves)
    if clips is not None and not clips.exists():
        raise LibraryError(f"no file or folder {moves}; give a folder of BVH, ASF/AMC or npz motion to --moves")
    with warnings_as_lines(), threadpool_limits(1, "blas"), Stages() as stages:  # bits do not depend on threads
        heard, sound = _hear(song_file, start, seconds, seed, flags.corrections(), stages)
        library = _library(clips, mirror, stages)
        dance = make_dance(
            heard, library, fps=fps, seed=seed, method=method, rhythm_only=rhythm_only, warp=warp, wishes=wishes,
            step=stages,
        )  # fmt: skip
        with _staged(output) as folder:
            _write(folder, dance, library, sound, film, stages)
    _tell_left_out(library)
    if json:
        print(dance.document.to_json().decode(), end="")  # noqa: T201
        return
    screen = Console()
    screen.print(_table(dance, output))
    page = output / "dance.html"
    after = Text(f"Look at it: open {page}\nThen try: {_next(song, moves, film is not None)}")
    screen.print(after, soft_wrap=True)


def _check(seconds: float | None, start: float, seed: int, fps: float | None) -> None:
    if seconds is not None and not 0 < seconds <= LONGEST:
        raise PlanError(f"--seconds {seconds:g}: give more than 0 and at most {LONGEST:g}")
    if not 0 <= start < math.inf:
        raise PlanError(f"--start {start:g}: give a second of the song, 0 or later")
    if not 0 <= seed < 2**63:
        raise PlanError(f"--seed {seed}: give a whole number from 0 to 2^63 - 1")
    if fps is not None and not FPS[0] <= fps <= FPS[1]:
        raise PlanError(f"--fps {fps:g}: give a rate from {FPS[0]:g} to {FPS[1]:g} frames a second")


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


def _tell_left_out(library: MoveLibrary) -> None:
    """What is not in the library and what was assumed, a line each on stderr, of many the first."""
    lines = [*library.notes, *(f"left out {problem}" for problem in library.problems)]
    more = len(lines) - TOLD
    if more > 1:
        lines[TOLD:] = [f"… and {more} more; `onbeat moves build` tells all"]
    for line in lines:
        print(f"onbeat: {line}", file=sys.stderr)  # noqa: T201


def _hear(
    song: Path | None, start: float, seconds: float | None, seed: int, fixes: Corrections, stages: Stages
) -> tuple[Song, Sound]:
    """The song as heard and its sound, both from ``start`` on."""
    from onbeat.music.audio import audio_duration, read_stereo
    from onbeat.music.listen import listen

    if song is None:
        return _hear_embedded(start, seconds, seed, fixes, stages)
    stages("listening", 0.0)
    length = audio_duration(song)
    if start >= length:
        raise PlanError(f"--start {start:g}: {song} lasts {length:.1f} s")
    wanted = min(seconds or length, length - start)
    if wanted > LONGEST:
        raise PlanError(
            f"{song} lasts {length / 60:.0f} minutes; a dance lasts at most {LONGEST / 60:.0f}: "
            "choose a stretch with --start and --seconds"
        )
    heard = listen(
        song, start=start, seconds=wanted, progress=lambda s: stages("listening", s / wanted), corrections=fixes
    )
    return heard, read_stereo(song, start, wanted, highest=SOUND)


def _hear_embedded(
    start: float, seconds: float | None, seed: int, fixes: Corrections, stages: Stages
) -> tuple[Song, Sound]:
    import numpy as np
    import soxr

    from onbeat.examples import embedded_song
    from onbeat.music.audio import RATE, Audio
    from onbeat.music.listen import listen_samples

    length = max(EMBEDDED, start + (seconds or 0.0))
    if (seconds is None and start >= EMBEDDED) or length > LONGEST:
        longest = EMBEDDED if seconds is None else LONGEST
        raise PlanError(f"--start {start:g}: the embedded song lasts {longest:g} s; begin earlier")
    stages("composing", 0.0)
    _, samples, rate = embedded_song(length, seed)
    samples = samples[round(start * rate) :]
    samples = samples if seconds is None else samples[: round(seconds * rate)]
    stages("listening", 0.0)
    mono = np.asarray(soxr.resample(samples.mean(axis=1), rate, RATE), np.float32)
    return listen_samples(Audio(mono, RATE), title="the embedded song", corrections=fixes), (samples, rate)


def _library(moves: Path | None, mirror: bool, stages: Stages) -> MoveLibrary:
    from onbeat.moves.cache import build_or_open
    from onbeat.moves.embedded import embedded_library

    def step(what: str, share: float) -> None:
        stages("moves", share, what)

    if moves is None:
        return embedded_library(mirror=mirror, step=step)
    return build_or_open(moves, mirror=mirror, step=step)


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
    from onbeat.viewer.dance_page import write_dance_page

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
    from onbeat.viewer.flashes import Flashes
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


def _table(dance: Dance, output: Path) -> Table:
    metrics = dance.document.metrics
    source = metrics["feet"]["skate_source"]
    mirrored = metrics["variety"]["repeated_s_strict"] - metrics["variety"]["repeated_s"]
    before, after, variety = metrics["beats_before_warp"], metrics["beats"], metrics["variety"]
    song = dance.song
    table = Table(title=Text(f"{song.title}: {song.duration:.1f} s at {song.tempo:.0f} BPM → {output}"))
    table.add_column("figure")
    table.add_column("value", justify="right")
    table.add_column("what it says")
    rows = (
        (
            "on the beat, ±50 ms",
            after["f50"],
            ".2f",
            f"F-measure of stops and beats; {before['f50']:.2f} before the warp",
        ),
        ("on the beat, ±100 ms", after["f100"], ".2f", f"{before['f100']:.2f} before the warp"),
        ("against chance", after["f50_jitter_z"], ".1f", "standard deviations above beats shifted at random"),
        ("with the intensity", metrics["intensity"]["intensity_pearson"], ".2f", "correlation of hands and music"),
        ("joins a minute", variety["joins_per_minute"], ".0f", "from one clip to another"),
        ("feet at joins", metrics["feet"]["skate_joins"], ".3f", f"m/s of planted feet; {_of(source)} in the clips"),
        (
            "shown twice",
            variety["repeated_s"],
            ".1f",
            f"seconds of clips seen again; {mirrored:.1f} more as mirror images",
        ),
    )
    for name, value, digits, meaning in rows:
        table.add_row(name, "–" if value is None else format(value, digits), meaning)
    return table


def _of(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f}"


def _next(song: Path | None, moves: Path | None, video: bool) -> str:
    if song is None:
        return "onbeat dance YOUR_SONG.mp3"
    name = shlex.quote(str(song))
    if moves is None:
        return f"onbeat dance {name} --moves YOUR_CLIPS/"
    return f"onbeat dance {name} --moves {shlex.quote(str(moves))}" + (" --rhythm-only" if video else " --video")
