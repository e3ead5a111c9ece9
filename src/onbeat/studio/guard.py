"""Who is let in: pages of this studio alone, and of those who come from other machines only who has the token.

Any page that a user has open can make the browser send requests here. So the name that was asked for has to be one of
ours (else another's name could be made to point here), a request that another page caused is refused, and whatever is
answered may not be framed, guessed at, or kept.
"""

from __future__ import annotations

import hmac
import html
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qs

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from onbeat.live.page.http import welcome
from onbeat.studio.answers import refusal

COOKIE = "onbeat_studio"
ALWAYS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Content-Security-Policy": "default-src 'none'; frame-ancestors 'none'; sandbox",
    "Cache-Control": "no-store",
}
"""Headers of every answer that does not say otherwise."""
SAFE = ("GET", "HEAD")


class Guard:
    """Stands before the app.

    Parameters
    ----------
    app : what is behind.
    host : what the server is bound to.
    token : what has to be shown; none where only this machine can reach the server.
    port : it is part of the cookie's name, for browsers keep the cookies of all ports together.
    """

    def __init__(self, app: ASGIApp, host: str, token: str | None = None, port: int = 0) -> None:
        self._app, self._host, self._token = app, host, token
        self._cookie = f"{COOKIE}_{port}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let in, or refuse."""
        if scope["type"] != "http":
            if scope["type"] == "lifespan":
                await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        shown = self._shown(scope, headers)
        refused = self._refused(scope, headers, shown)

        async def dressed(message: Message) -> None:
            if message["type"] == "http.response.start":
                own = MutableHeaders(scope=message)
                for name, value in ALWAYS.items():
                    own.setdefault(name, value)
                if shown == "asked" and refused is None:
                    own.append("Set-Cookie", self._set_cookie())
            await send(message)

        await (refused or self._app)(scope, receive, dressed)

    def _refused(self, scope: Scope, headers: Headers, shown: str | None) -> Response | None:
        """The refusal of a request, or none."""
        hosts, origins = headers.getlist("host"), headers.getlist("origin")
        if len(hosts) != 1 or len(origins) > 1 or not welcome(hosts[0], None, self._host):
            name = html.escape(", ".join(hosts)[:80], quote=False)
            return refusal(403, f"this studio is not called {name!r}; open it by the address that it printed")
        if origins and scope["method"] not in SAFE and not welcome(hosts[0], origins[0], self._host):
            return refusal(403, "a page of another address asked for this; only the studio's own page may")
        if not _own_page(scope, headers):
            return refusal(403, "a page of another site asked for this; only the studio's own page may")
        if shown is None:
            if scope["path"] == "/":
                return PlainTextResponse("Open the studio by the address that it printed, with its token.\n", 401)
            return refusal(401, "the token is missing; open the studio by the address that it printed")
        return None

    def _shown(self, scope: Scope, headers: Headers) -> str | None:
        """How the token was shown: by a cookie, a header, or the address that is asked for; none if it was not."""
        if self._token is None:
            return "needless"
        if self._is_token(_cookie(headers, self._cookie)):
            return "cookie"
        kind, _, bearer = headers.get("authorization", "").partition(" ")
        if kind.lower() == "bearer" and self._is_token(bearer.strip()):
            return "header"
        query = parse_qs(scope["query_string"].decode("latin-1"), max_num_fields=20) if scope["path"] == "/" else {}
        return "asked" if self._is_token(query.get("token", [""])[0]) else None

    def _is_token(self, told: str) -> bool:
        assert self._token is not None
        return hmac.compare_digest(told.encode(), self._token.encode())

    def _set_cookie(self) -> str:
        return f"{self._cookie}={self._token}; Path=/; HttpOnly; SameSite=Strict"


def _own_page(scope: Scope, headers: Headers) -> bool:
    """Whether no page of another site caused a request, as far as the browser tells; opening the page is free."""
    site = headers.get("sec-fetch-site", "none")
    if site in ("none", "same-origin"):
        return True
    opened = headers.get("sec-fetch-mode") == "navigate" and headers.get("sec-fetch-dest") == "document"
    return opened and scope["path"] == "/" and scope["method"] in SAFE


def _cookie(headers: Headers, name: str) -> str:
    try:
        found = SimpleCookie(headers.get("cookie", "")).get(name)
    except CookieError:
        return ""
    return found.value if found is not None else ""
