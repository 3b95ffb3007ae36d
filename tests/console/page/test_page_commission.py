"""A commissioning in a real browser, seen from the gimbal's side of the bus; and its page, for eyes and thumbs."""

from __future__ import annotations

import json
import os
import signal
import urllib.error
from contextlib import ExitStack

import pytest
from far_gimbal import far_gimbal
from page_bench import PHONE, until
from playwright.sync_api import expect
from real_commission import RealCommission, click

from teleop.config.profile import load_profile
from teleop.config.sinks_section import GimbalSection

URL = "udp_multicast:239.74.163.67"
STALLED = "the computer stalled"


@pytest.fixture(scope="module")
def console(tmp_path_factory):
    with far_gimbal(URL) as far, ExitStack() as stack:
        made = stack.enter_context(RealCommission(tmp_path_factory.mktemp("commission"), URL, far))
        made.ready()
        yield made


@pytest.fixture
def visit(browser, console):
    browser.errors.clear()
    yield lambda *args, at="", **options: browser.open(console.url + at, *args, **options)
    browser.close()
    assert browser.errors == []
    until(lambda: console.state.get("holder") is None)


def go_of(page):
    """The button of the page that waits for Enter; a stall may have ended the way to it by now."""
    go = page.get_by_test_id("commission-go")
    expect(go.or_(page.get_by_test_id("commission-repeat"))).to_be_visible()
    assert go.count(), STALLED
    return go


@pytest.fixture
def moving(visit, console):
    """Anna's page, which has let pan go."""
    console.again()
    page = visit(at="?name=anna")
    go = go_of(page)
    console.began = console.far.angles.yaw
    go.click()
    until(lambda: abs(console.far.rates.yaw) > 0.5)
    return page


def ends(console, why, else_asks="it moved to its end"):
    """With `why` as its trouble; `else_asks` is what is wrong when it has moved to its end, and asks."""
    until(lambda: console.shown["stage"] in ("shown", "asking"))
    assert console.shown["stage"] == "shown", else_asks
    trouble = console.shown["trouble"]
    assert console.wire_rests
    stalled = STALLED in trouble or "does not answer" in trouble  # and the gimbal is simulated in this process
    assert why.lower() in trouble.lower(), STALLED if stalled else trouble


def test_stop_of_a_watcher_stops_what_another_moves(moving, visit, console):
    watcher = visit(PHONE, touch=True, at="?name=bob")
    expect(watcher.get_by_test_id("commission-progress")).to_be_visible()
    watcher.get_by_test_id("stop").tap()
    ends(console, "STOPPED by bob")
    expect(moving.get_by_test_id("commission-trouble")).to_have_text("STOPPED by bob")
    expect(watcher.get_by_test_id("commission-repeat")).to_be_disabled()
    moving.get_by_test_id("commission-repeat").click()
    console.at("prompt", "position-pan")


HIDDEN = """Object.defineProperty(document, "hidden", {value: true});
document.dispatchEvent(new Event("visibilitychange"));"""
HANGS = "() => void setTimeout(() => { const end = Date.now() + 4000; while (Date.now() < end); }, 0)"


def test_a_page_that_nobody_sees_moves_nothing(visit, console):
    console.again()
    page = visit(at="?name=anna")
    go = go_of(page)
    page.evaluate(HIDDEN)  # as by a hand that presses Go and then another app
    go.click()
    ends(console, "STOPPED by anna")


@pytest.mark.parametrize(
    ("lose", "why"),
    [
        (lambda page, _: page.evaluate(HIDDEN), "STOPPED by anna"),
        (lambda page, _: page.close(), "stopped"),
        (lambda page, _: page.evaluate(HANGS), "is gone"),
        (lambda _, console: os.kill(console.gateway, signal.SIGKILL), "is gone"),
        (lambda _, console: os.kill(console.gateway, signal.SIGSTOP), "is gone"),
    ],
    ids=["hidden", "closed", "hanging", "gateway killed", "gateway stopped"],
)
def test_a_step_ends_with_the_page_that_let_it_go(moving, console, lose, why):
    gateway = console.gateway
    try:
        lose(moving, console)
        until(lambda: console.wire_rests)
    finally:
        if os.path.exists(f"/proc/{gateway}"):
            os.kill(gateway, signal.SIGCONT)
    ends(console, why, else_asks=STALLED)  # a busy computer may lose the page only then
    assert abs(console.far.angles.yaw - console.began) < 2.1  # 2 degrees, as the page says


def test_enter_for_a_page_that_is_over_is_refused(console):
    until(lambda: console.shown["stage"] in ("prompt", "shown"))
    with pytest.raises(urllib.error.HTTPError) as refused:
        console.request("api/command", {"do": "commission_key", "page": console.shown["page"] - 1, "key": "enter"})
    assert refused.value.code == 409
    assert json.load(refused.value)["kind"] == "stale"


def test_keys_are_the_terminal_s_and_one_that_is_held_counts_once(visit, console):
    console.again()
    page = visit()
    expect(go_of(page)).to_be_enabled()
    for _ in range(30):
        page.keyboard.down("Enter")  # the second and all later ones repeat
    page.keyboard.up("Enter")
    until(lambda: console.shown["stage"] in ("running", "asking"))
    page.keyboard.press(" ")
    ends(console, "STOPPED")
    page.keyboard.press("r")
    console.at("prompt", "position-pan")
    expect(go_of(page)).to_be_enabled()  # a key counts for the page that is seen
    page.keyboard.press("s")
    console.at("prompt", "position-roll")


def test_a_gimbal_is_commissioned_by_clicks_on_a_phone_to_the_right_profile(browser, tmp_path):
    with RealCommission(tmp_path, "", None, "-o", "mine.yaml", "--report", "results") as console:
        try:
            page = browser.open(console.url, PHONE, touch=True)
            console.at("prompt", "ready")
            click(page, ["go", "choice-y", "go", *["skip"] * 4])
            expect(page.get_by_test_id("commission-title")).to_have_text("Position command: pan")
            page.get_by_test_id("commission-go").click()
            page.get_by_test_id("commission-choice-n").click()
            facts = page.get_by_test_id("commission-facts")
            expect(facts).to_contain_text("Sign of pan in position commands")
            expect(facts.locator(".different").first).to_be_visible()
            click(page, ["abort", "go"])
            expect(page.get_by_test_id("commission-title")).to_have_text("The commissioning is over")
            links = page.get_by_test_id("commission-results").locator("a")
            expect(links).to_have_text(["report.html", "report.json", "capture.log"])
            with page.expect_download() as loaded:
                links.nth(1).click()
            assert loaded.value.suggested_filename == "results-report.json"
            assert loaded.value.path().read_bytes() == (tmp_path / "results/report.json").read_bytes()
            page.get_by_test_id("commission-close").click()
            code, report = console.end()
            expect(page.get_by_test_id("commission-title")).to_have_text("Closed")
        finally:
            browser.close()
    assert (code, report["ok"], report["profile"]) == (0, True, "mine.yaml")
    gimbal = load_profile(str(tmp_path / "mine.yaml")).sinks[0]
    assert isinstance(gimbal, GimbalSection)
    assert gimbal.signs == {"pan": -1}
    assert "# commission: signs.pan -1: the operator saw" in (tmp_path / "mine.yaml").read_text()
