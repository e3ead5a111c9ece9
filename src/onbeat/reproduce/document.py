"""``results.json``: all numbers of the papers done again, for programs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import msgspec

from onbeat.errors import OnbeatError
from onbeat.keyposes.decoding import decoded
from onbeat.reproduce.page import anchor, page_name
from onbeat.reproduce.result import FigureResult, PaperResult, TableResult

VERSION = 1

Said = msgspec.Meta


class ReproducedRow(msgspec.Struct, frozen=True):
    """One line of a table."""

    label: Annotated[str, Said(description="what it is of")]
    paper: Annotated[str | None, Said(description="what the paper prints; null where it prints nothing")]
    ours: Annotated[str, Said(description="what comes out here, by the method as published")]
    note: Annotated[str, Said(description="what has to be known to compare them")] = ""
    others: Annotated[
        list[str], Said(description="what comes out by other methods, as the table's heads name them")
    ] = msgspec.field(default_factory=list[str])


class ReproducedTable(msgspec.Struct, frozen=True):
    """A table of the paper's beside ours."""

    number: Annotated[str, Said(description="as the paper numbers it")]
    title: Annotated[str, Said(description="what it shows")]
    columns: Annotated[list[str], Said(description="its heads")]
    rows: Annotated[list[ReproducedRow], Said(description="its lines")]
    remark: Annotated[str, Said(description="what agrees, what does not, and why")] = ""


class ReproducedFigure(msgspec.Struct, frozen=True):
    """A figure of the paper's, drawn anew."""

    number: Annotated[str, Said(description="as the paper numbers it")]
    title: Annotated[str, Said(description="what it shows")]
    file: Annotated[str, Said(description="the drawing, beside this document")]
    paper: Annotated[str, Said(description="what the paper's figure shows")]
    ours: Annotated[str, Said(description="what this one shows")]
    remark: Annotated[str, Said(description="what agrees, what does not, and why")] = ""


class ReproducedClaim(msgspec.Struct, frozen=True):
    """Something the paper says."""

    said: Annotated[str, Said(description="the claim")]
    holds: Annotated[bool | None, Said(description="whether it comes out here; null where these data cannot tell")]
    found: Annotated[str, Said(description="the figures that decide it")]


class ReproducedPaper(msgspec.Struct, frozen=True):
    """A paper done again."""

    key: Annotated[str, Said(description="`P1`, `P2` or `P3`")]
    title: Annotated[str, Said(description="the paper's")]
    citation: Annotated[str, Said(description="who, where, when")]
    page: Annotated[str, Said(description="its page, beside this document")]
    paper_data: Annotated[str, Said(description="what the paper was done on")]
    our_data: Annotated[str, Said(description="what this was done on")]
    differs: Annotated[list[str], Said(description="what is not the paper's, and what that means")]
    claims: Annotated[list[ReproducedClaim], Said(description="what the paper says")]
    tables: Annotated[list[ReproducedTable], Said(description="in the paper's order")]
    figures: Annotated[list[ReproducedFigure], Said(description="in the paper's order")]


class ResultsDocument(msgspec.Struct, frozen=True):
    """``results.json``: what came out where the papers were done again."""

    version: Annotated[int, Said(description="of this document; others are refused")]
    quick: Annotated[bool, Said(description="whether it was a first look, with fewer repetitions and shorter songs")]
    seed: Annotated[int, Said(description="that of `--seed`")]
    papers: Annotated[list[ReproducedPaper], Said(description="one each")]

    def to_json(self) -> bytes:
        """The document as JSON bytes."""
        return msgspec.json.format(msgspec.json.encode(self), indent=1) + b"\n"

    @classmethod
    def from_json(cls, data: bytes, source: str = "results.json") -> ResultsDocument:
        """Read a document; an ``OnbeatError`` says what is wrong with it.

        Examples
        --------
        >>> ResultsDocument.from_json(b'{"version": 9}')
        Traceback (most recent call last):
        onbeat.errors.OnbeatError: results.json: version 9; this onbeat reads version 1
        """
        return decoded(
            data, cls, VERSION, source, "a document of results, as `onbeat reproduce` writes it", OnbeatError
        )


def results_document(results: Sequence[PaperResult], *, quick: bool = False, seed: int = 0) -> ResultsDocument:
    """Results as their document."""
    return ResultsDocument(VERSION, quick, seed, [_paper(result) for result in results])


def drawing_name(key: str, figure: FigureResult) -> str:
    """The file of a figure's drawing: ``p1_fig_5.svg``."""
    return f"{key.lower()}_{anchor(figure.number).replace('-', '_')}.svg"


def _paper(result: PaperResult) -> ReproducedPaper:
    return ReproducedPaper(
        key=result.key,
        title=result.title,
        citation=result.citation,
        page=page_name(result.key),
        paper_data=result.paper_data,
        our_data=result.our_data,
        differs=list(result.differs),
        claims=[ReproducedClaim(claim.said, claim.holds, claim.told) for claim in result.claims],
        tables=[_table(part) for part in result.parts if isinstance(part, TableResult)],
        figures=[_figure(result.key, part) for part in result.parts if isinstance(part, FigureResult)],
    )


def _table(table: TableResult) -> ReproducedTable:
    rows = [ReproducedRow(row.label, row.paper, row.ours, row.note, list(row.others)) for row in table.rows]
    return ReproducedTable(table.number, table.title, list(table.columns), rows, table.remark)


def _figure(key: str, figure: FigureResult) -> ReproducedFigure:
    name = drawing_name(key, figure)
    return ReproducedFigure(figure.number, figure.title, name, figure.paper, figure.ours, figure.remark)
