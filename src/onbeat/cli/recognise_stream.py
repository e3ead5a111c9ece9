"""``onbeat recognise --stream``: a motion gone through as if it were danced now, a line for each segment as it ends."""

from __future__ import annotations

from pathlib import Path

from onbeat.cli.keypose_input import BeatFlags, read_dance
from onbeat.cli.progress import warnings_as_lines
from onbeat.cli.recognise_input import Probe, beats_beside
from onbeat.cli.recognise_output import print_json, row_of
from onbeat.formats.read import fitted
from onbeat.motion import Markers
from onbeat.recognition.recogniser import Recogniser
from onbeat.recognition.streaming import Ended, Listener

CHUNK = 0.1
"""Seconds of frames that come at a time."""


def stream_probe(recogniser: Recogniser, path: Path, flags: BeatFlags, span: int) -> None:
    """Print a line of JSON for each segment of a motion file, in the order in which they end."""
    with warnings_as_lines():
        source, beats, _ = read_dance(path, beats_beside(path, flags))
        motion = fitted(source, path, None).motion if isinstance(source, Markers) else source
    listener = Listener(recogniser, span)
    frames = max(1, round(CHUNK * motion.fps))
    beats = beats[beats >= 0.0]
    for first in range(0, len(motion), frames):
        now, before = (first + frames) / motion.fps, first / motion.fps
        _print(path, listener.push(motion[first : first + frames], beats[(beats >= before) & (beats < now)]))
    _print(path, listener.finish())


def _print(path: Path, ended: list[Ended]) -> None:
    for one in ended:
        print_json(row_of(Probe(str(path), one.start, one.end), one.prediction), indent=0)
