"""What is near a reference, and what is not: pictures in which something is drawn otherwise, or broken."""

from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image, ImageChops, ImageEnhance, ImageFilter

from browser.pictures import REFERENCES, Pictures, distance, rounded

TITLE, SHIRT, LANE, BUTTON = (20, 18, 120, 52), (570, 90, 730, 260), (20, 636, 1260, 676), (1228, 18, 1262, 52)


@pytest.fixture(scope="module")
def dance() -> Image.Image:
    return Image.open(REFERENCES / "dance.webp").convert("RGB")


def changed(picture: Image.Image, box: tuple[int, int, int, int], part: Image.Image) -> Image.Image:
    made = picture.copy()
    made.paste(part, box)
    return made


def hidden(picture: Image.Image, box: tuple[int, int, int, int]) -> Image.Image:
    """All of a box in the colour of its corner."""
    corner = picture.getpixel(box[:2])
    return changed(picture, box, Image.new("RGB", (box[2] - box[0], box[3] - box[1]), corner))


def test_what_is_drawn_a_little_otherwise_is_near(dance: Image.Image) -> None:
    assert distance(dance, dance).worst == 0
    assert distance(rounded(ImageEnhance.Brightness(dance).enhance(0.997)), dance).near
    assert distance(ImageChops.offset(dance, 1, 1), dance).near
    assert distance(dance.filter(ImageFilter.GaussianBlur(0.6)), dance).near


@pytest.mark.parametrize("box", [TITLE, SHIRT, LANE, BUTTON])
def test_what_is_missing_is_not(dance: Image.Image, box: tuple[int, int, int, int]) -> None:
    found = distance(hidden(dance, box), dance)
    assert not found.near
    assert box[0] - 8 <= found.at[0] <= box[2] + 8
    assert box[1] - 8 <= found.at[1] <= box[3] + 8


def test_a_title_that_is_elsewhere_is_not(dance: Image.Image) -> None:
    aside = (TITLE[0] + 12, TITLE[1], TITLE[2] + 12, TITLE[3])
    assert not distance(changed(hidden(dance, TITLE), aside, dance.crop(TITLE)), dance).near


def test_a_dancer_without_light_is_not(dance: Image.Image) -> None:
    dim = ImageEnhance.Brightness(dance.crop(SHIRT)).enhance(0.8)
    assert not distance(changed(dance, SHIRT, dim), dance).near


def test_another_theme_another_size_and_a_slight_haze_are_not(dance: Image.Image) -> None:
    assert not distance(Image.open(REFERENCES / "dance_dark.webp").convert("RGB"), dance).near
    assert not distance(Image.open(REFERENCES / "dance_phone.webp").convert("RGB"), dance).near
    assert not distance(ImageEnhance.Brightness(dance).enhance(0.98), dance).near


def test_a_picture_that_differs_is_kept_and_named(
    dance: Image.Image, pictures: Pictures, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("ONBEAT_REFERENCES", raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    with pytest.raises(AssertionError, match=r"dance\.png is not like .*dance\.webp: mean .* worst"):
        pictures.compare(hidden(dance, LANE), "dance")
    assert (tmp_path / "dance.png").exists()
    with pytest.raises(AssertionError, match="ONBEAT_REFERENCES=write"):
        pictures.compare(dance, "no such page")
