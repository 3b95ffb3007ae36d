"""`teleop console` as a user starts it: processes of their own, the simulated gimbal's wire inside."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import urllib.request
from functools import cached_property
from pathlib import Path
from typing import IO, Any, Self

from command import TELEOP
from page_bench import until


class RealConsole:
    """The rig, the control process and its gateway. `state` is what /api/state answers."""

    def __init__(
        self, folder: Path, *options: str, rig: str = "sim", errors: IO[bytes] | int = subprocess.DEVNULL
    ) -> None:
        environment = {**os.environ, "XDG_STATE_HOME": str(folder / "state")}
        self.folder = folder
        options = ("--rig", rig, "--bind", "127.0.0.1:0", "--json", "--realtime", *options)
        self._process = subprocess.Popen(
            [TELEOP, "console", *options],
            stdout=subprocess.PIPE,
            stderr=errors,
            cwd=folder,
            env=environment,
        )
        self._reached()

    def _reached(self) -> None:
        assert self._process.stdout is not None
        started = json.loads(self._process.stdout.readline())
        self.token = started["token"]
        self.page = started["url"]
        self.url = started["url"].split("#")[0].removesuffix("login")
        assert self.state

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.send_signal(signal.SIGINT)
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        assert self._process.stdout is not None
        self._process.stdout.close()

    def request(self, path: str, body: dict[str, Any] | None = None) -> Any:
        headers = {"Authorization": f"Bearer {self.token}"} if self.token else {}
        data = None if body is None else json.dumps(body).encode()
        asked = urllib.request.Request(f"{self.url}{path}", data, headers)
        with urllib.request.urlopen(asked, timeout=10) as answer:
            return json.load(answer)

    @property
    def state(self) -> dict[str, Any]:
        """The newest state, once there is a gateway that answers."""
        return until(self._state)

    def _state(self) -> dict[str, Any] | None:
        assert self.lives, self.report
        try:
            return self.request("api/state")
        except OSError:
            return None

    @property
    def lives(self) -> bool:
        return self._process.poll() is None

    @cached_property
    def report(self) -> bytes:
        """What it had to say at its end."""
        assert self._process.stdout is not None
        return self._process.stdout.read()

    @property
    def stalled(self) -> bool:
        """Whether a stall of this computer has ended it."""
        return not self.lives and b"the computer stalled" in self.report

    def axis(self, name: str) -> dict[str, Any]:
        return self.state["axes"][name]

    @property
    def gateway(self) -> int:
        """The process id of the gateway: the control process's child that serves."""
        tasks = Path(f"/proc/{self._process.pid}/task").iterdir()
        children = [int(each) for task in tasks for each in (task / "children").read_text().split()]
        return next(each for each in children if b"teleop.gateway" in Path(f"/proc/{each}/cmdline").read_bytes())

    @property
    def rests(self) -> bool:
        return all(abs(axis["speed"]) < 1e-6 for axis in self.state["axes"].values())
