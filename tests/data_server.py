"""A server of data on this machine, as good and as bad as those of the world."""

from __future__ import annotations

import re
import threading
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

WALK, SPIN = b"walk " * 40_000, b"spin " * 1000
"""Files to serve."""


@dataclass
class DataServer:
    """What is served by path, what goes wrong, and what was asked for."""

    files: dict[str, bytes] = field(default_factory=dict)
    tags: dict[str, str] = field(default_factory=dict)
    breaks: dict[str, list[int]] = field(default_factory=dict)
    """After how many bytes the next answers to a path break off."""
    answers: dict[str, int] = field(default_factory=dict)
    """Paths that are answered by a status alone."""
    kinds: dict[str, str] = field(default_factory=dict)
    asked: list[tuple[str, str | None]] = field(default_factory=list)
    """Paths that were asked for, with the range."""
    url: str = ""


def handler(server: DataServer) -> type[BaseHTTPRequestHandler]:
    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            path, wanted = self.path.partition("?")[0], self.headers.get("Range")
            server.asked.append((path, wanted))
            if path in server.answers or path not in server.files:
                self.send_response(server.answers.get(path, 404))
                self.send_header("Content-Length", "0")
                self.end_headers()
                return
            data, tag = server.files[path], server.tags.get(path, '"1"')
            begin = 0
            if wanted and self.headers.get("If-Range") == tag:
                begin = int(re.match(r"bytes=(\d+)-", wanted)[1])
            if begin > 0 and begin >= len(data):
                self.send_response(416)
                self.send_header("Content-Range", f"bytes */{len(data)}")
                self.send_header("Content-Length", "0")
                self.end_headers()
                return
            self.send_response(206 if begin else 200)
            self.send_header("Content-Type", server.kinds.get(path, "application/octet-stream"))
            self.send_header("Content-Length", str(len(data) - begin))
            self.send_header("ETag", tag)
            if begin:
                self.send_header("Content-Range", f"bytes {begin}-{len(data) - 1}/{len(data)}")
            self.end_headers()
            stops = server.breaks.get(path)
            self.wfile.write(data[begin : begin + stops.pop(0)] if stops else data[begin:])
            self.close_connection = True

        def log_message(self, *words: object) -> None: ...

    return Handler


@contextmanager
def serving() -> Generator[DataServer]:
    """A server that runs for a while."""
    server = DataServer()
    with ThreadingHTTPServer(("127.0.0.1", 0), handler(server)) as running:
        server.url = f"http://127.0.0.1:{running.server_address[1]}"
        thread = threading.Thread(target=running.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        try:
            yield server
        finally:
            running.shutdown()
            thread.join()
