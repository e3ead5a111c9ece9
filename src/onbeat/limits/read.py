"""Limits from files: TOML that people write, and robots' descriptions as they are, URDF and MJCF."""

from __future__ import annotations

import warnings
from pathlib import Path

from onbeat.errors import LimitError
from onbeat.limits.joint_limit import Model, limits_of, without_speed
from onbeat.limits.limits import Limits, listed
from onbeat.limits.mjcf import mjcf_model
from onbeat.limits.plain_xml import read_bounded, read_xml
from onbeat.limits.toml_table import limits_from_toml
from onbeat.limits.urdf import urdf_model

_LARGEST_TOML = 1 << 20
"""Bytes; a line for each of 10,000 joints is less."""
_KINDS = "a URDF (<robot>) or an MJCF (<mujoco>)"


class LimitWarning(UserWarning):
    """Something that limits were asked of is not told by its file."""


def read_limits(path: str | Path, soft: bool = False) -> Limits:
    """The limits of a body's joints: of a ``.toml`` in onbeat's format, a URDF or an MJCF.

    Of a URDF or MJCF that does not tell how fast its joints are, the speed is infinite, with a :class:`LimitWarning`.

    Parameters
    ----------
    path : the file; what is in it decides what it is, but for ``.toml``.
    soft : take the soft limits of a URDF's safety controllers.

    Raises
    ------
    LimitError
        If it is no such file, or holds what cannot be a limit; file and joint are named.
    """
    path = Path(path)
    if path.suffix.lower() == ".toml":
        return _toml(path, soft)
    model = _model(path, soft)
    if not model.joints:
        raise LimitError(f"{path}: no joint that turns or slides found{'; ' * bool(model.left_out)}{model.left_out}")
    silent = without_speed(model.joints)
    if silent:
        warnings.warn(_speechless(path, silent), LimitWarning, stacklevel=2)
    source = path.name + (f", {model.left_out}" if model.left_out else "")
    try:
        return limits_of(model.name or path.stem, model.joints, source)
    except LimitError as error:
        raise LimitError(f"{path}: {error}") from None


def _toml(path: Path, soft: bool) -> Limits:
    data = read_bounded(path, _LARGEST_TOML)
    try:
        text = data.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError:
        raise LimitError(f"{path} is not UTF-8 text; save it as such") from None
    return limits_from_toml(text, str(path), path.stem, lambda name, told: _model(path.parent / name, told or soft))


def _model(path: Path, soft: bool) -> Model:
    root = read_xml(path, _KINDS)
    if root.tag == "robot":
        return urdf_model(root, str(path), soft)
    if root.tag in ("mujoco", "mujocoinclude"):
        return mjcf_model(root, str(path), lambda file: read_xml(path.parent / file, "a part of an MJCF"))
    raise LimitError(f"{path}: <{root.tag[:40]}> found; {_KINDS} is expected")


def _speechless(path: Path, silent: tuple[str, ...]) -> str:
    return (
        f"{path} does not tell how fast {listed(silent, 3)} may be, so their speed has no limit; tell it in a "
        f'.toml beside with the lines: model = "{path.name}", [default], speed = 5.0 (rad/s)'
    )
