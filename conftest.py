"""For all tests and examples: what onbeat keeps between runs is kept apart from the user's own, and removed."""

import os
import shutil
import tempfile

import pytest

_MADE = pytest.StashKey[str]()


def pytest_configure(config: pytest.Config) -> None:
    """Set before workers are started, which inherit it."""
    if "PYTEST_XDIST_WORKER" not in os.environ:
        config.stash[_MADE] = os.environ["ONBEAT_CACHE"] = tempfile.mkdtemp(prefix="onbeat-tests-")


def pytest_unconfigure(config: pytest.Config) -> None:
    """Only who made the folder removes it."""
    if _MADE in config.stash:
        shutil.rmtree(config.stash[_MADE], ignore_errors=True)
