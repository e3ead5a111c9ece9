"""The document inside the page: what Python writes is what the page reads."""

from __future__ import annotations

import base64
from pathlib import Path

import numpy as np
import pytest

from onbeat.viewer import typescript
from onbeat.viewer.contract import STRUCTS, pack_curve, pack_path, unpack_curve, unpack_path

PAGE_SOURCES = Path(__file__).resolve().parents[2] / "viewer-js" / "src"


def test_the_page_has_the_same_fields() -> None:
    if not PAGE_SOURCES.is_dir():
        pytest.skip("the page's sources (viewer-js) are not here")
    written = (PAGE_SOURCES / "contract.ts").read_text(encoding="utf-8")
    assert written == typescript.declarations(), "python -m onbeat.viewer.typescript > viewer-js/src/contract.ts"


def test_every_class_is_an_interface_with_all_its_fields() -> None:
    declared = typescript.declarations()
    for struct in STRUCTS:
        body = declared.split(f"export interface {struct.__name__} {{")[1].split("}")[0]
        names = [line.split(":")[0].strip() for line in body.strip().splitlines()]
        assert names == list(struct.__struct_fields__)
    assert "audio: AudioData | null;" in declared
    assert "capsules: CapsuleData[];" in declared


def test_paths_come_back_to_half_a_step() -> None:
    rng = np.random.default_rng(1)
    positions = rng.uniform((-3, 40, 0), (3, 44, 2), (50, 7, 3))
    path = pack_path(positions)
    assert path.step < 1.1e-4
    assert np.abs(unpack_path(path, 7) - positions).max() <= path.step * 0.501
    assert len(base64.b64decode(path.base64)) == 50 * 7 * 3 * 2


def test_a_path_that_does_not_move_is_kept() -> None:
    positions = np.full((4, 2, 3), 1.25)
    assert np.allclose(unpack_path(pack_path(positions), 2), positions)


def test_curves_are_clipped_to_what_they_can_hold() -> None:
    curve = pack_curve(np.array([-1.0, 0.0, 0.5, 1.0, 7.0]), 10.0)
    assert np.allclose(unpack_curve(curve), [0, 0, 0.5, 1, 1], atol=0.5 / 255)
    assert curve.rate == 10.0
