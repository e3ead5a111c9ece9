"""The song of ``onbeat dance``: a file or the embedded one, heard and kept as sound, from where to where is asked."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from onbeat._shapes import Float32
from onbeat.cli.progress import Stages
from onbeat.dance.make import LONGEST, clock
from onbeat.errors import AudioError, PlanError

if TYPE_CHECKING:
    from onbeat.music.fixes import Corrections
    from onbeat.music.song import Song

Sound = tuple[Float32, int]
EMBEDDED = 60.0  # seconds of the embedded song where no others are asked for
LONG = 480.0  # seconds from which on a dance takes its time
PAGE = 23e3  # bytes of a page, of one second
SOUND = 48000  # Hz, the highest rate that pages and films hold


def hear(
    song: Path | None, start: float, seconds: float | None, seed: int, fixes: Corrections, stages: Stages
) -> tuple[Song, Sound]:
    """The song as heard and its sound, both from ``start`` on."""
    from onbeat.music.audio import audio_duration, read_stereo
    from onbeat.music.listen import listen

    if song is None:
        return _hear_embedded(start, seconds, seed, fixes, stages)
    stages("listening", 0.0)
    length = audio_duration(song)
    if length <= 0:
        raise AudioError(f"{song}: holds no sound (0 samples); expected a song")
    if start >= length:
        raise PlanError(f"--start {start:g}: {song} lasts {length:.1f} s")
    wanted = min(seconds or length, length - start)
    if wanted > LONGEST:
        raise PlanError(
            f"{song} lasts {clock(length)}{'' if start == 0 else f', from --start on {clock(wanted)}'}; a dance lasts "
            f"at most {clock(LONGEST)}: choose a stretch with --start and --seconds"
        )
    if wanted >= LONG:
        told = f"a dance of {clock(wanted)} takes some minutes, its page about {wanted * PAGE / 1e6:.0f} MB"
        print(f"onbeat: {told}; --seconds makes a shorter one", file=sys.stderr)  # noqa: T201
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
