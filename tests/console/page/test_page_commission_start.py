"""A commissioning that is started from the Live page of `teleop console`, and the rig that is in hand after it."""

from __future__ import annotations

import pytest
from page_bench import REFUSED, take_control, until
from playwright.sync_api import expect
from real_commission import click
from real_console import RealConsole

from teleop.config.profile import load_profile


@pytest.fixture
def console(tmp_path):
    with RealConsole(tmp_path, "-o", "mine.yaml") as console:
        yield console


def test_from_the_live_page_to_a_profile_and_back_with_the_rig_in_hand(browser, console):
    browser.errors.clear()
    browser.allowed = REFUSED  # the gateway is another one in between
    page = browser.open(console.url)
    title = page.get_by_test_id("commission-title")
    try:
        take_control(page)
        page.get_by_test_id("commission-start").click()
        page.get_by_test_id("commission-start-yes").click()
        expect(title).to_have_text("Before anything moves")
        expect(page.get_by_test_id("commission-go")).to_be_enabled()
        click(page, ["go", "choice-y", "abort", "go"])
        expect(title).to_have_text("The commissioning is over")
        page.get_by_test_id("commission-close").click()
        expect(title).to_have_count(0)
        take_control(page)
        until(lambda: console.state["holder"])
        assert any("commissioned: " in each["text"] for each in console.state["messages"])
        assert console.state["commission"] is None
        assert console.state["rig"] == load_profile(str(console.folder / "mine.yaml")).name
        expect(page.get_by_test_id("stick-pan-tilt")).to_have_attribute("aria-disabled", "false")
        page.get_by_test_id("stick-pan-tilt").focus()
        page.keyboard.down("ArrowRight")
        until(lambda: abs(console.axis("pan")["speed"]) > 0.5)
        page.keyboard.up("ArrowRight")
        until(lambda: console.rests)
    finally:
        browser.close()
    assert browser.errors == []
    assert console.lives
