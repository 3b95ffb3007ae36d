"""What is kept of how axes answer: by key, whole or not at all, and never over a damaged file."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from teleop.config.response_store import Key, ResponseStore
from teleop.core.axes import Axis
from teleop.core.response import Response

KEY = Key("My rig", "02.02.00.07", "socketcan", "speed", "fx3-24mm")
FOUND = Response(0.04, 0.08, 0.97, 0.2, 0.01, 0.02, 0.1)


def store_of(folder: Path) -> ResponseStore:
    return ResponseStore(folder / "responses")


def test_what_is_kept_is_read_again(tmp_path: Path) -> None:
    assert store_of(tmp_path).read() == []
    assert store_of(tmp_path).keep(KEY, Axis.PAN, FOUND)
    assert store_of(tmp_path).keep(KEY, Axis.TILT, Response(0.0, 0.1))
    pan, tilt = store_of(tmp_path).read("My rig")
    assert (pan.key, pan.axis, pan.response) == (KEY, Axis.PAN, FOUND)
    assert tilt.response.gain_doubt == math.inf


@pytest.mark.parametrize("part", Key._fields)
def test_each_part_of_the_key_counts(part: str, tmp_path: Path) -> None:
    store = store_of(tmp_path)
    other = KEY._replace(**{part: "another"})
    store.keep(KEY, Axis.PAN, FOUND)
    store.keep(other, Axis.PAN, FOUND._replace(lag=0.2))
    assert {each.key: each.response.lag for each in store.read()} == {KEY: 0.08, other: 0.2}


@pytest.mark.parametrize(
    "content",
    [b"", b"{", b"\xff\xfe", b"[]", b"null", b'{"format": "teleop response", "version": 2}', b"lag", b"{}"],
)
def test_a_damaged_file_is_a_line_with_the_cure_and_is_not_replaced(content: bytes, tmp_path: Path) -> None:
    store = store_of(tmp_path)
    store.keep(KEY, Axis.PAN, FOUND)
    store.keep(KEY, Axis.TILT, FOUND)
    path = next(tmp_path.rglob("*pan.json"))
    path.write_bytes(content)
    assert [each.axis for each in store.read("My rig")] == [Axis.TILT]
    assert store.damage.startswith(str(path))
    assert store.damage.endswith("clear it with teleop forget")
    assert not store.keep(KEY, Axis.PAN, FOUND)
    store.drop(KEY, Axis.PAN)
    assert path.read_bytes() == content
    assert path in store.forget("My rig")
    assert not list(tmp_path.rglob("*.json"))


@pytest.mark.parametrize(("name", "value"), [("lag", -0.1), ("gain", 0), ("drift", "x"), ("dead_time", math.nan)])
def test_a_value_that_no_gimbal_has_is_damage(name: str, value: object, tmp_path: Path) -> None:
    store = store_of(tmp_path)
    store.keep(KEY, Axis.PAN, FOUND)
    path = next(tmp_path.rglob("*.json"))
    content = json.loads(path.read_text())
    content["response"][name] = value
    path.write_text(json.dumps(content))
    assert store.read() == []
    assert store.damaged == [path]


def test_two_programs_at_once_lose_nothing_of_each_other(tmp_path: Path) -> None:
    """Both have read before either writes."""
    one, other = store_of(tmp_path), store_of(tmp_path)
    one.read()
    other.read()
    one.keep(KEY, Axis.PAN, FOUND)
    other.keep(KEY, Axis.TILT, FOUND)
    other.keep(KEY._replace(payload="a7"), Axis.PAN, FOUND)
    assert len(one.read()) == 3


def test_forget_clears_one_rig_or_all(tmp_path: Path) -> None:
    store = store_of(tmp_path)
    for rig in ("My rig", "my-rig", "Другой"):
        store.keep(KEY._replace(rig=rig), Axis.PAN, FOUND)
    assert len(store.forget("My rig")) == 1
    assert {each.key.rig for each in store.read()} == {"my-rig", "Другой"}
    assert len(store.forget()) == 2
    assert store.read() == []
