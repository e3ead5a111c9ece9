"""Lays the written pages out for the site: one folder, links turned, chapters taken from the lists of ``index.md``."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

ROOT_PAGES = ("ARCHITECTURE", "CONVENTIONS", "CONTRIBUTING", "CHANGELOG")
_LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)")
_FENCE = re.compile(r"(^```.*?^```$)", re.MULTILINE | re.DOTALL)
_ITEM = re.compile(r"^- \[([^\]]*)\]\(([^)\s#]+)\)", re.MULTILINE)


def places(root: Path) -> dict[Path, str]:
    """Where each written page of the repository is on the site, by its path from the root."""
    found = {Path(f"{name}.md"): f"{name.lower()}.md" for name in ROOT_PAGES}
    found |= {Path("docs", path.name): path.name for path in (root / "docs").glob("*.md")}
    found |= {Path("docs", "notebook.ipynb"): "notebook.md", Path("training", "README.md"): "training.md"}
    found |= {Path("docs", "gallery", "README.md"): "gallery/index.md"}
    programs = (root / "docs" / "gallery").glob("[0-9]*.py")
    found |= {Path("docs", "gallery", path.name): f"gallery/{path.stem}.md" for path in programs}
    return found | {Path("README.md"): "index.md"}


def labels(index: str) -> dict[Path, str]:
    """What ``docs/index.md`` calls each page, by its path from the root: short names, for the sidebar and for links."""
    return {Path(os.path.normpath(Path("docs", path))): name for name, path in _ITEM.findall(index)}


def turned(text: str, page: Path, place: str, where: dict[Path, str], called: dict[Path, str]) -> str:
    """A page's text with links that lead from its place on the site; what the site does not have is named only.

    A link that shows the name of a file shows what the page is ``called``: the site has no such files.
    """

    def link(match: re.Match[str]) -> str:
        mark, words, target = match.groups()
        path, _, anchor = target.partition("#")
        if "://" in target or not path:
            return match[0]
        meant = Path(os.path.normpath(page.parent / path))
        if meant in where:
            words = called.get(meant, words) if words.endswith(".md") else words
            to = os.path.relpath(where[meant], Path(place).parent)
            return f"[{words}]({to}{'#' * bool(anchor)}{anchor})"
        if mark:
            return f"![{words}]({os.path.relpath(Path(*meant.parts[1:]), Path(place).parent)})"
        return words

    parts = _FENCE.split(text)
    return "".join(part if part.startswith("```") else _LINK.sub(link, part) for part in parts)


def chapters(index: str) -> str:
    """``index.md`` with each section's list of pages told to Sphinx as a chapter, too."""
    head, *sections = re.split(r"^(?=## )", index, flags=re.MULTILINE)
    out = [head]
    for section in sections:
        title = section.split("\n", 1)[0].removeprefix("## ").strip()
        items = [(name, path) for name, path in _ITEM.findall(section) if path.endswith(".md")]
        pages = [f"{name} <{path.removesuffix('.md')}>" for name, path in items]
        if title == "Reference":
            section = (
                section.rstrip() + "\n- [Python names](api/index.rst): every room's modules, functions and values\n\n"
            )
            pages.append("Python names <api/index>")
        listed = "\n".join(pages)
        toctree = f"```{{toctree}}\n:hidden:\n:caption: {title}\n\n{listed}\n```\n\n" if pages else ""
        out.append(f"{section.rstrip()}\n\n{toctree}")
    return "".join(out)


def write_pages(root: Path, folder: Path) -> None:
    """Write all written pages of the repository into ``folder``, and the pictures they show."""
    shutil.rmtree(folder, ignore_errors=True)
    where, called = places(root), labels((root / "docs" / "index.md").read_text(encoding="utf-8"))
    for page, place in where.items():
        if page == Path("README.md") or page.suffix != ".md":
            continue
        text = turned((root / page).read_text(encoding="utf-8"), page, place, where, called)
        target = folder / place
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(chapters(text) if place == "index.md" else text, encoding="utf-8")
    shutil.copytree(root / "docs" / "pictures", folder / "pictures")
