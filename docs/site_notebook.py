"""Runs the code cells of the notebook from top to bottom in one namespace, as Jupyter would, and writes its page."""

from __future__ import annotations

import ast
import contextlib
import io
import json
import os
from pathlib import Path
from typing import Any

from site_gallery import packed
from site_pages import labels, places, turned


def cells(notebook: Path) -> list[tuple[str, str]]:
    """Kind (``markdown`` or ``code``) and text of each cell."""
    told = json.loads(notebook.read_text(encoding="utf-8"))
    return [(cell["cell_type"], "".join(cell["source"])) for cell in told["cells"]]


def execute(code: str, names: dict[str, Any]) -> str:
    """Run a cell in a namespace; what it printed, and the value of its last line unless it ends in a semicolon."""
    tree = ast.parse(code)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        exec(compile(tree, "<cell>", "exec"), names)
        value = eval(compile(ast.Expression(last.value), "<cell>", "eval"), names) if last else None
        if value is not None and not code.rstrip().endswith(";"):
            print(repr(value))
    return said.getvalue()


def figures(folder: Path, number: int) -> list[Path]:
    """The figures that a cell drew, as files; they are closed."""
    from matplotlib import pyplot as plt

    made: list[Path] = []
    for which in plt.get_fignums():
        made.append(folder / f"cell_{number}_{which}.png")
        plt.figure(which).savefig(made[-1], dpi=110, metadata={"Software": None})
    plt.close("all")
    return made


def write_notebook(notebook: Path, work: Path, pages: Path) -> None:
    """Run the notebook in ``work``, and write ``notebook.md`` with what its cells say and draw."""
    import matplotlib

    matplotlib.use("agg")
    work.mkdir(parents=True, exist_ok=True)
    names: dict[str, Any] = {"__name__": "__main__"}
    out: list[str] = []
    where, called = places(notebook.resolve().parents[1]), labels(notebook.with_name("index.md").read_text("utf-8"))
    before = Path.cwd()
    os.chdir(work)
    try:
        for number, (kind, text) in enumerate(cells(notebook)):
            if kind != "code":
                out.append(turned(text, Path("docs", notebook.name), "notebook.md", where, called))
                continue
            said = execute(text, names)
            out.append(f"```python\n{text}\n```")
            out += [f"```text\n{said}```"] if said else []
            for drawn in figures(work, number):
                (pages / f"notebook_{drawn.stem}.webp").write_bytes(packed(drawn))
                out.append(f"![what this cell draws](notebook_{drawn.stem}.webp)")
    finally:
        os.chdir(before)
    (pages / "notebook.md").write_text("\n\n".join(out) + "\n", encoding="utf-8")
