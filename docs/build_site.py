"""Builds the site of the documentation: ``python docs/build_site.py -o site``.

The programs of the gallery and the notebook are run, each with its output and a picture; the pages of ``docs/`` and of
the repository's root are laid out beside what was made, and Sphinx builds the site. Any warning is an error. Nothing is
asked of a network.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from site_api import write_api
from site_gallery import write_gallery
from site_notebook import write_notebook
from site_pages import write_pages

DOCS = Path(__file__).resolve().parent


def build(output: Path, work: Path) -> int:
    """Build the site into ``output``, by way of ``work``; 0 when all is well.

    A program of the gallery whose results are in ``work`` already is not run again unless it changed.
    """
    pages = work / "pages"
    write_pages(DOCS.parent, pages)
    write_gallery(DOCS / "gallery", work / "gallery", pages / "gallery")
    write_notebook(DOCS / "notebook.ipynb", work / "notebook", pages)
    write_api(pages / "api")
    from sphinx.cmd.build import build_main

    return build_main(
        ["-q", "-W", "--keep-going", "-E", "-c", str(DOCS), "-d", str(work / "trees"), str(pages), str(output)]
    )


def main() -> int:
    """What the command line asks for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("-o", "--output", type=Path, default=Path("site"), help="folder of the site")
    parser.add_argument(
        "--work", type=Path, help="folder for what is made on the way, kept; without it a temporary one"
    )
    given = parser.parse_args()
    if given.work:
        return build(given.output, given.work.resolve())
    with tempfile.TemporaryDirectory() as work:
        return build(given.output, Path(work))


if __name__ == "__main__":
    sys.exit(main())
