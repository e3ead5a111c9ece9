"""``onbeat songs``: songs with free licences by one word."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import cyclopts

from onbeat.cli.fetching import fetch_named, list_sources
from onbeat.cli.moves_fetch import print_fetched

songs_app = cyclopts.App(name="songs", help="List songs with free licences, and fetch them.")
Flag = cyclopts.Parameter(negative=())


@songs_app.default
def list_command(*, json: Annotated[bool, Flag] = False) -> None:
    """List songs with free licences, and fetch them.

    Example: ``onbeat songs fetch vibe-ace``

    Parameters
    ----------
    json
        Print the list as JSON.
    """
    list_sources("songs", as_json=json)


@songs_app.command(name="fetch")
def fetch_command(
    name: str,
    /,
    *,
    to: Path | None = None,
    renew: Annotated[bool, Flag] = False,
    json: Annotated[bool, Flag] = False,
) -> None:
    """Fetch a song; its licence is shown first and kept with it.

    The path of its sound is printed on stdout; ``onbeat dance`` and ``onbeat listen`` take ``song:NAME``.

    Example: ``onbeat songs fetch vibe-ace``

    Parameters
    ----------
    name
        What to fetch.
    to
        A folder of its own, instead of ``songs/NAME`` in ``ONBEAT_DATA`` or the user's data folder.
    renew
        Fetch it again.
    json
        Print the receipt as JSON.
    """
    receipt, folder = fetch_named("songs", name, to, renew=renew)
    sound = folder / receipt.files[0].path
    print_fetched(receipt, sound, as_json=json)
    song = f"song:{name}" if to is None else sound
    print(f"next: onbeat dance {song}", file=sys.stderr)  # noqa: T201
