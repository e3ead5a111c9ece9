"""The studio's page: one file with everything inside, and which scripts it may run: those that it came with."""

from __future__ import annotations

import base64
import hashlib
import re
from functools import cache
from importlib import resources

from onbeat.errors import OnbeatError

_SCRIPT = re.compile(rb"<script([^>]*)>(.*?)</script>", re.DOTALL | re.IGNORECASE)


@cache
def page() -> tuple[bytes, dict[str, str]]:
    """The page's HTML and its headers.

    Raises
    ------
    OnbeatError
        If it is missing.
    """
    file = resources.files("onbeat.studio") / "static" / "studio.html"
    try:
        shell = file.read_bytes()
    except OSError:
        raise OnbeatError(f"{file} is missing; install onbeat again, or run `npm run build` in viewer-js") from None
    return shell, {"Content-Security-Policy": policy(shell)}


def policy(shell: bytes) -> str:
    """What a page may do: run its own scripts, by their hashes, and speak to its own server.

    Examples
    --------
    >>> policy(b"<script>go()</script>").split("; ")[1]
    "script-src 'sha256-5KYv+PUboo5h+0+YAtGRPbwv5d/QxzHslP4YGnUaxRw='"
    """
    hashes = [base64.b64encode(hashlib.sha256(found[1]).digest()).decode() for found in _SCRIPT.findall(shell)]
    scripts = " ".join(f"'sha256-{found}'" for found in hashes) or "'none'"
    return "; ".join(
        (
            "default-src 'none'",
            f"script-src {scripts}",
            "style-src 'unsafe-inline'",
            "img-src 'self' data: blob:",
            "media-src 'self' data: blob:",
            "font-src data:",
            "connect-src 'self' data: blob:",
            "worker-src blob:",
            "base-uri 'none'",
            "form-action 'self'",
            "frame-ancestors 'none'",
        )
    )
