"""Beats from a file: times, with or without their places in the bar, as people and programs write them."""

from __future__ import annotations

import math
import os
import re
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np

from onbeat._shapes import Ints, Times
from onbeat.errors import AudioError

LARGEST = 32 << 20  # bytes: a day of beats is 5 MB
LONGEST_BAR = 64  # beats
ENDINGS = ".beats, .txt, .csv, .tsv or .json"


class BeatList(NamedTuple):
    """Beats (B,) in seconds of the sound file; their places in the bar (B,) from 1, or None where none are given."""

    times: Times
    places: Ints | None = None


class _Entry(NamedTuple):
    where: str  # for messages: `file:line`
    time: float
    place: int | None


def read_beats(path: str | os.PathLike[str], duration: float = math.inf) -> BeatList:
    """Read beats or taps.

    A text file has a beat a line: seconds, and perhaps its place in the bar (1 = downbeat), parted by blanks, a comma
    or a semicolon; lines that begin with ``#`` and a heading are passed over. A JSON file is a ``song.json``, a list of
    numbers, or an object with ``beats`` and perhaps ``downbeats``.

    Parameters
    ----------
    path : the file.
    duration : seconds of the song; no beat may lie outside of it.

    Raises
    ------
    AudioError
        With file and line, if a time is no number, does not follow the one before, or lies outside of the song; or if
        there are fewer than two.
    """
    path = Path(path)
    text = _text(path)
    entries = _from_json(path, text) if path.suffix.lower() in (".json", ".jams") else _from_lines(path, text)
    _check(path, entries, duration)
    times = np.array([entry.time for entry in entries])
    places = [entry.place for entry in entries]
    if all(place is None for place in places):
        return BeatList(times)
    for entry in entries:
        if entry.place is None:
            raise AudioError(
                f"{entry.where}: no place in the bar, but other beats have one; give one to all or to none"
            )
    return BeatList(times, np.array(places, dtype=np.int64))


def _text(path: Path) -> str:
    try:
        if path.stat().st_size > LARGEST:
            raise AudioError(f"{path}: has {path.stat().st_size >> 20} MB; expected a list of beats, at most 32 MB")
        return path.read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise AudioError(f"{path}: cannot be read: {error.strerror or error}; give a file of beats") from None
    except UnicodeDecodeError:
        raise AudioError(f"{path}: is not text; expected beats as {ENDINGS}") from None


def _from_lines(path: Path, text: str) -> list[_Entry]:
    entries: list[_Entry] = []
    for number, line in enumerate(text.splitlines(), 1):
        words = [word for word in re.split(r"[\s,;]+", line.partition("#")[0]) if word]
        if not words or (not entries and re.match(r"[A-Za-z_]", words[0]) and _number(words[0]) is None):
            continue  # an empty line, or a heading
        time = _number(words[0])
        if time is None:
            raise AudioError(f"{path}:{number}: {words[0][:40]!r} is not a time; expected seconds, as 12.34")
        entries.append(_Entry(f"{path}:{number}", time, _place(f"{path}:{number}", words[1]) if words[1:] else None))
    return entries


def _number(word: str) -> float | None:
    try:
        return float(word)
    except ValueError:
        return None


def _place(where: str, word: str) -> int:
    place = _number(word)
    if place is None or not place.is_integer() or not 1 <= place <= LONGEST_BAR:
        raise AudioError(
            f"{where}: place {word[:40]!r} in the bar; expected a whole number from 1 (the downbeat) to {LONGEST_BAR}"
        )
    return int(place)


def _from_json(path: Path, text: str) -> list[_Entry]:
    try:
        found: Any = msgspec.json.decode(text)
    except (msgspec.DecodeError, RecursionError) as error:
        raise AudioError(f"{path}: is not JSON: {error}; expected beats as {ENDINGS}") from None
    beats = found.get("beats") if isinstance(found, dict) else found
    downbeats = found.get("downbeats") if isinstance(found, dict) else None
    beats, downbeats = _numbers(path, "beats", beats), _numbers(path, "downbeats", downbeats or [])
    entries = [_Entry(f"{path}: beat {number}", time, None) for number, time in enumerate(beats, 1)]
    return _with_downbeats(path, entries, downbeats) if downbeats else entries


def _numbers(path: Path, name: str, values: Any) -> list[float]:
    if not isinstance(values, list) or not all(type(value) in (int, float) for value in values):
        raise AudioError(f"{path}: its {name} are no list of numbers; expected seconds, as in a song.json")
    try:
        return [float(value) for value in values]
    except OverflowError:
        raise AudioError(f"{path}: one of its {name} is too large for a time; expected seconds") from None


def _with_downbeats(path: Path, entries: list[_Entry], downbeats: list[float]) -> list[_Entry]:
    """The beats counted from each downbeat on; those before the first count back from it."""
    times = np.array([entry.time for entry in entries])
    is_down = np.isin(times, np.array(downbeats, dtype=np.float64))
    if is_down.sum() != len(set(downbeats)):
        raise AudioError(f"{path}: one of the downbeats is not among the beats; each has to be one of them")
    starts = np.flatnonzero(is_down)
    bar = int(np.bincount(np.diff(starts)).argmax()) if len(starts) > 1 else len(entries)
    latest = starts[np.maximum(np.searchsorted(starts, np.arange(len(times)), side="right") - 1, 0)]
    places = [(index - start) % bar if index < starts[0] else index - start for index, start in enumerate(latest)]
    return [entry._replace(place=int(place) + 1) for entry, place in zip(entries, places, strict=True)]


def _check(path: Path, entries: list[_Entry], duration: float) -> None:
    before: _Entry | None = None
    for entry in entries:
        if not math.isfinite(entry.time):
            raise AudioError(f"{entry.where}: {entry.time} is not a time; expected seconds, as 12.34")
        if before is not None and entry.time <= before.time:
            raise AudioError(
                f"{entry.where}: {entry.time:g} s does not follow the {before.time:g} s before it; "
                "times have to increase"
            )
        if not 0.0 <= entry.time <= duration:
            raise AudioError(
                f"{entry.where}: {entry.time:g} s lies outside of the song, which lasts from 0 to {duration:.2f} s; "
                "are these its beats, in seconds?"
            )
        before = entry
    if len(entries) < 2:
        raise AudioError(f"{path}: holds {len(entries)} beats; expected at least 2, as seconds, one a line")
