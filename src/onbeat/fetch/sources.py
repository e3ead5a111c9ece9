"""What can be fetched: motion sets and songs, where their publishers keep them, and under which licence."""

from __future__ import annotations

import difflib
import tomllib
from functools import cache
from importlib.resources import files
from typing import Literal
from urllib.parse import quote, urljoin

import msgspec

from onbeat.errors import FetchError

Kind = Literal["moves", "songs"]
KINDS: tuple[Kind, ...] = ("moves", "songs")
COMMANDS: dict[Kind, str] = {"moves": "onbeat moves fetch", "songs": "onbeat songs fetch"}
"""Of each kind, the command that fetches."""


class RemoteFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A file of a source.

    Parameters
    ----------
    path : its name here, relative to the source's folder.
    url : where it is, absolute or from the source's ``base`` on; by default ``path``.
    also : other addresses of the very same file.
    size : bytes, where they are known.
    sha256 : checksum, where one is known.
    unpack : it is a zip, of which the files that fit ``keep`` are wanted.
    """

    path: str
    url: str = ""
    also: tuple[str, ...] = ()
    size: int | None = None
    sha256: str | None = None
    unpack: bool = False
    keep: tuple[str, ...] = ("*",)


class Source(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A motion set or a song that is known by name.

    Parameters
    ----------
    title, page : what it is, and the publisher's page about it.
    licence, licence_url : under which terms.
    credit : whom to name where something made of it is shown.
    genre, performers, body : what is danced, by whom (a pattern of file names each), on what body.
    fps : frames per second; ``fps_stored`` says whether its files tell so themselves.
    mind : what to know before using it.
    sure : whether the checksums are the publisher's, so that another file is refused.
    base, files : where it is.
    by_hand : how to get it where only a person may.
    kind, name : under which it is known.
    """

    title: str
    page: str
    licence: str
    credit: str
    licence_url: str = ""
    genre: str = ""
    performers: dict[str, str] = {}
    body: str = ""
    fps: float | None = None
    fps_stored: bool = True
    mind: tuple[str, ...] = ()
    sure: bool = False
    base: str = ""
    files: tuple[RemoteFile, ...] = ()
    by_hand: str = ""
    kind: Kind = "moves"
    name: str = ""

    @property
    def size(self) -> int | None:
        """Bytes of all files; None where the size of one is not known."""
        sizes = [file.size for file in self.files]
        return sum(size or 0 for size in sizes) if sizes and None not in sizes else None

    def addresses(self, file: RemoteFile, mirror: str = "") -> list[str]:
        """Where to try for a file, in this order: the mirror, the publisher's place, other places.

        A mirror holds ``KIND/NAME/PATH``, as the folder does that things are fetched into.
        """
        first = [f"{mirror.rstrip('/')}/{self.kind}/{self.name}/{quote(file.path)}"] if mirror else []
        return [*first, urljoin(self.base, file.url or quote(file.path)), *file.also]


class _Book(msgspec.Struct, forbid_unknown_fields=True):
    moves: dict[str, Source]
    songs: dict[str, Source]


def read_sources(text: str) -> dict[Kind, dict[str, Source]]:
    """Sources by kind and name, of a TOML text such as ``sources.toml``.

    Raises
    ------
    FetchError
        If it is no such text.
    """
    try:
        book = msgspec.convert(tomllib.loads(text), _Book)
    except (tomllib.TOMLDecodeError, msgspec.ValidationError) as error:
        raise FetchError(f"the list of sources cannot be read: {error}") from None
    named: dict[Kind, dict[str, Source]] = {"moves": book.moves, "songs": book.songs}
    return {
        kind: {name: msgspec.structs.replace(source, kind=kind, name=name) for name, source in known.items()}
        for kind, known in named.items()
    }


def _text() -> str:
    return files("onbeat.fetch").joinpath("sources.toml").read_text(encoding="utf-8")


@cache
def all_sources(kind: Kind) -> dict[str, Source]:
    """The sources of a kind, by name.

    >>> all_sources("moves")["cmu-dance"].fps
    120.0
    """
    return read_sources(_text())[kind]


def source_named(kind: Kind, name: str) -> Source:
    """The source of a name.

    Raises
    ------
    FetchError
        If there is none; the message has names that are alike, and all there are.
    """
    known = all_sources(kind)
    if name in known:
        return known[name]
    near = difflib.get_close_matches(name, known, 1)
    guess = f"did you mean {near[0]}? There are" if near else "there are"
    raise FetchError(f"no {kind} are known as {name!r}; {guess} {', '.join(known)}")
