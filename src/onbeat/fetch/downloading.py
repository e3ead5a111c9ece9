"""One download: it goes on where an earlier one stopped, and takes data only, no pages that say why there is none."""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Callable, Generator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from onbeat.errors import FetchError

if TYPE_CHECKING:
    import requests

BLOCK = 1 << 14  # of a block that is not whole when a connection breaks, nothing is kept
ATTEMPTS = 5  # in a row, each from where the one before broke off
CONNECT, SILENCE = 10.0, 20.0  # s; until a connection stands, and between two blocks
LARGEST = 20_000_000_000  # bytes of a file whose size is not known
PAGE = re.compile(rb"\A(?:\xef\xbb\xbf)?\s*<(?:!doctype html|html|head)\b", re.IGNORECASE)
POINTER = b"version https://git-lfs"
AGENT = {"User-Agent": "onbeat", "Accept-Encoding": "identity"}

Told = Callable[[int, int | None], None]
"""Called with the bytes that are here and the bytes of the whole, where they are known."""


class BrokenError(Exception):
    """A connection ended before the file did; it may go on."""


class SilentError(BrokenError):
    """Nothing came for long."""


@dataclass
class ResumingDownloader:
    """A downloader for pooch, which has none that goes on.

    What comes is written to ``part``; beside it is kept of which version of the file it is (its ETag or date), so that
    the rest is asked for only of the same version. What is whole is moved to where pooch wants it.

    Parameters
    ----------
    part : the file that grows.
    size : bytes that are expected, None if that is not known.
    told : is told of the progress.
    resumed : whether a part of an earlier download was used.
    """

    part: Path
    size: int | None
    told: Told
    resumed: bool = field(default=False, init=False)

    def __call__(self, url: str, output_file: str, pooch: object, check_only: bool = False) -> None:
        """Download ``url`` to ``output_file``; a ``FetchError`` says why that cannot be."""
        if urlsplit(url).scheme not in ("http", "https"):
            raise FetchError(f"{url} is no address of the web; give one that begins with https:// or http://")
        self.part.parent.mkdir(parents=True, exist_ok=True)
        for attempt in range(1, ATTEMPTS + 1):
            before = _length(self.part)
            try:
                self._get(url)
                break
            except BrokenError as error:
                in_vain = isinstance(error, SilentError) and _length(self.part) <= before
                if attempt == ATTEMPTS or in_vain:
                    here = f"{_length(self.part):,} bytes"
                    raise FetchError(f"{_host(url)}: {error} after {here} of {url}; run it again: it goes on") from None
        os.replace(self.part, output_file)
        self._tag.unlink(missing_ok=True)

    @property
    def _tag(self) -> Path:
        return self.part.with_name(self.part.name + ".of")

    def _get(self, url: str) -> None:
        import requests

        have, tag = _length(self.part), self._version_here(url)
        have = have if tag else 0
        headers = {**AGENT, **({"Range": f"bytes={have}-", "If-Range": tag} if have else {})}
        with (
            _network_errors(url),
            requests.get(url, headers=headers, stream=True, timeout=(CONNECT, SILENCE)) as answer,
        ):
            if answer.status_code == 416 and answer.headers.get("Content-Range", "") == f"bytes */{have}":
                self.resumed = True
                return  # all of it is here
            begin = _begin(answer, have, url)
            if begin is None:
                self.part.unlink()
                self._get(url)  # what is here is of no use: from the beginning
                return
            self.resumed = self.resumed or begin > 0
            self._refuse_early(answer, url, begin)
            if not begin:
                self.part.write_bytes(b"")  # before its version is noted: the part of an older one must not get that
            self._note_version(answer, url)
            self._write(answer, url, begin)

    def _version_here(self, url: str) -> str:
        """The version of what is here already, if it came from this address."""
        try:
            where, _, tag = self._tag.read_text(encoding="utf-8").partition("\n")
        except (OSError, UnicodeDecodeError):
            return ""
        return tag if where == url else ""

    def _note_version(self, answer: requests.Response, url: str) -> None:
        tag = answer.headers.get("ETag", "")
        tag = answer.headers.get("Last-Modified", "") if not tag or tag.startswith("W/") else tag
        self._tag.write_text(f"{url}\n{tag}", encoding="utf-8")

    def _refuse_early(self, answer: requests.Response, url: str, begin: int) -> None:
        kind = answer.headers.get("Content-Type", "").partition(";")[0].strip().lower()
        if kind in ("text/html", "application/xhtml+xml"):
            raise FetchError(_no_data(url))
        whole = _whole(answer, begin)
        if whole is not None and whole > (self.size or LARGEST) * 1.5 + BLOCK:
            raise FetchError(
                f"{url} is {whole:,} bytes long, expected were {self.size or LARGEST:,}; it is another file"
            )

    def _write(self, answer: requests.Response, url: str, begin: int) -> None:
        whole, here = _whole(answer, begin), begin
        most = (self.size or LARGEST) * 1.5 + BLOCK
        with self.part.open("r+b" if begin else "wb") as file:
            file.seek(begin)
            file.truncate()
            for block in answer.iter_content(BLOCK):
                _check_first(block, url) if here == 0 else None
                here += len(block)
                if here > most:
                    raise FetchError(f"{url} does not end after {here:,} bytes; it is another file")
                file.write(block)
                self.told(here, whole or self.size)
        if whole is not None and here < whole:
            raise BrokenError("the connection broke")


def _length(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return 0


def _host(url: str) -> str:
    return urlsplit(url).netloc or url


def _begin(answer: requests.Response, have: int, url: str) -> int | None:
    """Where the answer begins in the file; None if the part here is not of it."""
    if answer.status_code == 200:
        return 0
    if answer.status_code == 206 and have:
        given = re.match(r"bytes (\d+)-", answer.headers.get("Content-Range", ""))
        return have if given and int(given[1]) == have else None
    if answer.status_code == 416 and have:
        return None
    raise FetchError(_refusal(answer.status_code, url))


def _refusal(status: int, url: str) -> str:
    if status in (404, 410):
        return f"{url} is not there (answer {status}); it may have moved: look at the publisher's page"
    if status in (401, 403, 451):
        return f"{_host(url)} does not give {url} (answer {status}); look at the publisher's page"
    if status == 407:
        return f"the proxy before {_host(url)} wants a name and password: set HTTPS_PROXY=http://name:password@proxy"
    if status == 429 or status >= 500:
        return f"{_host(url)} is busy or out of order (answer {status}) at {url}; try again later"
    return f"{_host(url)} answers {status} to {url}, not with the file; look at the publisher's page"


def _whole(answer: requests.Response, begin: int) -> int | None:
    """Bytes of the whole file; None if the server does not say, or sends it packed."""
    length = answer.headers.get("Content-Length", "")
    packed = answer.headers.get("Content-Encoding", "identity") != "identity"
    return begin + int(length) if length.isdigit() and not packed else None


def _check_first(block: bytes, url: str) -> None:
    if PAGE.match(block[:512]):
        raise FetchError(_no_data(url))
    if block.startswith(POINTER):
        raise FetchError(f"{url} gave a pointer of Git LFS instead of the file; look at the publisher's page")


def _no_data(url: str) -> str:
    return (
        f"{url} gave a web page instead of data: a proxy, a login or a notice is between; "
        "open the address in a browser to see which"
    )


@contextlib.contextmanager
def _network_errors(url: str) -> Generator[None]:
    """What goes wrong on the way, in a sentence; what may go on is a ``BrokenError``."""
    import requests

    try:
        yield
    except requests.exceptions.SSLError:
        raise FetchError(
            f"{_host(url)} does not prove who it is (TLS): is the clock right, is a proxy between?"
        ) from None
    except (requests.exceptions.ConnectTimeout, requests.exceptions.ProxyError) as error:
        proxied = isinstance(error, requests.exceptions.ProxyError)
        what = "the proxy cannot be reached" if proxied else "no answer"
        raise FetchError(f"{_host(url)}: {what}; is there a network, is HTTPS_PROXY right?") from None
    except requests.exceptions.ReadTimeout:
        raise SilentError(f"nothing came for {SILENCE:.0f} s") from None
    except requests.exceptions.ChunkedEncodingError:
        raise BrokenError("the connection broke") from None
    except requests.exceptions.ConnectionError as error:
        if "Read timed out" in str(error):
            raise SilentError(f"nothing came for {SILENCE:.0f} s") from None
        if "IncompleteRead" in str(error) or "Connection aborted" in str(error):
            raise BrokenError("the connection broke") from None
        raise FetchError(
            f"cannot reach {_host(url)} for {url}; is there a network, or is HTTPS_PROXY needed?"
        ) from None
    except requests.exceptions.RequestException as error:
        raise FetchError(f"{url} cannot be fetched: {type(error).__name__}; is the address right?") from None
