"""The wheel that users install: typed, with the shipped files and the page's parts."""

from __future__ import annotations

import ast
import base64
import hashlib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


SMALL = 1_500_000  # bytes, with the console's page
FEW = 12  # of so many modules one is compared: all take seconds


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    wheel = pytest.importorskip("hatchling.builders.wheel", reason="hatchling is an extra of development")
    folder = tmp_path_factory.mktemp("dist")
    (file,) = wheel.WheelBuilder(str(ROOT)).build(directory=str(folder), versions=["standard"])
    return Path(file)


@pytest.fixture(scope="module")
def archive(file):
    with zipfile.ZipFile(file) as archive:
        yield archive


@pytest.fixture(scope="module")
def names(archive):
    return set(archive.namelist())


def test_the_wheel_is_small(file):
    assert file.stat().st_size < SMALL


def test_a_module_of_the_wheel_is_its_source_line_by_line_without_its_docstring(archive, names):
    for name in sorted(names)[::FEW]:
        if name.endswith(".py"):
            source, made = ast.parse((ROOT / name).read_text(encoding="utf-8")), ast.parse(archive.read(name))
            if not name.endswith("__init__.py") and ast.get_docstring(source) is not None and len(source.body) > 1:
                del source.body[0]
            assert ast.dump(made, include_attributes=True) == ast.dump(source, include_attributes=True), name


def test_the_record_of_the_wheel_is_true(archive, names):
    (record,) = (name for name in names if name.endswith("RECORD"))
    lines = [line.rsplit(",", 2) for line in archive.read(record).decode().splitlines()]
    assert {name for name, *_ in lines} == names
    for name, digest, size in lines:
        if name != record:
            content = archive.read(name)
            made = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            assert (digest, size) == (f"sha256={made}", str(len(content))), name


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
