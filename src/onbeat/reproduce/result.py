"""What comes out where a paper's experiments are done again: its tables and figures, each beside ours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from onbeat.errors import OnbeatError

COLUMNS = ("", "paper", "ours", "note")
"""Heads of a table: what the row is of, what the paper says, what comes out here, and what is to be said of it."""


@dataclass(frozen=True)
class Row:
    """One line of a table.

    Parameters
    ----------
    label : what it is of.
    paper : what the paper prints there; None where it prints nothing.
    ours : what comes out here, by the method as published.
    note : what has to be known to compare them; may be empty.
    others : further cells of ours, by other methods; they stand between ``ours`` and ``note``.
    """

    label: str
    paper: str | None
    ours: str
    note: str = ""
    others: tuple[str, ...] = ()

    @property
    def cells(self) -> tuple[str, ...]:
        """All cells as they are printed, as many as the table has columns."""
        return (self.label, "–" if self.paper is None else self.paper, self.ours, *self.others, self.note)


@dataclass(frozen=True)
class TableResult:
    """A table of the paper's, or one that the paper gives in words, beside ours.

    Parameters
    ----------
    number : as the paper numbers it, ``Table I``; ``Sec. VI`` where it has numbers without a table.
    title : what it shows.
    rows : one line each.
    columns : their heads; further ones of ours between ``ours`` and ``note``.
    remark : what comes out, in a sentence or two: what agrees, what does not, and why.

    Raises
    ------
    OnbeatError
        If a row has not as many cells as there are heads.

    Examples
    --------
    >>> table = TableResult("Table I", "Beats", (Row("a song", "0.598 s", "0.566 s"),))
    >>> table.rows[0].cells
    ('a song', '0.598 s', '0.566 s', '')
    """

    number: str
    title: str
    rows: tuple[Row, ...]
    columns: tuple[str, ...] = COLUMNS
    remark: str = ""

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row.cells) != len(self.columns):
                raise OnbeatError(f"{self.number}: {len(row.cells)} cells under {len(self.columns)} heads: {row.cells}")


@dataclass(frozen=True)
class FigureResult:
    """A figure of the paper's, drawn anew.

    Parameters
    ----------
    number : as the paper numbers it, ``Fig. 5``.
    title : what it shows.
    svg : the drawing (:func:`onbeat.viewer.plots.files.figure_bytes`).
    paper : what the paper's figure shows, told in our own words.
    ours : what is seen in this one, for those who cannot see it, too.
    remark : what agrees, what does not, and why; may be empty.
    """

    number: str
    title: str
    svg: bytes
    paper: str
    ours: str
    remark: str = ""


@dataclass(frozen=True)
class Claim:
    """Something the paper says, and whether it holds here.

    Parameters
    ----------
    said : the claim, in our own words.
    holds : whether it comes out here; None where these data cannot tell.
    found : what decides it, a sentence with few figures.
    see : numbers of the tables and figures that have all of them.
    """

    said: str
    holds: bool | None
    found: str
    see: tuple[str, ...] = ()

    @property
    def told(self) -> str:
        """What decides it, and where all of it is.

        >>> Claim("so", True, "97% are right", ("Table 3",)).told
        '97% are right (Table 3)'
        """
        return f"{self.found} ({'; '.join(self.see)})" if self.see else self.found


Part = TableResult | FigureResult


@dataclass(frozen=True)
class PaperResult:
    """A paper done again.

    Parameters
    ----------
    key : ``P1``, ``P2`` or ``P3``.
    title : the paper's.
    citation : who, where, when.
    paper_data : what the paper's experiments were done on.
    our_data : what these were done on.
    differs : what of the data, the body or the method is not the paper's, a sentence each; stands at the page's top.
    claims : what the paper claims, and whether it holds here; what they point to and is not there is left out.
    parts : tables and figures, in the paper's order, no two of one number.
    files : other files to be written beside the page, by name: pages to run a study with, tables to compute with.

    Raises
    ------
    OnbeatError
        If two parts have one number, by which they are led to.
    """

    key: str
    title: str
    citation: str
    paper_data: str
    our_data: str
    differs: tuple[str, ...]
    claims: tuple[Claim, ...]
    parts: tuple[Part, ...]
    files: tuple[tuple[str, bytes], ...] = ()

    def __post_init__(self) -> None:
        numbers = [part.number for part in self.parts]
        if twice := sorted({number for number in numbers if numbers.count(number) > 1}):
            raise OnbeatError(f"{self.key}: more than one {', '.join(twice)}; give each part a number of its own")
        object.__setattr__(self, "claims", tuple(_leading(claim, numbers) for claim in self.claims))


def _leading(claim: Claim, numbers: Sequence[str]) -> Claim:
    """A claim that points only to parts that are there: of some data a figure cannot be drawn."""
    return replace(claim, see=tuple(number for number in claim.see if number in numbers))


VERDICTS = {True: "hold", False: "do not hold", None: "cannot be told"}
"""What is said of claims, by whether they hold."""


def counts(claims: Sequence[Claim]) -> dict[bool | None, int]:
    """How many claims hold, how many do not, and of how many it cannot be told, in this order."""
    return {holds: sum(claim.holds is holds for claim in claims) for holds in VERDICTS}


def tally(claims: Sequence[Claim]) -> str:
    """How many claims hold, in words.

    >>> tally([Claim("a", True, ""), Claim("b", None, "")])
    '2 claims: 1 holds, 0 do not hold, 1 cannot be told'
    """
    told = [f"{count} {worded(holds, count)}" for holds, count in counts(claims).items()]
    return f"{len(claims)} claim{'s' if len(claims) != 1 else ''}: {', '.join(told)}"


def worded(holds: bool | None, count: int) -> str:
    """The verdict on so many claims.

    >>> worded(True, 1), worded(False, 1), worded(False, 2)
    ('holds', 'does not hold', 'do not hold')
    """
    if count != 1:
        return VERDICTS[holds]
    return {True: "holds", False: "does not hold", None: "cannot be told"}[holds]
