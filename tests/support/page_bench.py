"""The console's page in real Chromium: a server in a thread of its own, one browser, and pages of many sizes."""

from __future__ import annotations

import asyncio
import re
import shutil
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Self

from console_rig import ConsoleRig
from playwright.sync_api import Browser, BrowserContext, Page, expect, sync_playwright
from priorities import browser_gives_way

from teleop.console.server import serve
from teleop.console.settings import ConsoleSettings, listen

REFUSED = re.compile(r"error: (Failed to load resource|WebSocket connection to)")
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
LAPTOP, PHONE, LANDSCAPE, SMALL, LARGE = (1280, 800), (390, 844), (844, 390), (360, 640), (3840, 2160)
NARROW, NARROW_LANDSCAPE = (360, 740), (740, 360)
PATIENCE = 20_000  # ms: a busy machine is slow, and no test asserts on its speed
expect.set_options(timeout=PATIENCE)


class PageServer:
    """A console in this process, on a `ConsoleRig` unless another door is given."""

    def __init__(self, folder: Path, **settings: Any) -> None:
        self.rig = ConsoleRig()
        (folder / "moves").mkdir(parents=True, exist_ok=True)
        (folder / "takes").mkdir(exist_ok=True)
        self.moves, self.takes = folder / "moves", folder / "takes"
        wanted = ConsoleSettings(port=0, moves=str(self.moves), takes=str(self.takes), **settings)
        self._listener, self.settings = listen(wanted)
        self.url = f"http://127.0.0.1:{self.settings.port}/"
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._run, name="console", daemon=True)

    def _run(self) -> None:
        self._loop.run_until_complete(self._serve())

    async def _serve(self) -> None:
        self._ended = asyncio.Event()
        rig = asyncio.create_task(self.rig.run())
        console = asyncio.create_task(serve(self.settings, self.rig, self._listener))
        await self._ended.wait()
        for task in (console, rig):
            task.cancel()
        await asyncio.gather(console, rig, return_exceptions=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._loop.call_soon_threadsafe(lambda: self._ended.set())
        self._thread.join(10)

    def anew(self) -> ConsoleRig:
        """The rig as it was at first, with no command and no stick yet."""
        self.rig.__dict__ = ConsoleRig().__dict__  # at once: its task goes on meanwhile
        return self.rig


class Chrome:
    """A browser. `errors` are those of all pages since they were last looked at, and all that stands in their consoles.

    `allowed` is a pattern of what a test has to cause: Chromium writes down each request that is refused.
    """

    def __init__(self, browser: Browser) -> None:
        self._browser = browser
        self._contexts: list[BrowserContext] = []
        self.errors: list[str] = []
        self.allowed: re.Pattern[str] | None = None

    def open(self, url: str, size: tuple[int, int] = LAPTOP, touch: bool = False, **options: Any) -> Page:
        """A page of its own, as another person's browser: cookies and storage are not shared."""
        context = self._browser.new_context(
            viewport={"width": size[0], "height": size[1]}, has_touch=touch, is_mobile=touch, **options
        )
        context.set_default_timeout(PATIENCE)
        self._contexts.append(context)
        page = context.new_page()
        page.on("pageerror", lambda error: self._note(str(error)))
        page.on("console", lambda message: self._note(f"{message.type}: {message.text}"))
        page.goto(url)
        return page

    def _note(self, text: str) -> None:
        if text.endswith("WebSocket is closed before the connection is established."):
            return  # a computer that is too busy to connect within 1 s: the page tries again
        if self.allowed is None or not self.allowed.match(text):
            self.errors.append(text)

    def close(self) -> None:
        while self._contexts:
            self._contexts.pop().close()


@contextmanager
def chrome() -> Iterator[Chrome]:
    with sync_playwright() as playwright:
        options = ["--no-sandbox", "--disable-gpu", "--force-color-profile=srgb", "--font-render-hinting=none"]
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=options)
        browser_gives_way()
        try:
            yield Chrome(browser)
        finally:
            browser.close()


def until(what: Callable[[], Any], seconds: float = 20.0) -> Any:
    """What `what` returns once that is true. For conditions in this process, not in a page."""
    end = time.monotonic() + seconds
    while not (found := what()):
        assert time.monotonic() < end, f"{what} did not come true"
        time.sleep(0.01)
    return found


def take_control(page: Page) -> None:
    page.get_by_test_id("take-control").click()
    page.get_by_test_id("release-control").wait_for()
