"""Descriptions of robots as TOML: those that are packaged, and those that people write."""

from __future__ import annotations

import tomllib
from functools import lru_cache
from importlib.resources import files
from pathlib import Path

import msgspec

from onbeat.errors import BodyError
from onbeat.limits.plain_xml import read_bounded
from onbeat.robots.description.description import VERSION, Description, Link
from onbeat.robots.description.sound import check_description

_FOLDER = files("onbeat.robots") / "descriptions"
_SUFFIX = ".toml"
_LARGEST = 4 << 20


@lru_cache(maxsize=1)
def described_robots() -> tuple[str, ...]:
    """The names of the robots of which all is known, in their alphabet's order.

    Examples
    --------
    >>> described_robots()
    ('g1', 'hrp4c', 'talos')
    """
    found = (entry.name for entry in _FOLDER.iterdir())
    return tuple(sorted(name.removesuffix(_SUFFIX) for name in found if name.endswith(_SUFFIX)))


@lru_cache(maxsize=8)
def described(name: str) -> Description:
    """The packaged description of a robot; ``name`` is one of :func:`described_robots`."""
    text = (_FOLDER / f"{name}{_SUFFIX}").read_text(encoding="utf-8")
    return description_of(text, f"onbeat's description {name}")


def read_description(path: Path) -> Description:
    """The description in a TOML file; errors as of :func:`description_of`, a ``LimitError`` where it cannot be read."""
    data = read_bounded(path, _LARGEST)
    return description_of(data.decode("utf-8", "replace"), str(path))


def description_of(text: str, label: str) -> Description:
    """The description that a TOML text holds.

    Parameters
    ----------
    text : the document (:mod:`onbeat.robots.description.description`).
    label : what messages call it.

    Raises
    ------
    BodyError
        If it is no TOML, a key is missing, not expected or of another kind, or the robot cannot be
        (:func:`onbeat.robots.description.sound.check_description`); the link or joint is named.
    """
    where = label
    try:
        document = tomllib.loads(text)
        links = document.get("links")
        for name, link in links.items() if isinstance(links, dict) else ():
            where = f"{label}: link {name!r}"  # which msgspec does not name
            msgspec.convert(link, Link)
        where = label
        description = msgspec.convert(document, Description)
    except (ValueError, RecursionError) as error:  # msgspec's errors are ValueErrors
        raise BodyError(f"{where} cannot be: {str(error)[:300]}") from None
    if description.version != VERSION:
        raise BodyError(f"{label} is of version {description.version}; this onbeat reads version {VERSION}")
    check_description(description, label)
    return description
