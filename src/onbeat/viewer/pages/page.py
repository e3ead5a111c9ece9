"""``dance.html``: one file that shows and plays a dance, without a server or a network."""

from __future__ import annotations

import os
from collections.abc import Mapping
from importlib import resources
from typing import Any

import msgspec

from onbeat._shapes import Float32
from onbeat.errors import OnbeatError
from onbeat.files import write_atomically
from onbeat.keyposes.extract import Keyposes
from onbeat.motion import Motion
from onbeat.music.song import Song
from onbeat.viewer.contract import PageData
from onbeat.viewer.pages.content import page_data

_SLOT = b"<!--onbeat-data-->"


def write_page(
    path: str | os.PathLike[str],
    motion: Motion,
    song: Song | None = None,
    document: Mapping[str, Any] | None = None,
    audio: tuple[Float32, int] | None = None,
    keyposes: Keyposes | None = None,
) -> None:
    """Write the page to a file, whole or not at all; arguments and errors as :func:`render_page`."""
    write_filled(path, page_data(motion, song, document, audio, keyposes))


def render_page(
    motion: Motion,
    song: Song | None = None,
    document: Mapping[str, Any] | None = None,
    audio: tuple[Float32, int] | None = None,
    keyposes: Keyposes | None = None,
) -> bytes:
    """The page as bytes of HTML; the same bytes for the same input.

    Parameters
    ----------
    motion : the dance. Its frames are thinned to at most 60 a second.
    song : what is heard in the song: beats, downbeats, intensity. None for a motion without music.
    document : ``dance.json`` as a mapping: stops, moves, metrics.
    audio : samples (N, channels) in -1…1 and their rate in Hz; None for a silent page.
    keyposes : those of the motion; None for a page without them.

    Raises
    ------
    OnbeatError
        If the document has other fields than ``dance.json``, or the samples are not a sound.
    """
    return filled(page_data(motion, song, document, audio, keyposes))


def write_filled(path: str | os.PathLike[str], page: PageData) -> None:
    """Write the page that shows this to a file, whole or not at all."""
    write_atomically(path, filled(page))


def filled(page: PageData) -> bytes:
    """The page that shows this, as bytes of HTML."""
    data = msgspec.json.encode(page)
    # Inside <script> only "<" can end or confuse the element, whatever names hold: JSON may write it as \u003c.
    data = data.replace(b"<", b"\\u003c")
    return _shell().replace(_SLOT, b'<script type="application/json" id="data">' + data + b"</script>", 1)


def _shell() -> bytes:
    """The built page without its data."""
    file = resources.files("onbeat.viewer") / "static" / "dance.html"
    try:
        shell = file.read_bytes()
    except OSError:
        shell = b""
    if _SLOT not in shell:
        raise OnbeatError(f"{file} is missing or damaged; install onbeat again, or run `npm run build` in viewer-js")
    return shell
