"""The job of a song: its sound as browsers play it to the sample, what is heard in it, and curves to draw."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from onbeat._shapes import Array, Float32
from onbeat.errors import AudioError
from onbeat.files import write_atomically
from onbeat.music.audio import audio_duration, native_blocks, read_blocks
from onbeat.music.listen import listen
from onbeat.music.song import Song
from onbeat.studio.song_view import SONG, Curves
from onbeat.studio.tasks import Done, ListenTask, SoundSource
from onbeat.studio.telling import Tell
from onbeat.viewer.contract import CurveData, pack_curve

SOUND, CURVES = "sound.wav", "curves.json"
EMBEDDED = 60.0
"""Seconds of the embedded song."""
LONGEST = 7200.0
"""Seconds of a song that is taken."""
HIGHEST = 48000
"""Hz of the sound that is played."""
WAVEFORM_RATE, CURVE_RATE, FINE = 50.0, 10.0, 4000
"""Values a second of the waveform and of the intensity; Hz at which the waveform is measured."""
COMPOSED, GIVEN = {"composing": 3.0, "listening": 4.0, "beats": 2.0}, {"reading": 1.0, "listening": 4.0, "beats": 2.0}
"""The stages of a song that is made here, and of one that a user gives."""


def listened(task: ListenTask, tell: Tell) -> Done:
    """Hear a song and write what the studio needs of it."""
    tell, out = tell.of(COMPOSED if task.song.file is None else GIVEN), Path(task.out)
    try:
        _write_sound(task.song, out / SOUND, tell)
        song = _heard(task.song, out / SOUND, tell)
    except AudioError as error:
        raise AudioError(with_name(str(error), task.song, out / SOUND)) from None
    write_atomically(out / SONG, song.to_json())
    curves = Curves(_waveform(out / SOUND), _intensity(song))
    write_atomically(out / CURVES, msgspec.json.encode(curves))
    return Done(seconds=song.duration, tempo=song.tempo, meter=song.meter)


def with_name(text: str, song: SoundSource, *paths: Path) -> str:
    """What is said of a song's files, said of the song by its name."""
    for path in (song.file, *map(str, paths)):
        text = text if path is None else text.replace(path, song.name)
    return text


def _heard(song: SoundSource, sound: Path, tell: Tell) -> Song:
    length = audio_duration(sound)

    def told(second: float) -> None:
        tell("listening", second / length)
        if second >= length:
            tell("beats", 0.0, "finding the beats")

    found = listen(sound, progress=told)
    return replace(found, title=song.name)


def _write_sound(song: SoundSource, sound: Path, tell: Tell) -> None:
    """The song as WAV, whose second 0 is the same for every browser and for those who hear it."""
    import soundfile

    writer: Any = None
    blocks = _composed(tell) if song.file is None else _read(Path(song.file), tell)
    try:
        for block, rate in blocks:
            if writer is None:
                writer = soundfile.SoundFile(sound, "w", rate, block.shape[1], "PCM_16", format="WAV")
            writer.write(np.clip(block, -1.0, 1.0))
    finally:
        if writer is not None:
            writer.close()
    if writer is None:
        raise AudioError(f"{song.name}: there is no sound in it; give a song")


def _composed(tell: Tell) -> Iterator[tuple[Float32, int]]:
    from onbeat.examples import embedded_song

    tell("composing", 0.0)
    _, samples, rate = embedded_song(EMBEDDED, 0)
    yield samples, rate


def _read(file: Path, tell: Tell) -> Iterator[tuple[Float32, int]]:
    """The blocks of a file, stereo or mono, at 48 kHz at most."""
    import soxr

    length = audio_duration(file)
    if length > LONGEST:
        raise AudioError(f"{file} lasts {length / 3600:.1f} hours; a song of up to {LONGEST / 3600:.0f} is taken")
    stream: soxr.ResampleStream | None = None
    passed, rate, channels = 0, HIGHEST, 1
    for block, native in native_blocks(file):
        part = block if block.shape[1] <= 2 else block.mean(axis=1, keepdims=True, dtype=np.float32)
        passed, rate, channels = passed + len(part), min(native, HIGHEST), part.shape[1]
        if rate < native:
            stream = stream or soxr.ResampleStream(native, rate, channels, dtype="float32")
            part = stream.resample_chunk(np.ascontiguousarray(part))
        tell("reading", passed / native / max(length, 1.0))
        yield part, rate
    if stream is not None:
        yield stream.resample_chunk(np.zeros((0, channels), np.float32), last=True), rate


def _waveform(sound: Path) -> CurveData:
    """Root mean square of each 20 ms, the loudest being 1."""
    step = round(FINE / WAVEFORM_RATE)
    samples = np.concatenate(list(read_blocks(sound, rate=FINE)))
    padded = np.pad(samples, (0, -len(samples) % step)).reshape(-1, step)
    level: Array = np.sqrt(np.square(padded, dtype=np.float64).mean(axis=1))
    return pack_curve(level / max(float(level.max(initial=0.0)), 1e-9), WAVEFORM_RATE)


def _intensity(song: Song) -> CurveData:
    values = song.intensity_at(np.arange(int(song.duration * CURVE_RATE) + 1) / CURVE_RATE)
    return pack_curve(values / max(float(values.max(initial=0.0)), 1e-9), CURVE_RATE)
