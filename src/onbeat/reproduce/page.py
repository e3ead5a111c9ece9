"""A paper's results as one HTML page that needs nothing else: every table and figure of the paper's beside ours."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterable, Sequence
from html import escape

from onbeat.reproduce.result import Claim, FigureResult, PaperResult, Part, TableResult, counts, worded
from onbeat.reproduce.style import CSS

_VERDICTS = {True: ("yes", "holds here"), False: ("no", "does not hold"), None: ("open", "cannot be told")}


def paper_page(result: PaperResult, keys: Sequence[str] = ()) -> bytes:
    """The page of one paper; ``keys`` are the papers whose pages lie beside it."""
    body = [
        _links(keys, result.key),
        f"<h1><b>{escape(result.key)}</b>{escape(result.title)}</h1>",
        f'<p class="soft">{escape(result.citation)}</p>',
        _verdicts(result.claims),
        _contents(result),
        _data(result),
        _claims(result.claims),
        *(_part(part) for part in result.parts),
        _files(result),
    ]
    return _html(f"{result.key}: {result.title}", "en", body)


def index_page(results: Sequence[PaperResult]) -> bytes:
    """The page that leads to those of the papers, with what holds of each."""
    body = [
        "<h1>The papers, done again</h1>",
        "<p>Every table and figure of the papers that onbeat grew from, beside what comes out here. What of the "
        "data, the bodies and the methods is not the papers' stands at the top of each page.</p>",
    ]
    for result in results:
        body += [
            f'<h2><b>{escape(result.key)}</b><a href="{page_name(result.key)}">{escape(result.title)}</a></h2>',
            f'<p class="soft">{escape(result.citation)}</p>',
            _verdicts(result.claims),
            _claims(result.claims, page_name(result.key)),
            _contents(result, page_name(result.key)),
        ]
    body.append('<p class="soft">All numbers, for programs: <a href="results.json">results.json</a>.</p>')
    return _html("The papers, done again", "en", body)


def page_name(key: str) -> str:
    """The file of a paper's page.

    >>> page_name("P1")
    'p1.html'
    """
    return f"{key.lower()}.html"


def anchor(number: str) -> str:
    """By which a table or figure is led to on its page.

    >>> anchor("Fig. 5")
    'fig-5'
    """
    return re.sub(r"[^a-z0-9]+", "-", number.lower()).strip("-")


def _html(title: str, language: str, body: Iterable[str]) -> bytes:
    return (
        f'<!doctype html>\n<html lang="{language}">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(title)}</title>\n<style>{CSS}</style>\n</head>\n<body>\n<main>\n"
        + "\n".join(part for part in body if part)
        + "\n</main>\n</body>\n</html>\n"
    ).encode()


def _links(keys: Sequence[str], own: str) -> str:
    others = "".join(
        f'<a href="{page_name(key)}">{escape(key)}</a>' if key != own else f'<a aria-current="page">{escape(key)}</a>'
        for key in keys
    )
    return f'<nav aria-label="Papers"><a href="index.html">All papers</a>{others}</nav>' if keys else ""


def _verdicts(claims: Sequence[Claim]) -> str:
    """How many claims hold, how many do not, and how many cannot be told, in one look."""
    if not claims:
        return ""
    said = "".join(
        f'<li class="{_VERDICTS[holds][0]}"><b>{count}</b> {worded(holds, count)}</li>'
        for holds, count in counts(claims).items()
    )
    every = "1 claim:" if len(claims) == 1 else f"{len(claims)} claims:"
    return f'<ul class="tally" aria-label="What the paper claims"><li class="all">{every}</li>{said}</ul>'


def _contents(result: PaperResult, page: str = "") -> str:
    """Links to every table and figure, on the page itself or from another."""
    claims = f'<a href="{page}#claims">Claims</a>' if result.claims else ""
    parts = "".join(f'<a href="{page}#{anchor(part.number)}">{escape(part.number)}</a>' for part in result.parts)
    return f'<nav class="parts" aria-label="Tables and figures of {escape(result.key)}">{claims}{parts}</nav>'


def _data(result: PaperResult) -> str:
    differs = "".join(f"<li>{escape(line)}</li>" for line in result.differs)
    return (
        '<dl class="data"><dt class="of-paper">What the paper was done on</dt>'
        f"<dd>{escape(result.paper_data)}</dd>"
        f'<dt class="of-ours">What this was done on</dt><dd>{escape(result.our_data)}</dd>'
        + (f"<dt>What differs, and what that means</dt><dd><ul>{differs}</ul></dd>" if differs else "")
        + "</dl>"
    )


def _claims(claims: Sequence[Claim], page: str = "") -> str:
    """The claims, with links to where all of it stands: on ``page``, or below on their own, under a heading."""
    if not claims:
        return ""
    head = "" if page else '<h2 id="claims">What the paper says, and what comes out</h2>'
    return "\n".join([head, '<ul class="claims">', *(_claim(claim, page) for claim in claims), "</ul>"])


def _claim(claim: Claim, page: str) -> str:
    kind, verdict = _VERDICTS[claim.holds]
    see = "".join(f' <a href="{page}#{anchor(number)}">{escape(number)}</a>' for number in claim.see)
    told = f"<div>{escape(claim.said)}<p>{escape(claim.found)}{see}</p></div>"
    return f'<li><span class="verdict {kind}">{verdict}</span>{told}</li>'


def _part(part: Part) -> str:
    head = f'<h2 id="{anchor(part.number)}"><b>{escape(part.number)}</b>{escape(part.title)}</h2>'
    return head + (_table(part) if isinstance(part, TableResult) else _figure(part))


def _table(table: TableResult) -> str:
    told = any(row.note for row in table.rows)  # a column without a word is left out
    columns = table.columns if told else table.columns[:-1]
    heads = "".join(
        f'<th scope="col"{_class(place, len(columns), told=told)}>{escape(head)}</th>'
        for place, head in enumerate(columns)
    )
    rows = "".join(f"<tr>{_cells(row.cells[: len(columns)], told=told)}</tr>" for row in table.rows)
    remark = f"<p>{escape(table.remark)}</p>" if table.remark else ""
    return (
        f'<div class="wide" tabindex="0" role="region" aria-label="{escape(table.number)}">'
        f"<table><thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table></div>{remark}"
    )


def _cells(cells: Sequence[str], *, told: bool) -> str:
    rest = (f"<td{_class(place, len(cells), told=told)}>{escape(cell)}</td>" for place, cell in enumerate(cells[1:], 1))
    return f'<th scope="row">{escape(cells[0])}</th>' + "".join(rest)


def _class(place: int, count: int, *, told: bool) -> str:
    """What the cells of a column are: the paper's, a note, or ours."""
    if place == 0:
        return ""
    kind = "of-paper" if place == 1 else "note" if told and place == count - 1 else "of-ours"
    return f' class="{kind}"'


def _figure(figure: FigureResult) -> str:
    picture = base64.b64encode(figure.svg).decode()
    remark = f"<p>{escape(figure.remark)}</p>" if figure.remark else ""
    return (
        f'<figure><p><span class="tag of-paper">The paper’s:</span>{escape(figure.paper)}</p>'
        f'<div class="wide" tabindex="0" role="region" aria-label="{escape(figure.number)}">'
        f'<img src="data:image/svg+xml;base64,{picture}" alt="{escape(figure.number)}: {escape(figure.ours)}"></div>'
        f'<figcaption><p><span class="tag of-ours">Ours:</span>{escape(figure.ours)}</p>{remark}</figcaption></figure>'
    )


def _files(result: PaperResult) -> str:
    if not result.files:
        return ""
    lines = "".join(f'<li><a href="{escape(name)}">{escape(name)}</a></li>' for name, _ in result.files)
    return f"<h2>Files beside this page</h2><ul>{lines}</ul>"
