"""The wheel that users install: typed, with the shipped files and the page's parts."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def names(tmp_path_factory):
    wheel = pytest.importorskip("hatchling.builders.wheel", reason="hatchling is an extra of development")
    folder = tmp_path_factory.mktemp("dist")
    (file,) = wheel.WheelBuilder(str(ROOT)).build(directory=str(folder), versions=["standard"])
    with zipfile.ZipFile(file) as archive:
        return set(archive.namelist())


def test_the_wheel_is_typed(names):
    assert "teleop/py.typed" in names


@pytest.mark.parametrize("kind", ["profiles", "sequences"])
def test_the_wheel_has_every_shipped_file(names, kind):
    shipped = {str(file.relative_to(ROOT)) for file in (ROOT / kind).rglob("*.yaml")}
    assert shipped
    assert {f"teleop/data/{name}" for name in shipped} <= names


def test_the_wheel_has_every_file_of_the_package_and_no_test(names):
    package = {str(file.relative_to(ROOT)) for file in (ROOT / "teleop").rglob("*") if file.is_file()}
    kept = {name for name in package if "__pycache__" not in name and not name.startswith("teleop/data/")}
    assert kept <= names
    assert not [name for name in names if name.startswith(("tests/", "docs/"))]
