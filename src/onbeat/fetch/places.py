"""Where what was fetched lies, and how it is found again by name."""

from __future__ import annotations

import os
from pathlib import Path

import platformdirs

from onbeat.errors import FetchError
from onbeat.fetch.receipts import receipt_of
from onbeat.fetch.sources import COMMANDS, Kind, Source, source_named


def data_folder() -> Path:
    """Where data is fetched to: ``ONBEAT_DATA``, or the user's data folder."""
    chosen = os.environ.get("ONBEAT_DATA")
    return Path(chosen) if chosen else Path(platformdirs.user_data_dir("onbeat"))


def folder_of(source: Source) -> Path:
    """Where a source is fetched to by default."""
    return data_folder() / source.kind / source.name


def is_fetched(source: Source) -> bool:
    """Whether a source lies in its place, whole."""
    return receipt_of(folder_of(source)) is not None


def fetched_moves(name: str) -> Path:
    """The folder of a motion set that was fetched; a ``FetchError`` says how to fetch it, or what names there are."""
    return _fetched("moves", name)


def fetched_song(name: str) -> Path:
    """The sound file of a song that was fetched; a ``FetchError`` as of :func:`fetched_moves`."""
    return _fetched("songs", name) / source_named("songs", name).files[0].path


def _fetched(kind: Kind, name: str) -> Path:
    source = source_named(kind, name)
    if source.by_hand:
        raise FetchError(by_hand(source))
    if not is_fetched(source):
        raise FetchError(f"{name} is not fetched yet ({folder_of(source)} is not there): run {COMMANDS[kind]} {name}")
    return folder_of(source)


def by_hand(source: Source) -> str:
    """How a person gets what may not be fetched by a program, in a sentence."""
    told = source.by_hand.format(page=source.page, licence_url=source.licence_url)
    return f"{source.name} cannot be fetched by one word: {told}"
