"""Rigs of a fleet as a user starts them, and the operator's commands, in processes of their own."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from threading import Thread
from typing import Any, Self

from command import TELEOP
from waiting import wait_until

from teleop.config.resources import find

STARTING = 60.0  # s for a rig to be there


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class RigProcess:
    """`teleop console` with a zenoh entry. `prefix` is what runs it elsewhere, such as in a network namespace."""

    def __init__(
        self,
        folder: Path,
        name: str,
        entry: str = "",
        prefix: Sequence[str] = (),
        options: Sequence[str] = (),
        link: str = "sim:",
    ) -> None:
        self.name, self.folder = name, folder / name
        self.folder.mkdir(exist_ok=True)
        self.endpoint = "" if entry else f"tcp/127.0.0.1:{free_port()}"
        text = find("sim", "profiles", "rig")[0].read_text(encoding="utf-8").replace('"sim:"', f'"{link}"')
        entry = entry or f"listen: {self.endpoint}"
        rig = self.folder / "rig.yaml"
        rig.write_text(f"{text}\nexchange:\n  - {{type: zenoh, name: {name}, {entry}}}\n", encoding="utf-8")
        self.process = subprocess.Popen(
            [*prefix, TELEOP, "console", "--rig", str(rig), "--bind", "127.0.0.1:0", "--json", "--realtime", *options],
            stdout=subprocess.PIPE,
            stderr=(self.folder / "errors.txt").open("wb"),
            cwd=self.folder,
            env={**os.environ, "XDG_STATE_HOME": str(self.folder / "state")},
        )
        assert self.process.stdout is not None
        self.url = json.loads(self.process.stdout.readline())["url"]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            try:
                self.process.wait(10)
            except subprocess.TimeoutExpired:
                self.kill()
        assert self.process.stdout is not None
        self.process.stdout.close()

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()

    def last_lines(self, count: int = 5) -> list[str]:
        """What it said last: of a run that has ended, why."""
        return (self.folder / "errors.txt").read_text(encoding="utf-8", errors="replace").splitlines()[-count:]

    @property
    def stalled(self) -> bool:
        """Whether a stall of this computer has ended it."""
        if self.process.poll() is None:
            return False
        assert self.process.stdout is not None
        return b"the computer stalled" in self.process.stdout.read()


class FleetCommand:
    """`teleop fleet` of an operator with a state folder of its own."""

    def __init__(
        self, folder: Path, endpoints: Sequence[str], credentials: str = "", prefix: Sequence[str] = ()
    ) -> None:
        self.environment = {**os.environ, "XDG_STATE_HOME": str(folder / "operator")}
        self.prefix, self.folder = prefix, folder
        self.options = [word for endpoint in endpoints for word in ("--connect", endpoint)]
        if credentials:
            self.options += ["--credentials", credentials]

    def run(self, *words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [*self.prefix, TELEOP, "fleet", *words, *self.options],
            capture_output=True,
            text=True,
            env=self.environment,
            cwd=self.folder,
            timeout=110,
            check=False,
        )

    def rigs(self) -> dict[str, dict[str, Any]]:
        done = self.run("--json", "--once")
        assert done.returncode == 0, done.stderr
        return {rig["name"]: rig for rig in json.loads(done.stdout)["rigs"]}


def until_alive(command: FleetCommand, *names: str) -> None:
    """Once every named rig is there."""
    wait_until(lambda: all(command.rigs().get(name, {}).get("alive") for name in names), "rigs that are there")


def side_by_side(start: Callable[[str], RigProcess], names: Sequence[str]) -> list[RigProcess]:
    """All of them at once: a rig takes seconds to start, and most of that it waits."""
    with ThreadPoolExecutor(len(names)) as threads:
        return list(threads.map(start, names))


class JsonProcess:
    """A process that prints lines of JSON; `lines` are those so far."""

    def __init__(self, stack: ExitStack, words: Sequence[str]) -> None:
        self.process = subprocess.Popen(
            words,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            env={**os.environ, "PYTHONPATH": str(Path(__file__).parent)},
        )
        self.lines: list[dict[str, Any]] = []
        self._reader = Thread(target=self._read, daemon=True)
        self._reader.start()
        stack.callback(self.close)

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.lines.append(json.loads(line))

    def say(self, line: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(f"{line}\n")
        self.process.stdin.flush()

    def until(self, holds: Callable[[dict[str, Any]], Any], after: float = 0.0) -> dict[str, Any]:
        """The first line after that moment that holds."""
        found: list[dict[str, Any]] = []

        def look() -> bool:
            found[:] = [line for line in self.lines if line["time"] > after and holds(line)][:1]
            assert found or self.process.poll() is None, self.lines[-3:]
            return bool(found)

        wait_until(look, "a line")
        return found[0]

    def close(self) -> None:
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.close()
        try:
            self.process.wait(5)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self._reader.join()
        self.process.stdout.close()
