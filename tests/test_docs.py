"""What is written is true: commands, examples, tables, links, schemas."""

from __future__ import annotations

import importlib.util
import json
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import msgspec
import numpy as np
import pytest

from onbeat.cli.commands import COMMANDS, app
from onbeat.dance.document import DanceDocument
from onbeat.dance.report import _searched
from onbeat.dance.search import Found, Searched
from onbeat.examples.song import demo_song, true_song
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
    done = subprocess.run([sys.executable, *code], cwd=folder, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_example_of_the_readme_runs(tmp_path: Path):
    (example,) = (text for language, text in BLOCK.findall(README) if language == "python")
    assert len(example.strip().splitlines()) <= 11
    duration, f50 = (float(word) for word in run(["-c", example], tmp_path).split())
    assert duration == pytest.approx(10.0, abs=1 / 30)
    assert f50 > 0.5
    assert {"dance.bvh", "dance.glb"} <= {path.name for path in tmp_path.iterdir()}


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


def test_the_picture_of_the_readme_is_small_and_can_be_made_again():
    make = script("make_pictures")
    assert (make.FOLDER / "troupe.png").stat().st_size < 300_000
    assert "docs/pictures/troupe.png" in README
    joints, motion = [], make.perform(make.DANCERS[0], [make.FIGURES[0]], 1.0, 1, np.random.default_rng(0)).motion
    bodies = [make.dressed(motion, shirt) for shirt in make.SHIRTS[:2]]
    joints = [len(motion.skeleton)] * 2
    both = make.company(bodies, joints)
    assert both.joints.max() == joints[0] + bodies[0].joints.max()
    assert not both.adjacent[0, len(bodies[0].joints)]


def test_the_gallery_lists_its_programs():
    page = (ROOT / "docs" / "gallery" / "README.md").read_text(encoding="utf-8")
    assert re.findall(r"\]\((\d\d_\w+\.py)\)", page) == [path.name for path in GALLERY]


@pytest.mark.parametrize("program", GALLERY, ids=lambda path: path.stem)
def test_a_program_of_the_gallery_runs(program: Path, tmp_path: Path):
    assert run([str(program), "made"], tmp_path).strip()


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
