"""For all tests and examples: the same cases in every run, nothing kept in the user's own cache, long files first."""

import os
import shutil
import tempfile
from collections import Counter

import pytest
from hypothesis import settings

# Laws are tried on the same cases every time, and as long as it takes on a busy machine.
settings.register_profile("onbeat", deadline=None, derandomize=True)
settings.load_profile("onbeat")

# Files that take longer than their number of tests tells: how many tests of others they are worth at least. Browsers
# stay apart from each other, as two at once get in each other's way.
LONG = {"tests/test_docs.py": 1000, "tests/cli/test_dance.py": 40, "tests/reproduce/": 5, "tests/browser/": 5}

_MADE = pytest.StashKey[str]()


def pytest_configure(config: pytest.Config) -> None:
    """Set before workers are started, which inherit it."""
    if "PYTEST_XDIST_WORKER" not in os.environ:
        config.stash[_MADE] = os.environ["ONBEAT_CACHE"] = tempfile.mkdtemp(prefix="onbeat-tests-")


def pytest_unconfigure(config: pytest.Config) -> None:
    """Only who made the folder removes it."""
    if _MADE in config.stash:
        shutil.rmtree(config.stash[_MADE], ignore_errors=True)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Workers take the longest files first and examples of a line last, so that none waits long for another's end."""
    if "PYTEST_XDIST_WORKER" in os.environ:
        files = Counter(_file(item) for item in items)
        items.sort(key=lambda item: (-_length(_file(item), files), _file(item)))


def _file(item: pytest.Item) -> str:
    return item.nodeid.partition("::")[0]


def _length(file: str, tests: Counter[str]) -> int:
    return max(tests[file], *(worth for place, worth in LONG.items() if file.startswith(place)), 0)
