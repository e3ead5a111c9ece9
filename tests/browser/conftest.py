"""A headless chromium, and pages opened in it from files."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from browser.pictures import Pictures, own_fonts

FLAGS = (
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--autoplay-policy=no-user-gesture-required",
)


class OpenPage:
    """A page from a file, with all it complained about and asked for."""

    def __init__(self, page: Any, path: Path) -> None:
        self.page = page
        self.complaints: list[str] = []
        self.requests: list[str] = []
        page.set_default_timeout(120_000)
        page.on("console", lambda message: self.complaints.append(f"{message.type}: {message.text}"))
        page.on("pageerror", lambda error: self.complaints.append(f"exception: {error}"))
        page.on("request", lambda request: self.requests.append(request.url))
        page.goto(path.as_uri())

    def state(self) -> dict[str, Any]:
        """Time, joints and the rest, as the page has them."""
        return self.page.evaluate("window.onbeat.state()")

    def until(self, condition: str) -> None:
        """Wait until a JavaScript condition holds; the page forbids the strings of ``wait_for_function``."""
        look = f"const look = () => ({condition}) ? done() : requestAnimationFrame(look); look();"
        late = "setTimeout(() => fail(new Error('waited 120 s in vain')), 120000);"
        self.page.evaluate(f"new Promise((done, fail) => {{ {look} {late} }})")

    def posed(self, time: float) -> dict[str, Any]:
        """The state once the dancer stands as at ``time``."""
        self.page.evaluate(
            "time => { window.onbeat.seek(time); "
            "return new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))) }",
            time,
        )
        return self.state()


@pytest.fixture(scope="session")
def launch(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[[], Any]]:
    """Starts a chromium."""
    sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    path = os.environ.get("ONBEAT_CHROMIUM") or shutil.which("chromium") or shutil.which("google-chrome")
    if not path:
        pytest.skip("no chromium found: install it, or set ONBEAT_CHROMIUM to its path")
    with sync_api.sync_playwright() as playwright:
        fonts = own_fonts(tmp_path_factory.mktemp("fonts"))
        yield lambda: playwright.chromium.launch(executable_path=path, args=FLAGS, env=fonts)


@pytest.fixture(scope="module")
def chromium(launch: Callable[[], Any]) -> Iterator[Any]:
    """A browser for the tests of one file: no page stays open that would be drawn beside all other tests."""
    browser = launch()
    yield browser
    browser.close()


@pytest.fixture(scope="module")
def open_page(chromium: Any) -> Iterator[Any]:
    """Opens a file in a small window, without a network."""
    contexts: list[Any] = []

    def open_(path: Path) -> OpenPage:
        contexts.append(chromium.new_context(viewport={"width": 480, "height": 560}, offline=True))
        return OpenPage(contexts[-1].new_page(), path)

    yield open_
    for context in contexts:
        context.close()


@pytest.fixture
def pictures(tmp_path: Path) -> Iterator[Pictures]:
    """Holds pages against the pictures of them that are kept."""
    made = Pictures(tmp_path)
    yield made
    made.end()
