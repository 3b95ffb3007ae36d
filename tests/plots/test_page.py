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

from teleop.app.planning import plan_file
from teleop.config.profile import Profile, load_profile
from teleop.core.axes import Axis
from teleop.core.events import Action
from teleop.planner.keyframes.planner import Key, plan
from teleop.planner.trajectory import Move
from teleop.plots.downsample import MOST
from teleop.plots.page import Watch, page
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
    assert said["peaks"][1] == ["pan 6.52 / 120", "tilt 2.36 / 90", "focus 0.113 / 0.5"]
    assert seconds(said["cursor"]) == pytest.approx(6, abs=0.05)
    assert [len(card) for card in said["values"]] == [3, 3, 3, 3]
    assert said["values"][1][0].startswith("pan 6.5")
    assert [seconds(text) for text in said["zoomed"]] == pytest.approx([6, 9], abs=0.05)
    assert said["hidden"] == [2, 2, 2, 2]
    assert [seconds(text) for text in said["whole"]] == pytest.approx([0, 15], abs=0.05)


def seconds(text: str) -> float:
    return float(text.split(" s")[0])


LAID_OUT = """
<script type="module">
const boxes = [];
const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
while (walk.nextNode()) {
  const node = walk.currentNode, around = node.parentElement;
  if (!node.textContent.trim() || around.closest("script, style") || !around.checkVisibility()) continue;
  const range = document.createRange();
  range.selectNodeContents(node);
  for (const { left, top, right, bottom } of range.getClientRects())
    if (right > left) boxes.push({ on: "page", text: node.textContent.trim(), box: [left, top, right, bottom] });
}
for (const [name, words] of Object.entries(placed)) for (const word of words) boxes.push({ on: name, ...word });
document.title = JSON.stringify({ boxes, wide: document.documentElement.scrollWidth - innerWidth });
</script>
"""


def in_browser(text: str, folder: Path, width: int = 1280, height: int = 800) -> dict:
    """What the page has put into its title, as JSON."""
    (folder / "move.html").write_text(text, encoding="utf-8")
    command = [str(CHROMIUM), "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder / 'user'}"]
    command += [f"--window-size={width},{height}", "--virtual-time-budget=3000", "--dump-dom"]
    done = subprocess.run(
        [*command, f"file://{folder}/move.html"], capture_output=True, text=True, timeout=100, check=True
    )
    return json.loads(Reader(done.stdout).texts["title"][0])


def exposed(text: str) -> str:
    """The page with what it has put on its canvases where another script can see it."""
    return text.replace("const placed = {};", "const placed = (globalThis.placed = {});")


def overlapping(boxes: list[dict]) -> list[tuple[str, str]]:
    found = []
    for index, one in enumerate(boxes):
        for other in boxes[index + 1 :]:
            (left, top, right, bottom), (x0, y0, x1, y1) = one["box"], other["box"]
            apart = right <= x0 + 0.5 or x1 <= left + 0.5 or bottom <= y0 + 0.5 or y1 <= top + 0.5
            if one["on"] == other["on"] and not apart:
                found.append((one["text"], other["text"]))
    return found


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium to look at the page with")
@pytest.mark.parametrize(("name", "width"), [("panorama", 390), ("interview", 1280), ("day-to-night", 390)])
def test_no_words_lie_over_each_other(name: str, width: int, profile: Profile, tmp_path: Path) -> None:
    plan = plan_file(name, profile)
    found = in_browser(exposed(page(plan.sequence, profile, plan.timelapse)) + LAID_OUT, tmp_path, width)
    words = [each["on"] for each in found["boxes"]]
    assert words.count("page") > 15
    assert words.count("position") >= 4
    assert words.count("path") >= 4
    assert overlapping(found["boxes"]) == []
    assert found["wide"] <= 0  # nothing sticks out of a phone


RELOADED = """
<script type="module">
const loads = Number(sessionStorage.getItem("loads") ?? 0) + 1, button = document.querySelector("#axes button");
sessionStorage.setItem("loads", loads);
const kept = { loads, hidden: button.ariaPressed === "false", limits: document.getElementById("limits").ariaPressed };
if (loads === 1) {
  button.click();
  document.getElementById("limits").click();
} else globalThis.teleopPreview = () => {}; // once is enough
document.title = JSON.stringify(kept);
</script>
"""


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium to look at the page with")
def test_a_watched_page_loads_itself_anew_from_a_file_and_looks_as_before(profile: Profile, tmp_path: Path) -> None:
    reveal = load_sequence("reveal", profile.limits, profile.name)
    (tmp_path / "move.html.js").write_text('teleopPreview("newer", []);\n', encoding="utf-8")
    found = in_browser(page(reveal, profile, watch=Watch("older", "move.html.js")) + RELOADED, tmp_path)
    assert found["loads"] == 2
    assert (found["hidden"], found["limits"]) == (True, "true")


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium to look at the page with")
def test_a_watched_page_shows_what_is_wrong_with_the_sequence_now(profile: Profile, tmp_path: Path) -> None:
    reveal = load_sequence("reveal", profile.limits, profile.name)
    (tmp_path / "move.html.js").write_text('teleopPreview("same", ["mine.yaml:3:5: no"]);\n', encoding="utf-8")
    show = '<script type="module">setTimeout(() => { document.title = JSON.stringify({ problems:'
    show += ' document.getElementById("problems").textContent }); }, 1500);</script>'
    found = in_browser(page(reveal, profile, watch=Watch("same", "move.html.js")) + show, tmp_path)
    assert found == {"problems": "mine.yaml:3:5: no"}


def test_a_page_that_is_not_watched_may_load_no_script(profile: Profile, reveal: str) -> None:
    watched = page(load_sequence("reveal", profile.limits, profile.name), profile, watch=Watch("1", "move.html.js"))
    policies = [each["content"] for text in (reveal, watched) for _, each in Reader(text).tags if "http-equiv" in each]
    assert ["file:" in str(policy) for policy in policies] == [False, True]


def test_a_timelapse_is_by_frames_with_its_interval(profile: Profile) -> None:
    plan = plan_file("day-to-night", profile)
    move = Reader(page(plan.sequence, profile, plan.timelapse)).move
    assert (move["duration"], move["shoot"]["first"]) == (743, 6.5)
    assert [each["name"] for each in move["quantities"]] == ["position", "step", "interval"]
    interval = move["axes"][-1]
    assert interval["samples"]["interval"][0] == 6.5
    assert interval["samples"]["interval"][-1] == 14
    assert move["axes"][0]["keys"][1]["at"] == 432  # 12 still frames come first


def test_a_panorama_has_its_pictures_and_its_lens(profile: Profile) -> None:
    move = Reader(page(load_sequence("panorama", profile.limits, profile.name), profile)).move
    assert move["fov"] == [54, 38]
    assert len(move["tiles"]) == 12
    assert move["tiles"][0] == [-53, 26]
    other = Reader(page(load_sequence("reveal", profile.limits, profile.name), profile, fov=(30, 20))).move
    assert (other["fov"], "tiles" in other) == ([30, 20], False)
