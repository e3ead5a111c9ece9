"""Whatever names hold, the page reads them back and nothing else changes."""

from __future__ import annotations

import json

from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.motion import Motion
from onbeat.viewer.pages.page import render_page

NAMES = st.text(st.characters(exclude_categories=["Cs"]), max_size=30) | st.text("</script>!-&\"\\'", max_size=30)


@settings(max_examples=40, deadline=None)
@given(clip=NAMES, title=NAMES.filter(bool))
def test_names_come_back_and_stay_inside(swinger: Motion, clip: str, title: str) -> None:
    moves = [{"clip": clip, "from_s": 0.0, "to_s": 1.0, "at_s": 0.0}]
    page = render_page(swinger[:2], None, {"title": title, "moves": moves}).decode()
    _shell, _, rest = page.partition('<script type="application/json" id="data">')
    inside, end, _ = rest.partition("</script>")
    assert end
    assert "<" not in inside
    data = json.loads(inside)
    assert (data["title"], data["moves"][0]["clip"]) == (title, clip)
