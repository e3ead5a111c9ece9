"""MuJoCo, imported when it is first needed: the extra ``[robots]``."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from onbeat.errors import MissingExtraError


@lru_cache(maxsize=1)
def engine() -> Any:
    """The module ``mujoco``.

    Raises
    ------
    MissingExtraError
        If it is not installed; the message is the line that installs it.

    Examples
    --------
    >>> int(engine().MjModel.from_xml_string("<mujoco/>").nq)
    0
    """
    try:
        import mujoco
    except ImportError:
        raise MissingExtraError('robots need MuJoCo: pip install "onbeat[robots]"') from None
    return mujoco
