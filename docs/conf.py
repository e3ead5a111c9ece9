"""How the site looks and how docstrings become pages; ``build_site.py`` lays the pages out and calls Sphinx."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import msgspec

import onbeat

project = "onbeat"
author = "The onbeat developers"
project_copyright = author
version = release = onbeat.__version__
root_doc = "index"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence", "deflist"]
suppress_warnings = ["misc.highlighting_failure"]
highlight_language = "text"
pygments_style, pygments_dark_style = "default", "github-dark"  # comments that can be read: 4.5 to 1 and more

html_theme = "furo"
html_title = "onbeat"
html_static_path = ["site"]
html_css_files = ["site.css"]
html_search_scorer = str(Path(__file__).parent / "site" / "search.js")
html_show_sphinx = False
html_copy_source = False
html_show_sourcelink = False
html_last_updated_fmt = None
html_use_index = False
html_domain_indices = False
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#b8391f", "color-brand-content": "#b8391f"},
    "dark_css_variables": {"color-brand-primary": "#ff8a6b", "color-brand-content": "#ff8a6b"},
}

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
python_maximum_signature_line_length = 96
add_module_names = False
_SHAPES = ("Array", "Float32", "Ints", "Bools", "Positions", "Rotations", "Times")
autodoc_type_aliases = {name: name for name in _SHAPES}
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_param = True
napoleon_use_ivar = True
napoleon_attr_annotations = False

_SECTION = re.compile(r"^(\s*)(Parameters|Returns|Yields|Attributes)$")
_ENTRY = re.compile(r"^(\s*)([\w*, …]+) : (.*)$")
_LITERAL = re.compile(r"(``.*?``)")


def as_numpy_has_it(lines: list[str]) -> list[str]:
    """What follows ``name :`` is a description in onbeat's docstrings, and its types are in the signature.

    In numpydoc's own style it would be the type; so it goes to a line of its own. ``Returns`` becomes a paragraph.
    A bar is a bar (norms, absolute values), not a substitution.
    """
    out: list[str] = []
    section = ""
    for number, line in enumerate(lines):
        following = lines[number + 1].strip() if number + 1 < len(lines) else ""
        if following and not following.strip("-") and line.strip():
            section = line.strip()
            if section in ("Returns", "Yields"):
                out += ["", f"**{section}**", ""]
                continue
        if section in ("Returns", "Yields") and line.strip() and not line.strip().strip("-"):
            continue
        entry = _ENTRY.match(line) if section in ("Parameters", "Attributes") else None
        out += [f"{entry[1]}{entry[2]}", f"{entry[1]}    {entry[3]}"] if entry else [line]
    return [_bars(line) for line in out]


def _bars(line: str) -> str:
    parts = _LITERAL.split(line)
    return "".join(part if part.startswith("``") else part.replace("|", r"\|") for part in parts)


_VALUES: dict[str, list[str]] = {}
_DOCUMENTS = Path(__file__).with_name("documents.md").read_text(encoding="utf-8")


def _before(_app: Any, what: str, name: str, thing: Any, _options: Any, lines: list[str]) -> None:
    lines[:] = as_numpy_has_it(lines)
    if _is_document(thing) and f'"title": "{thing.__name__}"' in _DOCUMENTS:
        lines += ["", "Its fields are in :doc:`../documents`."]
    if what in ("data", "attribute"):
        _VALUES[name] = list(lines)


_FORWARD = re.compile(r"TypeAliasForwardRef\('(\w+)'\)")


def _is_document(thing: Any) -> bool:
    return isinstance(thing, type) and issubclass(thing, msgspec.Struct)


def _signed(_app: Any, _what: str, _name: str, thing: Any, _options: Any, taken: str, given: str) -> Any:
    """A shape's name in a union is its name, not the class that Sphinx has for it; of documents none is shown.

    Their fields, each with its sentence, would be a paragraph of types; a table of them is on the page of documents.
    """
    if _is_document(thing):
        return "", ""
    return tuple(text and _FORWARD.sub(r"\1", text) for text in (taken, given))


def _after(_app: Any, _what: str, name: str, _object: Any, _options: Any, lines: list[str]) -> None:
    lines[:] = _VALUES.pop(name, lines)


def setup(app: Any) -> None:
    """Docstrings are turned before napoleon (priority 500) reads them; those of values are kept from it.

    It would take what such a docstring has before a colon for a type.
    """
    app.connect("autodoc-process-docstring", _before, priority=400)
    app.connect("autodoc-process-docstring", _after, priority=600)
    app.connect("autodoc-process-signature", _signed)
