"""``dance.html`` of a dance that was just made: with the motion graph it goes through, and its time warp."""

from __future__ import annotations

import os

import msgspec

from onbeat._shapes import Float32
from onbeat.dance.make import Dance
from onbeat.dance.warp import Warp
from onbeat.keyposes.extract import Keyposes
from onbeat.moves.library import MoveLibrary
from onbeat.viewer.contract import PageData, WarpData
from onbeat.viewer.pages.content import page_data
from onbeat.viewer.pages.graph_drawn import drawn_graph
from onbeat.viewer.pages.page import write_filled


def write_dance_page(
    path: str | os.PathLike[str],
    dance: Dance,
    library: MoveLibrary,
    audio: tuple[Float32, int] | None = None,
    keyposes: Keyposes | None = None,
) -> None:
    """Write the page of a dance to a file, whole or not at all; arguments and errors as :func:`dance_page_data`."""
    write_filled(path, dance_page_data(dance, library, audio, keyposes))


def dance_page_data(
    dance: Dance,
    library: MoveLibrary,
    audio: tuple[Float32, int] | None = None,
    keyposes: Keyposes | None = None,
) -> PageData:
    """What the page shows of a dance.

    Parameters
    ----------
    dance : as it was made.
    library : whose graph it goes through.
    audio : samples (N, channels) in -1…1 and their rate in Hz; None for a silent page.
    keyposes : those of the dance; None for a page without them.

    Raises
    ------
    OnbeatError
        If the samples are not a sound.
    """
    document = msgspec.to_builtins(dance.document)
    page = page_data(dance.motion, dance.song, document, audio, keyposes)
    graph = drawn_graph(library, [move.clip for move in dance.document.moves])
    return msgspec.structs.replace(page, graph=graph, warp=None if dance.warp is None else _told(dance.warp))


def _told(warp: Warp) -> WarpData:
    return WarpData(warp.knots.round(4).tolist(), warp.values.round(4).tolist())
