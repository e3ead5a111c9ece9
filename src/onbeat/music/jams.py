"""A song as JAMS, the JSON in which music research exchanges annotations (Humphrey et al. 2014; schema 0.3)."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import Any

import msgspec
import numpy as np

from onbeat.music.song import Song
from onbeat.music.table import bar_numbers, bar_positions

SCHEMA = "0.3.4"

Observation = dict[str, Any]


def to_jams(song: Song, software: str) -> bytes:
    """The song as JAMS bytes: beats, bars, chords, sections, tempo and key; what is not known is left out.

    Parameters
    ----------
    song : what was heard.
    software : name and version of what heard it.
    """
    annotations = [
        _annotation(song, software, namespace, data)
        for namespace, data in (
            ("beat", _beats(song)),
            ("beat_position", _places(song)),
            ("chord", _chords(song)),
            ("segment_open", _sections(song)),
            ("tempo", _tempo(song)),
            ("key_mode", _key(song)),
        )
        if data
    ]
    file = {"title": song.title, "artist": "", "release": "", "duration": round(song.duration, 4)}
    document = {
        "annotations": annotations,
        "file_metadata": {**file, "identifiers": {}, "jams_version": SCHEMA},
        "sandbox": {"tuning": round(song.tuning, 1)},
    }
    return msgspec.json.encode(document) + b"\n"


def _annotation(song: Song, software: str, namespace: str, data: list[Observation]) -> dict[str, Any]:
    about = {
        "curator": {"name": "", "email": ""},
        "annotator": {},
        "version": "",
        "corpus": "",
        "annotation_tools": software,
        "annotation_rules": "",
        "validation": "",
        "data_source": f"program ({song.method})",
    }
    return {
        "annotation_metadata": about,
        "namespace": namespace,
        "data": data,
        "sandbox": {},
        "time": 0,
        "duration": round(song.duration, 4),
    }


def _observation(time: float, duration: float, value: object, confidence: float | None = None) -> Observation:
    sure = None if confidence is None else round(confidence, 4)
    return {"time": round(time, 4), "duration": round(max(duration, 0.0), 4), "value": value, "confidence": sure}


def _confidence(song: Song) -> Iterable[float | None]:
    return song.confidence.tolist() if len(song.confidence) else [None] * len(song.beats)


def _beats(song: Song) -> list[Observation]:
    places = bar_positions(song).tolist()
    rows = zip(song.beats.tolist(), places, _confidence(song), strict=True)
    return [_observation(time, 0.0, place, sure) for time, place, sure in rows]


def _places(song: Song) -> list[Observation]:
    rows = zip(song.beats.tolist(), bar_positions(song).tolist(), bar_numbers(song).tolist(), strict=True)
    return [
        _observation(
            time, 0.0, {"position": place, "measure": bar, "num_beats": max(song.meter, place), "beat_units": 4}
        )
        for time, place, bar in rows
    ]


def _chords(song: Song) -> list[Observation]:
    """Equal chords one after the other as one."""
    if not song.chord_root:
        return []
    roots = np.array(song.chord_root)
    starts = np.concatenate([[0], np.flatnonzero(roots[1:] != roots[:-1]) + 1])
    times = [*song.beats[starts].tolist(), song.duration]
    return [
        _observation(begin, end - begin, song.chord_root[first])
        for (begin, end), first in zip(pairwise(times), starts.tolist(), strict=True)
    ]


def _sections(song: Song) -> list[Observation]:
    return [_observation(part.start, part.end - part.start, part.kind) for part in song.sections]


def _tempo(song: Song) -> list[Observation]:
    """The whole song's tempo first, then the tempo as it wanders, from beat to beat."""
    if song.tempo <= 0.0:
        return []
    curve = song.tempo_curve
    ends = [*curve.times[1:].tolist(), song.duration]
    rows = zip(curve.times.tolist(), ends, curve.bpm.tolist(), strict=True)
    whole = _observation(0.0, song.duration, round(song.tempo, 3), 1.0)
    return [whole, *(_observation(time, end - time, round(bpm, 3), 1.0) for time, end, bpm in rows)]


def _key(song: Song) -> list[Observation]:
    return [_observation(0.0, song.duration, song.key)] if song.key else []
