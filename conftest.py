"""For all tests and examples: the same cases in every run, and nothing kept in the user's own cache."""

import os
import shutil
import tempfile

import pytest
from hypothesis import settings

# Laws are tried on the same cases every time, and as long as it takes on a busy machine.
settings.register_profile("onbeat", deadline=None, derandomize=True)
settings.load_profile("onbeat")

_MADE = pytest.StashKey[str]()


def pytest_configure(config: pytest.Config) -> None:
    """Set before workers are started, which inherit it."""
    if "PYTEST_XDIST_WORKER" not in os.environ:
        config.stash[_MADE] = os.environ["ONBEAT_CACHE"] = tempfile.mkdtemp(prefix="onbeat-tests-")


def pytest_unconfigure(config: pytest.Config) -> None:
    """Only who made the folder removes it."""
    if _MADE in config.stash:
        shutil.rmtree(config.stash[_MADE], ignore_errors=True)
