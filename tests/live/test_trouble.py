"""Troubles are said once."""

from __future__ import annotations

from onbeat.live.sound.trouble import Trouble


def test_a_trouble_that_comes_and_goes_quickly_is_said_once():
    trouble = Trouble("begins", "over", high=0.0, low=0.0)
    said = [trouble.hear(float(step % 2), 0.5) for step in range(1, 20)] + [trouble.hear(0.0, 0.5) for _ in range(9)]
    assert [text for text in said if text] == ["begins", "over"]


def test_a_smoothed_amount_has_to_last():
    trouble = Trouble("begins", "over", high=0.5, low=0.1, smooth=1.0)
    assert trouble.hear(1.0, 0.1) is None
    assert "begins" in [trouble.hear(-1.0, 0.1) for _ in range(30)]
