"""Other beat trackers, as their own pages say to call them; ``beats.py`` asks this file, in any interpreter.

Usage: ``python benchmarks/beat_peers.py librosa SONG…`` prints a line of JSON for each song: beats, downbeats (or null)
and CPU seconds. It needs nothing of onbeat, so that peers can live in an environment of their own; one that cannot be
imported ends the program with status 3.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from typing import Any

Heard = tuple[Any, Any]  # beats, downbeats or None; seconds


def librosa_beats() -> Callable[[str], Heard]:
    import librosa

    def hear(path: str) -> Heard:
        samples, rate = librosa.load(path)
        return librosa.beat.beat_track(y=samples, sr=rate, units="time")[1], None

    return hear


def aubio_beats() -> Callable[[str], Heard]:
    import aubio

    def hear(path: str) -> Heard:
        source = aubio.source(path, 0, 512)
        tracker = aubio.tempo("default", 1024, 512, source.samplerate)
        beats = []
        while True:
            samples, read = source()
            if tracker(samples):
                beats.append(tracker.get_last_s())
            if read < 512:
                return beats, None

    return hear


def btrack_beats() -> Callable[[str], Heard]:
    import btrack
    import numpy as np
    import soundfile
    import soxr

    def hear(path: str) -> Heard:
        samples, rate = soundfile.read(path, always_2d=True)
        return btrack.trackBeats(np.ascontiguousarray(soxr.resample(samples.mean(axis=1), rate, 44100))), None

    return hear


def madmom_beats() -> Callable[[str], Heard]:
    from madmom.features.downbeats import DBNDownBeatTrackingProcessor, RNNDownBeatProcessor

    activation, track = RNNDownBeatProcessor(), DBNDownBeatTrackingProcessor(beats_per_bar=[3, 4], fps=100)

    def hear(path: str) -> Heard:
        found = track(activation(path))
        return found[:, 0], found[found[:, 1] == 1, 0]

    return hear


PEERS = {"librosa": librosa_beats, "aubio": aubio_beats, "BTrack": btrack_beats, "madmom": madmom_beats}


def main() -> None:
    try:
        hear = PEERS[sys.argv[1]]()
    except ImportError:
        sys.exit(3)
    hear(sys.argv[2])  # compiled and loaded before it is timed
    for path in sys.argv[2:]:
        started = time.process_time()
        beats, downbeats = hear(path)
        cpu = time.process_time() - started
        row = {
            "beats": [float(beat) for beat in beats],
            "downbeats": None if downbeats is None else [float(beat) for beat in downbeats],
            "cpu": cpu,
        }
        print(json.dumps(row), flush=True)


if __name__ == "__main__":
    main()
