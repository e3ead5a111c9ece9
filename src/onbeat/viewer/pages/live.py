"""``live.html``: the live stage, which shows what a session sends over a WebSocket at its own address."""

from __future__ import annotations

from importlib import resources

from onbeat.errors import OnbeatError

_MARK = b'content="onbeat live"'


def live_page() -> bytes:
    """The page as bytes of HTML, everything inside; it asks nobody but its own ``/live`` and ``/sound``.

    Raises
    ------
    OnbeatError
        If the built page is missing or damaged.

    Examples
    --------
    >>> live_page().startswith(b"<!doctype html>")
    True
    """
    file = resources.files("onbeat.viewer") / "static" / "live.html"
    try:
        page = file.read_bytes()
    except OSError:
        page = b""
    if _MARK not in page or not page.rstrip().endswith(b"</html>"):
        raise OnbeatError(f"{file} is missing or damaged; install onbeat again, or run `npm run build` in viewer-js")
    return page
