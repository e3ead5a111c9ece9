"""Checksums of files that no publisher tells: what came first is trusted, and all that comes later held against it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from onbeat.errors import FetchError
from onbeat.fetch.sources import RemoteFile, Source
from onbeat.files import make_folder, write_atomically

KNOWN = "known.json"


def key_of(source: Source, file: RemoteFile) -> str:
    """Under which a file's checksum is kept."""
    return f"{source.kind}/{source.name}/{file.path}"


def known_checksums(data: Path) -> dict[str, str]:
    """The checksums that were recorded in a data folder; none where nothing was fetched yet.

    Raises
    ------
    FetchError
        If the record is damaged.
    """
    path = data / KNOWN
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        if isinstance(found, dict) and all(isinstance(v, str) and len(v) == 64 for v in found.values()):
            return found
    except FileNotFoundError:
        return {}
    except (OSError, ValueError, RecursionError):
        pass
    raise FetchError(f"{path}, the record of checksums, is damaged; delete it and fetch again")


def remember(data: Path, new: Mapping[str, str]) -> None:
    """Add checksums to the record of a data folder."""
    if not new:
        return
    both = {**known_checksums(data), **new}
    write_atomically(make_folder(data) / KNOWN, (json.dumps(both, indent=1, sort_keys=True) + "\n").encode())
