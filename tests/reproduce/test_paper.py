"""Papers by their keys."""

import pytest

from onbeat.errors import OnbeatError
from onbeat.reproduce.paper import PAPERS, chosen, paper


@pytest.mark.parametrize("key", PAPERS)
def test_every_paper_is_what_its_key_says(key: str):
    assert paper(key).key == key
    assert paper(key).title


def test_an_unknown_paper_is_refused_with_those_there_are():
    with pytest.raises(OnbeatError, match=r"no paper 'P4'.*P1: .*P2: .*P3: "):
        chosen(["P1", "P4"])
