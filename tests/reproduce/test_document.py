"""``results.json`` holds every number of the pages, and is refused where it is another's."""

import pytest

from made_results import RESULT
from onbeat.errors import OnbeatError
from onbeat.reproduce.document import ResultsDocument, results_document


def test_results_come_back():
    made = results_document([RESULT], quick=True, seed=3)
    read = ResultsDocument.from_json(made.to_json())
    assert read == made
    (paper,) = read.papers
    assert [(row.paper, row.ours) for row in paper.tables[0].rows] == [("0.598 s", "0.596 s"), (None, "0.5 s")]
    assert paper.figures[0].file == "p1_fig_5.svg"
    assert [claim.holds for claim in paper.claims] == [True, None]


@pytest.mark.parametrize("data", [b"", b"[]", b'{"version": 1}', b'{"version": "1"}'])
def test_what_is_no_document_is_refused(data: bytes):
    with pytest.raises(OnbeatError, match=r"results\.json is not a document of results"):
        ResultsDocument.from_json(data)
