"""Roles files: TOML in which a user says which joint, or which markers, play which role.

::

    [joints]                          # role = joint
    left_wrist = "Hand.L"
    [markers]                         # place on the body = label, or labels
    left_wrist = ["LWRA", "LWRB"]

``dance.roles.toml`` is for ``dance.bvh`` beside it, ``roles.toml`` for all files of its folder that have none of their
own. What a file does not say is found as without it.
"""

from __future__ import annotations

import difflib
import json
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, cast

from onbeat.errors import FormatError
from onbeat.motion.role_names import ROLES
from onbeat.motion.roles import role_report
from onbeat.motion.skeleton import Skeleton
from onbeat.motion.tree import Tree

FOLDER_FILE, SUFFIX = "roles.toml", ".roles.toml"
_LARGEST = 1 << 18  # bytes; a line for each of 3000 joints is a third of it


@dataclass(frozen=True)
class Roles:
    """What a roles file tells.

    Parameters
    ----------
    joints : role to joint name.
    markers : place on the body to marker labels.
    source : the file, for messages.
    """

    joints: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    markers: Mapping[str, tuple[str, ...]] = field(default_factory=lambda: MappingProxyType({}))
    source: str = ""

    def told(self, skeleton: Skeleton) -> Skeleton:
        """The skeleton with these roles; a ``FormatError`` names the file if a joint is not there."""
        try:
            return skeleton.with_roles(self.joints)
        except FormatError as error:
            raise FormatError(f"{self.source}: {error}" if self.source else str(error)) from None


def read_roles(path: str | Path) -> Roles:
    """Read a roles file.

    Raises
    ------
    FormatError
        If the file cannot be read, is no TOML, or has a table, a role or a value that is not expected; the message
        names the file and the key.
    """
    document = _document(Path(path))
    for table in document:
        if table not in ("joints", "markers"):
            raise FormatError(f"{path}: no table [{table[:60]}] is known{_near(table, ('joints', 'markers'))}")
    joints, markers = (_table(document, name, path) for name in ("joints", "markers"))
    for role, name in joints.items():
        if role not in ROLES:
            near = _near(role, ROLES) or f"; there are {', '.join(ROLES)}"
            raise FormatError(f"{path}: joints.{role[:60]}: no such role{near}")
        if not isinstance(name, str) or not name:
            raise FormatError(f"{path}: joints.{role}: the name of a joint in quotes is expected, {_shown(name)} found")
    labels = {site: _labels(value, f"{path}: markers.{site[:60]}") for site, value in markers.items()}
    return Roles(MappingProxyType(cast("dict[str, str]", joints)), MappingProxyType(labels), str(path))


def _document(path: Path) -> dict[str, Any]:
    try:
        if path.stat().st_size > _LARGEST:
            raise FormatError(f"{path}: {path.stat().st_size} bytes are too many for a roles file")
        return tomllib.loads(path.read_bytes().decode("utf-8-sig"))
    except OSError as error:
        raise FormatError(f"cannot read {path}: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise FormatError(f"{path} is not UTF-8 text; save it as such") from None
    except (ValueError, RecursionError) as error:
        raise FormatError(f"{path} is no TOML: {str(error)[:200]}; names with dots or spaces need quotes") from None


def _table(document: Mapping[str, Any], name: str, path: str | Path) -> dict[str, Any]:
    table = document.get(name, {})
    if not isinstance(table, dict):
        raise FormatError(f"{path}: {name}: a table [{name}] is expected, {_shown(table)} found")
    return cast("dict[str, Any]", table)


def _labels(value: object, where: str) -> tuple[str, ...]:
    values = cast("list[object]", value) if isinstance(value, list) else [value]
    if not values or not all(isinstance(label, str) and label for label in values):
        raise FormatError(f"{where}: a label or a list of labels in quotes is expected, {_shown(value)} found")
    return tuple(cast("list[str]", values))


def _shown(value: object) -> str:
    try:
        return repr(value)[:60]
    except (ValueError, RecursionError):  # an integer of thousands of digits, lists in lists
        return f"a {type(value).__name__}"


def _near(word: str, known: Iterable[str]) -> str:
    close = difflib.get_close_matches(word[:60], list(known), n=3)
    return f"; is {' or '.join(close)} meant?" if close else ""


def roles_beside(path: str | Path) -> Path | None:
    """The roles file for a motion file: ``STEM.roles.toml`` beside it, else ``roles.toml`` in its folder, else none."""
    path = Path(path)
    own, folders = path.with_name(path.stem + SUFFIX), path.with_name(FOLDER_FILE)
    return next((file for file in (own, folders) if file.is_file()), None)


def role_template(skeleton: Skeleton) -> str:
    r"""The text of a roles file for a skeleton, for a user to edit: roles as found, those missing as comments.

    Examples
    --------
    >>> arm = Skeleton(("UpperArm_L", "Ellbogen", "Hnd_L"), [-1, 0, 1], [[0, 0, 0], [0.3, 0, 0], [0.3, 0, 0]])
    >>> print("\n".join(line for line in role_template(arm).splitlines() if "left_wrist" in line))
    # left_wrist = ""  # needed; perhaps "Hnd_L"
    """
    lines = [
        "# Which joint plays which role. Change what is wrong, fill in what is missing; what is left out is searched.",
        f"# Save it beside DANCE.bvh as DANCE{SUFFIX}, or as {FOLDER_FILE} for all files of the folder.",
        "#",
        "# The joints, each below its parent:",
        *_outline(skeleton),
        "",
        "[joints]",
    ]
    for role, joint, how, needed, near in role_report(skeleton):
        if joint is not None:
            lines.append(f"{role} = {_quoted(joint)}" + ("  # a guess" if how == "guess" else ""))
        else:
            notes = [*(["needed"] if needed else []), *([f"perhaps {' or '.join(map(_quoted, near))}"] if near else [])]
            lines.append(f'# {role} = ""' + (f"  # {'; '.join(notes)}" if notes else ""))
    return "\n".join(lines) + "\n"


def _outline(skeleton: Skeleton) -> list[str]:
    """A comment line for each joint depth first, set in below its parent, at most 20 levels."""
    levels: list[int] = []
    for parent in skeleton.parents.tolist():
        levels.append(0 if parent < 0 else levels[parent] + 1)
    first = Tree.of(skeleton).first
    order = sorted(range(len(skeleton)), key=first.__getitem__)
    return [f"#   {'  ' * min(levels[joint], 20)}{_quoted(skeleton.names[joint])}" for joint in order]


def _quoted(name: str) -> str:
    """A TOML string; JSON's escapes are TOML's but for DEL."""
    name = name.encode("utf-8", "replace").decode()  # half of a pair of code units is no text
    return json.dumps(name, ensure_ascii=False).replace("\x7f", "\\u007f")
