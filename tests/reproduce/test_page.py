"""The page of a paper needs nothing else, and keeps the paper's column beside ours."""

from __future__ import annotations

import base64
import re
from dataclasses import replace

from made_results import RESULT, SVG
from onbeat.reproduce.page import index_page, paper_page
from onbeat.reproduce.result import Row, TableResult


def test_a_page_needs_no_other_file_and_no_network():
    page = paper_page(RESULT).decode()
    assert not re.search(r'(?:src|href)="(?!data:|study/|#)', page)
    assert "<script" not in page
    assert "Dance &amp; &lt;script&gt;" in page
    (picture,) = re.findall(r'src="data:image/svg\+xml;base64,([^"]+)"', page)
    assert base64.b64decode(picture) == SVG
    assert 'alt="Fig. 5: a decision, &quot;real&quot;"' in page


def test_the_papers_column_is_beside_ours():
    page = paper_page(RESULT).decode()
    assert '<td class="of-paper">0.598 s</td><td class="of-ours">0.596 s</td>' in page
    assert '<td class="of-paper">–</td><td class="of-ours">0.5 s</td>' in page
    assert page.index("made, not captured") < page.index("12 of 13") < page.index('id="table-i"')


def test_the_top_tells_what_holds_and_leads_to_every_part_before_anything_else():
    page = paper_page(RESULT).decode()
    top = page[page.index("<h1>") : page.index('<dl class="data">')]
    assert re.findall(r"<b>(\d)</b> ([a-z ]+)<", top) == [("1", "holds"), ("0", "do not hold"), ("1", "cannot be told")]
    assert re.findall(r'href="#([^"]+)"', top) == ["claims", "table-i", "fig-5"]


def test_a_claim_leads_to_the_table_that_has_all_of_it():
    assert '12 of 13 <a href="#table-i">Table I</a>' in paper_page(RESULT).decode()
    assert '12 of 13 <a href="p1.html#table-i">Table I</a>' in index_page([RESULT]).decode()


def test_a_column_of_notes_is_shown_where_something_is_noted():
    table = TableResult("Table I", "Beats", (Row("a", "1", "2", "by F"), Row("b", "3", "4")))
    assert ">note</th>" in paper_page(replace(RESULT, parts=(table,))).decode()
    assert ">note</th>" not in paper_page(RESULT).decode()


def test_the_index_leads_to_every_table_and_figure():
    page = index_page([RESULT]).decode()
    linked = dict(re.findall(r'href="p1\.html#([^"]+)">([^<]+)<', page))
    assert linked == {"claims": "Claims", "table-i": "Table I", "fig-5": "Fig. 5"}
    assert all(f'id="{place}"' in paper_page(RESULT).decode() for place in linked)
    assert "cannot be told" in page
