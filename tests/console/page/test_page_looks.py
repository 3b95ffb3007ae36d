"""How the page looks and who can use it: axe-core, five screens by geometry and colors, every size, the first paint."""

from __future__ import annotations

import io
import json
import math
import os
import re
from pathlib import Path

import pytest
from page_bench import LANDSCAPE, LAPTOP, LARGE, NARROW, NARROW_LANDSCAPE, PHONE, SMALL, take_control
from page_looks import look, unlike
from PIL import Image
from playwright.sync_api import expect

DATA = Path(__file__).parents[2] / "data"
AXE = (DATA / "axe/axe.min.js").read_text(encoding="utf-8")
DOCS = DATA.parents[1] / "docs/pictures"
LOOKS = DATA / "console_looks.json"
TABS = ("live", "move", "shoot", "takes")
SHOOT = {
    "title": "Day to night", "frames_done": 83, "frames": 240, "eta": 1_790_003_000.0, "missed": 1, "paused": False,
    "phase": "waiting", "why": "", "clip_s": 10.0,
}  # fmt: skip
PICTURES = {
    "live on a laptop": "console-laptop",
    "live on a phone": "console-phone",
    "move on a laptop": "console-move",
}
"""Those of the docs, by the screen that they show."""
MOVE = """\
title: Slow reveal
keyframes:
  - {at: 0, pan: -30, tilt: -12, focus: 0.2}
  - {at: 4, pan: -8, tilt: -6}
  - {at: 8, pan: 18, tilt: 3, focus: 0.45}
  - {at: 12, pan: 40, tilt: 6, focus: 0.8}
cues:
  - {at: 0, camera: record}
"""


CONTROLS = ", ".join(f"{each}:visible" for each in ("button:enabled", "input:enabled", "select:enabled", ".disc"))
FOCUSED = """() => {
    const now = document.activeElement;
    return now.matches('button, input, select, .disc') ? [...document.querySelectorAll('*')].indexOf(now) : null;
}"""
WIDER = """[document.documentElement, ...document.querySelectorAll('main, .card:not(.head)')]
    .filter((each) => each.scrollWidth > each.clientWidth + 1).map((each) => each.className)"""
HIDDEN = """() => {
    const [stop, first] = ['.stop', '.readouts'].map((each) => document.querySelector(each).getBoundingClientRect());
    return [...document.querySelectorAll('.chips .chip')].filter((chip) => {
        const box = chip.getBoundingClientRect(), right = box.top < stop.bottom ? stop.left : innerWidth;
        const cut = chip.querySelector('b').scrollWidth > chip.querySelector('b').clientWidth;
        return cut || box.left < 0 || box.right > right || box.top < 0 || box.bottom > first.top;
    }).map((chip) => chip.innerText);
}"""
SIZES = """[...document.querySelectorAll('main button, .tabs button:not(.keys-help)')].map((each) => {
    const box = each.getBoundingClientRect();
    return [each.ariaLabel || each.textContent, box.width, box.height];
})"""


@pytest.fixture
def staged(visit, server, rig):
    """A page of a rig that stands still, with something of everything."""
    (server.moves / "reveal.yaml").write_text(MOVE)
    rig.frozen = 12.0
    rig.at.update(pan=30.08, tilt=-12.3, roll=3.2, focus=0.42)
    rig.more.update(
        presets={"1": {"pan": 10.0, "tilt": -3.2, "name": "wide"}, "2": {"pan": -60, "tilt": 20, "roll": 10}},
        keys=[dict.fromkeys(rig.at, 0.2), {"pan": 30.0, "tilt": 10.0, "roll": 0.0, "focus": 0.4}],
        inputs=[{"name": "pad", "drives": [], "waits_for": "center its sticks", "trouble": ""}],
    )

    def open_it(tab, size=LAPTOP, touch=False):
        rig.more.update(shoot=SHOOT if tab == "shoot" else None, battery=78 if tab == "shoot" else None)
        page = visit(size, touch, at=f"?name=laptop#{tab}")
        take_control(page)
        if tab == "shoot":
            page.locator(".intervals .curve").wait_for()
        if tab == "move":
            expect(page.locator(".curves .line.stroke-pan path")).to_have_count(1)
        return page

    return open_it


@pytest.mark.parametrize("tab", TABS)
def test_axe_finds_no_violation(staged, tab):
    page = staged(tab)
    page.evaluate(AXE)
    found = page.evaluate("axe.run(document, {resultTypes: ['violations']})")
    assert [(each["id"], [node["html"][:120] for node in each["nodes"]]) for each in found["violations"]] == []


def test_axe_finds_no_violation_on_a_phone_that_is_stopped_and_lost(staged, rig):
    page = staged("live", PHONE, touch=True)
    page.evaluate(AXE)
    for change in ({"stopped": True, "stopped_by": "phone", "stopped_at": 1_790_000_000.0}, {"asking": "tablet"}):
        rig.more.update(change)
        page.locator(".banner").first.wait_for()
        found = page.evaluate("axe.run(document, {resultTypes: ['violations']})")
        assert [(each["id"], [node["html"][:120] for node in each["nodes"]]) for each in found["violations"]] == []


@pytest.mark.parametrize(
    ("name", "tab", "size"),
    [
        ("live on a laptop", "live", LAPTOP),
        ("live on a phone", "live", PHONE),
        ("live on a phone across", "live", LANDSCAPE),
        ("move on a laptop", "move", LAPTOP),
        ("shoot on a laptop", "shoot", LAPTOP),
    ],
)
def test_the_screen_looks_as_it_did(staged, rig, name, tab, size):
    page = staged(tab, size, touch=size != LAPTOP)
    page.wait_for_function("document.fonts.status === 'loaded'")
    expected, found = json.loads(LOOKS.read_text(encoding="utf-8")), look(page)
    if os.environ.get("PAGE_LOOKS") == "write":
        if name in PICTURES:
            photograph(page, rig, PICTURES[name])
        text = json.dumps({**expected, name: found}).replace("}}, ", "}},\n")
        LOOKS.write_text(text + "\n", encoding="utf-8")
    else:
        assert unlike(expected[name], found) == []


def photograph(page, rig, picture):
    """A picture for the docs, of a rig that has moved in the last 20 s."""
    for step in range(100):
        rig.frozen = 12.0 + 0.21 * step
        left = 99 - step
        rig.at.update(
            pan=30.08 - 22 * math.sin(left / 16), tilt=-12.3 + 9 * math.sin(left / 23), focus=0.42 + left / 333
        )
        page.wait_for_timeout(40)
    page.wait_for_timeout(300)
    image = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    image.quantize(224, dither=Image.Dither.NONE).save(DOCS / f"{picture}.png", optimize=True)


@pytest.mark.parametrize("size", [LAPTOP, PHONE, LANDSCAPE, SMALL, LARGE, NARROW])
@pytest.mark.parametrize("tab", TABS)
def test_nothing_is_wider_than_the_screen_and_stop_is_in_view(staged, tab, size):
    page = staged(tab, size, touch=size not in (LAPTOP, LARGE))
    assert page.evaluate(WIDER) == []
    stop = page.get_by_test_id("stop").bounding_box()
    assert min(stop["width"], stop["height"]) >= 72
    assert stop["x"] + stop["width"] <= size[0]


@pytest.mark.parametrize("size", [PHONE, LANDSCAPE, SMALL])
def test_what_a_finger_presses_is_large_enough(staged, size):
    page = staged("live", size, touch=True)
    sizes = page.evaluate(SIZES)
    assert [each for each in sizes if min(each[1:]) < 32] == []


def test_all_that_is_always_there_is_in_view_on_a_small_phone(staged, rig):
    """Control, health, missed sticks and REC: nothing has to be scrolled for, and nothing is beneath STOP."""
    rig.more.update(recording=True, recording_s=73.4)
    rig.more["inputs"].append({"name": "joystick", "drives": [], "waits_for": "", "trouble": "not plugged in"})
    page = staged("live", SMALL, touch=True)
    expect(page.locator(".health .chip")).to_have_count(7)
    for width, height in (NARROW, NARROW_LANDSCAPE, SMALL):
        page.set_viewport_size({"width": width, "height": height})
        assert page.evaluate(HIDDEN) == []


RIGS = [
    {"name": "crane", "alive": True, "state": "running", "holder": "anna", "error": None, "move": {"title": "Reveal"}},
    {"name": "dolly", "alive": True, "state": "stopped", "holder": None, "error": None, "move": None},
    {"name": "slider", "alive": False, "state": "lost", "holder": None, "error": None, "move": None},
]
TOP = """() => {
    const box = document.querySelector('.stop-all').getBoundingClientRect();
    const middle = (box.left + box.right) / 2;
    const points = [[box.left + 2, box.top + 2], [box.right - 3, box.bottom - 3], [middle, box.top + 9]];
    return points.map(([x, y]) => document.elementFromPoint(x, y)?.className);
}"""


def test_the_tiles_of_a_fleet_have_no_violation_and_nothing_lies_over_stop_all(browser, server, rig):
    page = browser.open("about:blank", SMALL, touch=True)
    try:
        page.route("**/api/fleet", lambda route: route.fulfill(json={"name": "crane", "rigs": RIGS}))
        page.goto(server.url)
        expect(page.get_by_test_id("fleet-dolly")).to_contain_text("stopped")
        for width, height in (SMALL, NARROW_LANDSCAPE, LAPTOP):
            page.set_viewport_size({"width": width, "height": height})
            assert page.evaluate(TOP) == 3 * ["stop-all"]
            assert page.evaluate(WIDER) == []
        page.evaluate(AXE)
        found = page.evaluate("axe.run(document, {resultTypes: ['violations']})")
        assert [(each["id"], [node["html"][:120] for node in each["nodes"]]) for each in found["violations"]] == []
    finally:
        browser.close()


@pytest.mark.parametrize("tab", TABS)
def test_every_control_is_in_reach_of_the_keyboard(staged, tab):
    page = staged(tab)
    wanted = page.locator(CONTROLS).count()
    page.locator("body").click(position={"x": 2, "y": 2})
    seen = set()
    for _ in range(3 * wanted):
        page.keyboard.press("Tab")
        seen.add(page.evaluate(FOCUSED))
        if len(seen - {None}) == wanted:
            break
    assert len(seen - {None}) == wanted


def test_nothing_moves_by_itself_for_who_wants_less_motion(visit, rig):
    rig.more["recording"] = True
    page = visit(reduced_motion="reduce")
    expect(page.locator(".chip.rec")).to_be_visible()
    assert page.locator(".chip.rec .dot").evaluate("(each) => getComputedStyle(each).animationName") == "none"


def test_the_page_is_small_and_loads_nothing_from_elsewhere(visit, server, record_property):
    page = visit()
    expect(page.get_by_test_id("age")).not_to_have_text("--")
    painted = page.evaluate("performance.getEntriesByName('first-contentful-paint')[0].startTime")
    loaded = page.evaluate("performance.getEntriesByType('resource').map((each) => [each.name, each.encodedBodySize])")
    record_property("first_paint_ms", painted)  # under 1 s is asked for, on an idle machine
    assert painted > 0
    assert all(name.startswith((server.url, server.url.replace("http", "ws"))) for name, _ in loaded)
    assert sum(size for _, size in loaded) < 300_000


def test_the_page_can_be_installed(visit, server):
    page = visit()
    manifest = page.evaluate("fetch('manifest.webmanifest').then((each) => each.json())")
    assert (manifest["display"], manifest["name"]) == ("standalone", "teleop console")
    assert re.fullmatch(r"[\w.]+\.svg", manifest["icons"][0]["src"])
