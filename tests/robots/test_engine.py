"""MuJoCo comes with an extra."""

from __future__ import annotations

import builtins
import subprocess
import sys

import pytest

from onbeat.errors import MissingExtraError
from onbeat.robots.engine import engine


def test_without_the_extra_a_line_says_what_to_install(monkeypatch: pytest.MonkeyPatch):
    real = builtins.__import__

    def without(name: str, *args: object, **others: object) -> object:
        if name == "mujoco":
            raise ImportError(name)
        return real(name, *args, **others)

    monkeypatch.setattr(builtins, "__import__", without)
    engine.cache_clear()
    with pytest.raises(MissingExtraError, match=r'pip install "onbeat\[robots\]"'):
        engine()


def test_robots_are_described_without_it():
    code = "import onbeat, onbeat.robots.model as m, sys; m.robot_named('g1'); print('mujoco' in sys.modules)"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert told.strip() == "False"
