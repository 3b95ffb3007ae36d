"""The pictures of the pages: made by a script that still runs, small, and without anything from the network."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PICTURES = sorted((ROOT / "docs/pictures").iterdir())
LARGEST = 100_000  # bytes
SHOWN = {
    "check.svg": "Slow reveal: 15.00 s on Simulated rig",
    "play.svg": " playing",
    "live.svg": "preset 1 stored",
    "commission.svg": "pan goes 2 deg to one side",
    "commission-drone.svg": "Take all propellers off",
}
"""What each screen has."""


def words(svg: str) -> str:
    return re.sub(r"<[^>]+>", "", svg).replace("&#160;", " ")


@pytest.mark.parametrize("picture", PICTURES, ids=lambda picture: picture.name)
def test_a_picture_is_small_and_used(picture: Path) -> None:
    assert picture.stat().st_size < LARGEST
    pages = [ROOT / "README.md", *ROOT.glob("docs/**/*.md")]
    assert any(f"pictures/{picture.name})" in page.read_text(encoding="utf-8") for page in pages)


def test_the_script_makes_each_of_them(tmp_path: Path) -> None:
    subprocess.run([sys.executable, ROOT / "docs/make_pictures.py", tmp_path], check=True, timeout=110)
    made = {picture.name for picture in tmp_path.iterdir()}
    assert made >= set(SHOWN)  # those of pages need Chromium
    assert made <= {picture.name for picture in PICTURES}
    for name, text in SHOWN.items():
        for file in (tmp_path / name, ROOT / "docs/pictures" / name):
            svg = file.read_text(encoding="utf-8")
            assert text in words(svg)
            assert set(re.findall(r"https?://[^\"]+", svg)) == {"http://www.w3.org/2000/svg"}
