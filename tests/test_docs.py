"""What is written is true: commands, examples, tables, links, schemas."""

from __future__ import annotations

import html
import importlib.util
import json
import os
import re
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import msgspec
import numpy as np
import pytest
from PIL import Image

from onbeat.cli.commands import COMMANDS, app
from onbeat.dance.document import DanceDocument
from onbeat.dance.report import _searched
from onbeat.dance.search import Found, Searched
from onbeat.examples.song import demo_song, true_song
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import SongDocument

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
GALLERY = sorted((ROOT / "docs" / "gallery").glob("[0-9]*.py"))
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def script(name: str) -> ModuleType:
    """A script of ``docs/`` as a module."""
    spec = importlib.util.spec_from_file_location(name, ROOT / "docs" / f"{name}.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run(code: list[str], folder: Path) -> str:
    """Run Python with arguments in a folder; what it said."""
    done = subprocess.run([sys.executable, *code], cwd=folder, capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.usefixtures("troupe")
def test_the_example_of_the_readme_runs(tmp_path: Path):
    (example,) = (text for language, text in BLOCK.findall(README) if language == "python")
    assert len(example.strip().splitlines()) <= 11
    duration, f50 = (float(word) for word in run(["-c", example], tmp_path).split())
    assert duration == pytest.approx(10.0, abs=1 / 30)
    assert f50 > 0.5
    assert {"dance.bvh", "faster.glb"} <= {path.name for path in tmp_path.iterdir()}


def test_the_readme_lists_every_command():
    listed = re.findall(r"^\| `onbeat (\w+)` \| (.*) \|$", README, re.MULTILINE)
    assert listed == [(name, sentence) for name, (_, sentence, _) in COMMANDS.items()]


def test_commands_and_options_that_are_written_exist():
    known = {name: help_text(name) for name in COMMANDS}
    wrong = []
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        for name, rest in re.findall(r"onbeat ([a-z]+)\b((?: [^\n`|]*)?)", text):
            options = re.findall(r"(?<!\S)--[a-z-]+", rest)
            if name in known:
                wrong += [f"{page.name}: onbeat {name} {o}" for o in options if o not in known[name]]
            elif options:
                wrong.append(f"{page.name}: onbeat {name}")
    assert not wrong


def help_text(name: str) -> str:
    """All options of a command and its sub-commands."""
    names: list[str] = []
    stack = [app[name]]
    while stack:
        command = stack.pop()
        stack += [command[sub] for sub in command if not sub.startswith("-")]
        if command.default_command is not None:
            names += [n for argument in command.assemble_argument_collection() for n in argument.names]
    return " ".join([*names, "--help"])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_links_lead_somewhere(page: Path):
    text = page.read_text(encoding="utf-8")
    targets = [target.partition("#")[0] for target in re.findall(r"\]\(([^)\s]+)\)", text) if "://" not in target]
    assert not [target for target in targets if target and not (page.parent / target).exists()]


def test_files_that_are_written_of_exist():
    """Paths in code marks, as ``docs/extend.md`` has them."""
    kept = ("src/", "docs/", "benchmarks/", "viewer-js/", "scripts/", "dance/", "music/", "formats/", "motion/", "cli/")
    wrong = []
    for page in PAGES:
        for path in re.findall(r"`((?:[\w.-]+/)+[\w.-]*)`", page.read_text(encoding="utf-8")):
            made = path == "dance/" or path.startswith("dance/dance.")
            if path.startswith(kept) and not made:
                places = (ROOT / path, ROOT / "src" / "onbeat" / path)
                wrong += [] if any(place.exists() for place in places) else [f"{page.name}: {path}"]
    assert not wrong


def test_the_table_of_modules_is_current():
    page = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    assert page == script("make_architecture").renewed(page), "run: python docs/make_architecture.py"


def test_the_page_of_documents_is_current():
    page = (ROOT / "docs" / "documents.md").read_text(encoding="utf-8")
    assert page == script("make_documents").page(), "run: python docs/make_documents.py"


def test_the_page_of_documents_names_the_scores_of_a_search():
    page = (ROOT / "docs" / "documents.md").read_text(encoding="utf-8")
    part = Searched(range(300), 100.0, 2.0)  # type: ignore
    scores = _searched(Found(None, 1.0, 1.0, 0.0, part))  # type: ignore
    assert {"library_s", "gap_at_most"} < set(scores)
    assert [name for name in scores if f"`{name}`" not in page] == []


def test_documents_keep_to_their_schema():
    song = true_song(demo_song(5.0)).document()
    dance = DanceDocument(1, 60.0, 4.0, 0, "optimal", [0.5], [0.5], [], {})
    for document, type_ in ((song, SongDocument), (dance, DanceDocument)):
        written = json.loads(msgspec.json.encode(document))
        schema = msgspec.json.schema(type_)["$defs"][type_.__name__]
        assert set(schema["required"]) <= set(written) <= set(schema["properties"])


def test_the_moving_picture_of_the_readme_is_small_and_can_be_made_again():
    make = script("moving_picture")
    path = ROOT / "docs" / "pictures" / "dance.webp"
    assert path.stat().st_size <= make.LARGEST
    assert "docs/pictures/dance.webp" in README
    with Image.open(path) as moving:
        assert (moving.size, moving.n_frames > 60) == ((make.SIZE[0], make.SIZE[1] + make.FOOT), True)
    places, figure = make.troupe_at(np.array([-0.5, make.END]))
    assert np.abs(places[0] - places[1]).max() < 1e-9, "the last picture goes over into the first"
    assert figure.joints.max() == places.shape[1] - 1
    assert not figure.adjacent[0, -1]


def test_the_picture_of_the_studio_is_small_and_shown():
    make = script("studio_picture")
    assert make.PICTURE.stat().st_size <= make.LARGEST
    with Image.open(make.PICTURE) as picture:
        assert picture.size == make.SIZE
    assert "docs/pictures/studio.webp" in README
    assert "pictures/studio.webp" in (ROOT / "docs" / "index.md").read_text(encoding="utf-8")


def test_the_gallery_lists_its_programs():
    page = (ROOT / "docs" / "gallery" / "README.md").read_text(encoding="utf-8")
    assert re.findall(r"\]\((\d\d_\w+\.py)\)", page) == [path.name for path in GALLERY]


class Site(NamedTuple):
    """The site as it was built, and what was made on the way."""

    pages: Path
    work: Path


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, troupe: MoveLibrary) -> Site:
    """Built once: it runs the gallery and the notebook, and any warning is an error."""
    del troupe  # kept in this session's cache, where its programs find it
    folder = tmp_path_factory.mktemp("docs")
    built = Site(folder / "site", folder / "work")
    run([str(ROOT / "docs" / "build_site.py"), "-o", str(built.pages), "--work", str(built.work)], folder)
    return built


def text_of(page: Path) -> str:
    """What a reader sees of a page."""
    return html.unescape(re.sub(r"<[^>]+>", "", page.read_text(encoding="utf-8")))


@pytest.mark.parametrize("program", GALLERY, ids=lambda path: path.stem)
def test_a_program_of_the_gallery_runs_and_its_page_shows_what_it_makes(program: Path, site: Site):
    said = (site.work / "gallery" / program.stem / "said.txt").read_text(encoding="utf-8")
    assert said.strip()
    assert said.strip() in text_of(site.pages / "gallery" / f"{program.stem}.html")
    (picture,) = (site.pages / "_images").glob(f"{program.stem}*.webp")
    assert 2_000 < picture.stat().st_size <= 60_000


def test_every_page_is_on_the_site(site: Site):
    written = {path.stem for path in (ROOT / "docs").glob("*.md")} | {"architecture", "conventions", "training"}
    assert written <= {path.stem for path in site.pages.glob("*.html")}
    front = (site.pages / "index.html").read_text(encoding="utf-8")
    assert all(f'href="{name}.html"' in front for name in written - {"index"})
    assert "make_dance(" in text_of(site.pages / "api" / "dance.html")


def test_links_of_the_site_lead_to_pages_and_places_on_them(site: Site):
    pages = {page.resolve(): page.read_text(encoding="utf-8") for page in site.pages.rglob("*.html")}
    places = {page: set(re.findall(r'\bid="([^"]+)"', text)) for page, text in pages.items()}
    wrong, tried = [], 0
    for page, text in pages.items():
        for link in set(re.findall(r'<a\b[^>]*href="([^"]+)"', text)):
            path, _, place = html.unescape(link).partition("#")
            if "://" in link or not (path or place):
                continue
            tried += 1
            meant = (page.parent / path).resolve() if path else page
            there = meant.exists() and (not place or meant not in places or place in places[meant])
            wrong += [] if there else [f"{page.name}: {link}"]
    assert tried > 1000
    assert not wrong


def test_the_site_calls_pages_by_their_short_names_and_shows_no_names_of_files(site: Site):
    front = text_of(site.pages / "index.html")
    beside = text_of(site.pages / "robot.html").split("How it works", 1)[0]
    assert "Fetching data" in front
    assert "Fetching data" in beside, "the sidebar has the short name, not the page's title"
    shown = re.compile(r"<a\b[^>]*>(?:<[^>]*>)*[a-z_]+\.md<")
    assert not [page.name for page in site.pages.glob("*.html") if shown.search(page.read_text(encoding="utf-8"))]


def test_a_search_of_the_site_finds_guides_before_lists_of_names(site: Site):
    kept = (ROOT / "docs" / "site" / "search.js").read_text(encoding="utf-8")
    assert kept.strip() in (site.pages / "_static" / "language_data.js").read_text(encoding="utf-8")
    (names,) = re.findall(r"/\^\((.*?)\)/\.test", kept)
    later = {page for page in site.pages.rglob("*.html") if re.match(names, page.relative_to(site.pages).as_posix())}
    assert {site.pages / "architecture.html", site.pages / "api" / "music.html"} <= later
    assert not later & {site.pages / f"{name}.html" for name in ("robot", "live", "files", "keyposes", "retime")}


def test_signatures_of_the_site_show_no_workings(site: Site):
    texts = {page.name: text_of(page) for page in (site.pages / "api").glob("*.html")}
    assert not [name for name, text in texts.items() if "ForwardRef" in text or "msgspec.Meta" in text]
    assert "Its fields are in Documents" in texts["music.html"]


def test_the_site_asks_nothing_of_a_network(site: Site):
    asking = re.compile(r"<(?:script|link|img|iframe)\b[^>]*(?:src|href)=[\"'](?:https?:)?//")
    assert not [page.name for page in site.pages.rglob("*.html") if asking.search(page.read_text(encoding="utf-8"))]


def test_the_notebook_runs_from_top_to_bottom_and_is_kept_without_outputs(site: Site):
    notebook = json.loads((ROOT / "docs" / "notebook.ipynb").read_text(encoding="utf-8"))
    assert notebook["nbformat"] == 4
    assert not [cell["id"] for cell in notebook["cells"] if cell.get("outputs") or cell.get("execution_count")]
    assert {"song.wav", "dance.bvh", "dance.glb", "dance.html", "faster.bvh"} <= set(os.listdir(site.work / "notebook"))
    assert "channels over their limits: 0" in text_of(site.pages / "notebook.html")


@pytest.mark.parametrize(("page", "names"), [("extend.md", "{}"), ("metrics.md", "{}"), ("python.md", "names")])
@pytest.mark.usefixtures("troupe")
def test_examples_print_what_is_written_below_them(page: str, names: str, tmp_path: Path):
    if page == "python.md":
        pytest.importorskip("mujoco")
        pytest.importorskip("av")
    blocks = BLOCK.findall((ROOT / "docs" / page).read_text(encoding="utf-8"))
    tried = [(code, said) for (a, code), (b, said) in pairwise(blocks) if (a, b) == ("python", "text")]
    assert tried
    # All in one process, so that onbeat is imported once; each in its own names, or in those of the one before.
    program = f"import sys\nnames = {{}}\nfor code in sys.argv[1:]:\n    exec(code, {names})"
    assert run(["-c", program, *(code for code, _ in tried)], tmp_path) == "".join(said for _, said in tried)


def test_every_name_of_the_package_is_there_documented_and_shown():
    import onbeat

    page = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    rooms = {path.name for path in (ROOT / "src" / "onbeat").iterdir() if path.is_dir()}
    wrong: list[str] = []
    for name in set(onbeat.__all__) - {"__version__"}:
        value = getattr(onbeat, name)
        wrong += [f"{name}: no docstring"] if not (value.__doc__ or "").strip() else []
        wrong += [f"{name}: nothing in docs/python.md"] if f"onbeat.{name}" not in page else []
        wrong += [f"{name}: hides the room of that name"] if name in rooms else []
    assert sorted(wrong) == []
    assert set(re.findall(r"onbeat\.(\w+)\(", page)) <= set(onbeat.__all__)


def test_the_citation_names_this_version():
    import onbeat

    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    assert f"\nversion: {onbeat.__version__}\n" in citation
    assert f'\nversion = "{onbeat.__version__}"\n' in project
    assert "cff-version: 1.2.0" in citation


def test_continuous_integration_runs_what_the_readme_says():
    assert "\nbash scripts/check\n" in README
    assert (ROOT / ".ci" / "run").read_text(encoding="utf-8").rstrip().endswith("bash scripts/check")
