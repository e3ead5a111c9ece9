"""``onbeat moves fetch``: motion capture by one word."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import cyclopts

from onbeat.cli.fetching import fetch_named, list_sources
from onbeat.errors import OnbeatError

Flag = cyclopts.Parameter(negative=())


def fetch_command(
    name: str | None = None,
    /,
    *,
    to: Path | None = None,
    list_: Annotated[bool, cyclopts.Parameter(name="--list", negative=())] = False,
    renew: Annotated[bool, Flag] = False,
    json: Annotated[bool, Flag] = False,
) -> None:
    """Fetch motion capture that others have made free, or list what is known.

    Its licence is shown first and kept with it. A download that was stopped goes on when it is run again. Where it was
    put is printed on stdout; ``onbeat dance`` takes its name for ``--moves``.

    Example: ``onbeat moves fetch cmu-dance``

    Parameters
    ----------
    name
        What to fetch; without it what is known is listed.
    to
        A folder of its own, instead of ``moves/NAME`` in ``ONBEAT_DATA`` or the user's data folder.
    list_
        List what is known, and what is here.
    renew
        Fetch it again, and trust what comes now where its publisher tells no checksums.
    json
        Print the list as JSON, or the receipt.
    """
    if name is None or list_:
        if to is not None or renew:
            raise OnbeatError("--to and --renew are of something to fetch; give its name, and no --list")
        list_sources("moves", as_json=json)
        return
    receipt, folder = fetch_named("moves", name, to, renew=renew)
    print_fetched(receipt, folder, as_json=json)
    moves = name if to is None else folder
    print(f"next: onbeat dance SONG --moves {moves}", file=sys.stderr)  # noqa: T201


def print_fetched(receipt: object, place: Path, *, as_json: bool) -> None:
    """Where something was put, or its receipt, on stdout."""
    import msgspec

    if as_json:
        sys.stdout.write(msgspec.json.format(msgspec.json.encode(receipt), indent=2).decode() + "\n")
    else:
        sys.stdout.write(f"{place}\n")
