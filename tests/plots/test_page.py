"""The page: whole in itself, safe against its own data, and alive in a browser."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from html.parser import HTMLParser
from pathlib import Path

import pytest
from random_tracks import random_track

from teleop.config.profile import Profile, load_profile
from teleop.core.axes import Axis
from teleop.core.events import Action
from teleop.planner.keyframes.planner import Key, plan
from teleop.planner.trajectory import Move
from teleop.plots.downsample import MOST
from teleop.plots.page import page
from teleop.sequence.compile import CompiledSequence, Cue, load_sequence

HOSTILE = "</script><script>alert(1)</script> & <b>{{data}}"
LOADED = {"src", "srcset", "href", "data", "action", "poster", "background", "ping"}
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")


class Reader(HTMLParser):
    """Every tag with its attributes, and the text of scripts and styles."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.texts: dict[str, list[str]] = {}
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        self.texts.setdefault(tag, []).append("")

    def handle_data(self, data: str) -> None:
        if self.tags:
            self.texts[self.tags[-1][0]][-1] += data

    @property
    def move(self) -> dict:
        index = [attributes.get("id") for tag, attributes in self.tags if tag == "script"].index("move")
        return json.loads(self.texts["script"][index])


@pytest.fixture(scope="module")
def profile() -> Profile:
    return load_profile("sim", {})


@pytest.fixture(scope="module")
def reveal(profile: Profile) -> str:
    return page(load_sequence("reveal", profile.limits, profile.name), profile)


def test_nothing_is_loaded_from_anywhere(reveal: str) -> None:
    read = Reader(reveal)
    assert [(tag, attributes) for tag, attributes in read.tags if LOADED & set(attributes)] == []
    assert {tag for tag, _ in read.tags}.isdisjoint({"link", "iframe", "object", "embed", "base", "img"})
    assert not re.search(r"url\(|@import", "".join(read.texts["style"]))
    (policy,) = [each["content"] for _, each in read.tags if each.get("http-equiv") == "Content-Security-Policy"]
    assert policy == "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'"


def test_the_move_is_in_it(reveal: str, profile: Profile) -> None:
    move = Reader(reveal).move
    assert (move["title"], move["rig"], move["duration"]) == ("Slow reveal", "Simulated rig", 15)
    assert move["cues"] == [{"at": 0, "name": "record"}, {"at": 15, "name": "stop"}]
    pan = move["axes"][0]
    assert [key["name"] for key in pan["keys"]] == [f"key {number}" for number in range(1, 6)]
    assert pan["limits"]["velocity"] == [-profile.limits[Axis.PAN].velocity, profile.limits[Axis.PAN].velocity]
    for key in pan["keys"]:
        index = max(i for i, time in enumerate(pan["times"]) if time <= key["at"])
        assert pan["samples"]["position"][index] == pytest.approx(key["position"], abs=1e-3)
    assert "Copyright (c) 2022 Leon Sorokin" in reveal  # uPlot's licence goes where uPlot goes


def test_a_title_is_text(profile: Profile) -> None:
    move = plan({Axis.PAN: [Key(0, 0)]}, profile.limits)
    text = page(CompiledSequence(HOSTILE, move, [], [HOSTILE], {Axis.PAN: [Key(0, 0)]}), profile)
    read = Reader(text)
    assert len(read.texts["script"]) == 3  # the move, uPlot, the page's own
    assert (read.move["title"], read.move["warnings"]) == (HOSTILE, [HOSTILE])
    assert [title.strip() for title in read.texts["title"]] == [HOSTILE]


def test_a_continuous_axis_has_no_soft_limits(profile: Profile) -> None:
    pan = profile.axes[Axis.PAN].model_copy(update={"min": None, "max": None})
    turning = profile.model_copy(update={"axes": {**profile.axes, Axis.PAN: pan}})
    text = page(load_sequence("reveal", turning.limits, turning.name), turning)
    assert Reader(text).move["axes"][0]["limits"]["position"] == [None, None]


def test_a_long_move_of_every_axis_is_a_small_page(profile: Profile) -> None:
    axes = list(profile.limits)
    move = Move({axis: random_track(3000, seed) for seed, axis in enumerate(axes)})
    keys = {axis: [Key(0, 0, where="key 1")] for axis in axes}
    text = page(CompiledSequence("long", move, [Cue(1, Action.SHUTTER)], [], keys), profile)
    assert len(text) < 60_000 + 45 * MOST * len(axes)
    assert all(len(axis["times"]) <= MOST for axis in Reader(text).move["axes"])


DRIVE = """
<script type="module">
const over = document.querySelector(".u-over"), box = over.getBoundingClientRect(), said = {};
const mouse = (type, share) => over.dispatchEvent(new MouseEvent(
  type, { clientX: box.left + share * box.width, clientY: box.top + 20, bubbles: true, movementX: 1 }));
const turn = () => new Promise((done) => setTimeout(done, 50));
const now = () => document.getElementById("now").textContent;
const values = () => [...document.querySelectorAll("section")].map(
  (card) => [...card.querySelectorAll(".value:not([hidden])")].map((value) => value.textContent));
const at = async (share) => { mouse("mousemove", share); await turn(); return now(); };
said.peaks = values();
mouse("mouseenter", 0.4);
said.cursor = await at(0.4);
said.values = values();
mouse("mousedown", 0.4);
await at(0.6);
mouse("mouseup", 0.6);
await turn();
said.zoomed = [await at(0), await at(1)];
document.querySelector("#axes button").click();
await turn();
said.hidden = values().map((card) => card.length);
document.getElementById("whole").click();
await turn();
said.whole = [await at(0), await at(1)];
document.title = JSON.stringify(said);
</script>
"""


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium to look at the page with")
def test_the_page_in_a_browser(reveal: str, tmp_path: Path) -> None:
    (tmp_path / "move.html").write_text(reveal + DRIVE, encoding="utf-8")
    command = [str(CHROMIUM), "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'user'}"]
    command += ["--window-size=1280,900", "--virtual-time-budget=20000", "--dump-dom", f"file://{tmp_path}/move.html"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=100, check=True)
    said = json.loads(Reader(done.stdout).texts["title"][0])
    assert said["peaks"][1] == ["pan 8.79 / 120", "tilt 2.73 / 90", "focus 0.143 / 0.5"]
    assert seconds(said["cursor"]) == pytest.approx(6, abs=0.05)
    assert [len(card) for card in said["values"]] == [3, 3, 3, 3]
    assert said["values"][1][0].startswith("pan 5.5")
    assert [seconds(text) for text in said["zoomed"]] == pytest.approx([6, 9], abs=0.05)
    assert said["hidden"] == [2, 2, 2, 2]
    assert [seconds(text) for text in said["whole"]] == pytest.approx([0, 15], abs=0.05)


def seconds(text: str) -> float:
    return float(text.split(" s")[0])
