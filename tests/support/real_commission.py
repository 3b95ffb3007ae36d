"""`teleop commission --console` as a user starts it, on a gimbal that is simulated at the other end of a bus."""

from __future__ import annotations

import json
import os
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from command import TELEOP
from far_gimbal import FarGimbal
from page_bench import until
from playwright.sync_api import Page
from real_console import RealConsole

from teleop.commission.runner import AUTOREPEAT

TURNED = """([title, kind]) => {
    const step = document.querySelector(".step");
    return step.querySelector(".title").innerText !== title || step.className !== kind;
}"""
SETTLED = 0.5  # s in which nothing turns


class RealCommission(RealConsole):
    """`far` is the gimbal at the other end of `url`, None for one inside of the program."""

    def __init__(self, folder: Path, url: str, far: FarGimbal | None, *options: str) -> None:
        self.folder, self.far = folder, far
        self.began = 0.0  # deg: where pan was when a step began
        link = ["--link", f"gimbal={url}"] if url else []
        command = [TELEOP, "commission", *link, "--console", "127.0.0.1:0", "--json", *options]
        environment = {**os.environ, "XDG_STATE_HOME": str(folder / "state")}
        self._process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, cwd=folder,
            env=environment,
        )  # fmt: skip
        self._reached()

    @property
    def shown(self) -> dict[str, Any]:
        return self.state["commission"]

    def press(self, key: str, **fields: Any) -> None:
        """On the page as it is now, by HTTP."""
        self.request("api/command", {"do": "commission_key", "page": self.shown["page"], "key": key, **fields})

    def at(self, stage: str, step: str = "") -> None:
        until(lambda: self.shown["stage"] == stage and step in self.shown["key"])

    def ready(self) -> None:
        """To the page of pan's position command, by HTTP; a busy computer may have shown a page of an early step."""
        while self.shown["key"] != "ready" or self.shown["stage"] != "prompt":
            if self.shown["stage"] == "shown":
                self.press("enter" if not self.shown["trouble"] else "r")
            time.sleep(2 * AUTOREPEAT)
        self.press("enter")
        self.at("asking")
        self.press("y")
        self.at("shown")
        time.sleep(2 * AUTOREPEAT)
        self.press("enter")
        for _ in range(4):
            self.at("prompt")
            self.press("s")
        self.at("prompt", "position-pan")

    def again(self) -> None:
        """The page of pan's position command, once more; a stalled computer ends the way back to it too."""
        while (shown := self.shown)["stage"] != "prompt":
            if shown["stage"] == "shown":
                self.press("r")
            time.sleep(2 * AUTOREPEAT)

    def end(self) -> tuple[int, dict[str, Any]]:
        """The exit code, and the report that it printed."""
        code = self._process.wait(20)
        return code, json.loads(self.report)

    @property
    def wire_rests(self) -> bool:
        """Whether the gimbal turns no more, seen from its side of the bus."""
        assert self.far is not None
        before = self.far.angles
        time.sleep(SETTLED)
        return before == self.far.angles and self.far.rates.yaw == 0


def click(page: Page, names: Sequence[str]) -> None:
    """The buttons of one page after the other; each is there once the page before is over."""
    for name in names:
        title = page.get_by_test_id("commission-title")
        before = title.inner_text(), page.locator(".step").get_attribute("class")
        page.get_by_test_id(f"commission-{name}").click()
        page.wait_for_function(
            TURNED,
            arg=list(before),
        )
        page.wait_for_timeout(2000 * AUTOREPEAT)
