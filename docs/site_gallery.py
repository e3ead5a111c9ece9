"""Runs the programs of the gallery, and writes a page for each: its picture, its code, what it says."""

from __future__ import annotations

import ast
import contextlib
import hashlib
import io
import os
import runpy
import shutil
import sys
from pathlib import Path
from typing import NamedTuple

from PIL import Image

LARGEST = 60_000
"""Bytes of a picture on the site."""


class Shown(NamedTuple):
    """A program of the gallery: its title, its code, what it printed, and where its picture is."""

    name: str
    title: str
    code: str
    said: str
    picture: Path


def called(program: Path, folder: Path) -> str:
    """What a program prints when it is called in a folder with ``made``; in this process, as imports take long."""
    before, arguments, said = Path.cwd(), sys.argv, io.StringIO()
    os.chdir(folder)
    sys.argv = [str(program), "made"]
    try:
        with contextlib.redirect_stdout(said):
            runpy.run_path(str(program), run_name="__main__")
    finally:
        os.chdir(before)
        sys.argv = arguments
    return said.getvalue()


def run(program: Path, folder: Path) -> Shown:
    """Run a program in a folder of its own, unless its results are there already.

    Raises
    ------
    RuntimeError
        If it says nothing, or makes no ``made/picture.png``.
    """
    code = program.read_text(encoding="utf-8")
    mark, digest = folder / "done", hashlib.sha256(code.encode()).hexdigest()
    if not mark.exists() or mark.read_text() != digest:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        said = called(program.resolve(), folder)
        if not said.strip():
            raise RuntimeError(f"{program.name} says nothing")
        (folder / "said.txt").write_text(said, encoding="utf-8")
        mark.write_text(digest)
    picture = folder / "made" / "picture.png"
    if not picture.exists():
        raise RuntimeError(f"{program.name} makes no picture: made/picture.png is needed")
    title = (ast.get_docstring(ast.parse(code)) or program.stem).split("\n", 1)[0].rstrip(".")
    return Shown(program.stem, title, code, (folder / "said.txt").read_text(encoding="utf-8"), picture)


def packed(picture: Path) -> bytes:
    """A picture as WebP of at most ``LARGEST`` bytes."""
    for quality in (90, 75, 60):
        buffer = io.BytesIO()
        Image.open(picture).convert("RGB").save(buffer, "WEBP", quality=quality, method=4)
        if buffer.tell() <= LARGEST:
            return buffer.getvalue()
    raise RuntimeError(f"{picture} takes more than {LARGEST} bytes; draw it smaller")


def page(shown: Shown) -> str:
    """The page of a program."""
    return (
        f"# {shown.title}\n\n![what {shown.name}.py makes]({shown.name}.webp)\n\n"
        f"It says:\n\n```text\n{shown.said}```\n\n"
        f"`docs/gallery/{shown.name}.py`:\n\n```python\n{shown.code}```\n"
    )


def write_gallery(programs: Path, work: Path, pages: Path) -> None:
    """Run all programs, write their pages and pictures, and show them all on the gallery's own page."""
    shown = [run(program, work / program.stem) for program in sorted(programs.glob("[0-9]*.py"))]
    for one in shown:
        (pages / f"{one.name}.md").write_text(page(one), encoding="utf-8")
        (pages / f"{one.name}.webp").write_bytes(packed(one.picture))
    cards = "\n\n".join(f"[![{one.title}]({one.name}.webp) {one.title}]({one.name}.md)" for one in shown)
    names = "\n".join(one.name for one in shown)
    index = pages / "index.md"
    intro = index.read_text(encoding="utf-8").split("\n| program", 1)[0]
    index.write_text(
        f"{intro}\n:::{{container}} gallery\n{cards}\n:::\n\n```{{toctree}}\n:hidden:\n\n{names}\n```\n",
        encoding="utf-8",
    )
