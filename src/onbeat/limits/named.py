"""The robots whose limits onbeat knows by name: facts read off their public descriptions, each with its source."""

from __future__ import annotations

from functools import lru_cache
from importlib.resources import files

from onbeat.errors import LimitError
from onbeat.limits.limits import Limits, near_names, shown
from onbeat.limits.toml_table import limits_from_toml

_TABLES = files("onbeat.limits") / "tables"
_SUFFIX = ".toml"


@lru_cache(maxsize=1)
def robot_names() -> tuple[str, ...]:
    """The names of the robots, in their alphabet's order.

    Examples
    --------
    >>> robot_names()
    ('g1', 'h1', 'hrp4c', 'nao', 'talos')
    """
    found = (entry.name for entry in _TABLES.iterdir())
    return tuple(sorted(name.removesuffix(_SUFFIX) for name in found if name.endswith(_SUFFIX)))


@lru_cache(maxsize=16)
def robot_limits(name: str) -> Limits:
    """What the joints of a robot can do, by its name.

    Raises
    ------
    LimitError
        If there is no such robot; those that there are, and the ways to tell others, are named.

    Examples
    --------
    >>> g1 = robot_limits("g1")
    >>> len(g1), g1.of(["left_knee_joint"]).speed.tolist()
    (29, [20.0])
    """
    plain = name.strip().lower().replace("-", "").replace("_", "")
    if plain not in robot_names():
        near = near_names(plain, robot_names())
        raise LimitError(
            f"no robot {shown(name)!r} is known {near}".rstrip()
            + f"; there are {', '.join(robot_names())}; of others give a file: URDF, MJCF or TOML"
        )
    text = (_TABLES / f"{plain}{_SUFFIX}").read_text(encoding="utf-8")
    return limits_from_toml(text, f"onbeat's table {plain}", plain)
