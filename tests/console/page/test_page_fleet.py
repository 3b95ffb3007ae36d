"""The tiles of a fleet: many of them leave the sticks and STOP ALL where they are, and what is wrong comes first."""

from __future__ import annotations

from page_bench import LANDSCAPE, LAPTOP, SMALL
from playwright.sync_api import expect

FLEET = [
    {
        "name": f"cam-{number:02d}",
        "alive": number != 17,
        "state": "lost" if number == 17 else "playing",
        "holder": "anna@desk",
        "move": {"title": "a wide reveal"},
        "error": None,
        "link_age_ms": 20.0,
    }
    for number in range(20)
]
IN_VIEW = """(one) => {
    const box = document.querySelector(one).getBoundingClientRect();
    return box.height > 0 && box.top >= 0 && box.bottom <= innerHeight && box.left >= 0 && box.right <= innerWidth;
}"""


def test_twenty_rigs_leave_the_sticks_and_stop_all_in_view_and_the_lost_one_is_first(visit):
    page = visit(SMALL, True, at="?name=desk#live")
    page.route("**/api/fleet", lambda route: route.fulfill(json={"name": "cam-00", "rigs": FLEET}))
    page.reload()
    tiles = page.locator(".fleet-tile")
    expect(tiles).to_have_count(len(FLEET))
    expect(tiles.first).to_contain_text("cam-17")
    for width, height in (SMALL, LANDSCAPE, LAPTOP):
        page.set_viewport_size({"width": width, "height": height})
        for part in (".stop", ".stop-all", ".fleet-tile", *([".disc"] if width < 1000 else [])):
            page.wait_for_function(IN_VIEW, arg=part)
        assert page.locator(".fleet").bounding_box()["height"] < height / 4
