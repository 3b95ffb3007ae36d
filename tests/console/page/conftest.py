"""One browser and one server for each file of tests of the page."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from pathlib import Path

import pytest
from page_bench import CHROMIUM, PageServer, chrome

HERE = Path(__file__).parent


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: Sequence[pytest.Item]) -> None:
    """All of them are slow: whichever is the first to need it starts a browser."""
    for item in items:
        if item.path.parent == HERE:
            item.add_marker(pytest.mark.slow)


@pytest.fixture(scope="module")
def browser():
    if CHROMIUM is None:
        pytest.skip("Chromium is not installed")
    with chrome() as browser:
        yield browser


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with PageServer(tmp_path_factory.mktemp("console")) as server:
        yield server


@pytest.fixture
def rig(server):
    return server.anew()


@pytest.fixture
def visit(browser, server, rig):
    """Opens a page on the server; what went wrong in any page fails the test."""
    browser.errors.clear()
    browser.allowed = None
    yield lambda *args, **options: browser.open(server.url + options.pop("at", ""), *args, **options)
    browser.close()
    assert browser.errors == []


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup(item: pytest.Item) -> Generator[None, None, None]:
    yield from _blamed(item)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None, None, None]:
    yield from _blamed(item)


def _blamed(item: pytest.Item) -> Generator[None, None, None]:
    """Whatever was missed on the page of a console that a stall of the computer had ended is that stall's."""
    try:
        yield
    except Exception as error:
        console = getattr(item, "funcargs", {}).get("console")
        if console is not None and console.stalled:
            raise AssertionError("the computer stalled") from error
        raise
