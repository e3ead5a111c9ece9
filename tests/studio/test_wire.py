"""What the page and the server say to each other is one contract."""

from __future__ import annotations

from pathlib import Path

from onbeat.studio import wire

CONTRACT = Path(__file__).resolve().parents[2] / "viewer-js" / "src" / "studio" / "contract.ts"


def test_the_pages_contract_is_written_from_these_classes():
    written = CONTRACT.read_text(encoding="utf-8")
    assert written == wire.typescript(), "python -m onbeat.studio.wire > viewer-js/src/studio/contract.ts"
    for part in ('import type { CurveData, MetricData, PageData } from "../contract";', "scene: PageData;"):
        assert part in written
    assert '  mark: "forbidden" | "favourite" | null;' in written
