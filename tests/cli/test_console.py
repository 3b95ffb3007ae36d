"""`teleop console` and `--console` as a script uses them: one process, its first line, HTTP, and its end."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any
from urllib.error import HTTPError, URLError
from urllib.request import Request, urlopen

import pytest
from command import running
from waiting import wait_until

from teleop.cli import run
from teleop.cli.console_options import ConsoleOptions, with_console
from teleop.cli.options import Options
from teleop.config.profile import load_profile


def ask(url: str, path: str, body: dict[str, Any] | None = None) -> tuple[int, dict[str, Any]]:
    data = None if body is None else json.dumps(body).encode()
    request = Request(url + path, data, {"content-type": "application/json"})
    try:
        with urlopen(request, timeout=30) as answer:
            return answer.status, json.loads(answer.read())
    except HTTPError as error:
        return error.code, json.loads(error.read())


def reached(process: subprocess.Popen[str]) -> str:
    """The URL of the first line, once the rig runs."""
    assert process.stdout is not None
    url = json.loads(process.stdout.readline())["url"]

    def runs() -> bool:
        try:
            return ask(url, "api/state")[1].get("run") == "running"
        except (URLError, ConnectionError):
            return False

    wait_until(runs, "the rig")
    return url


def test_a_console_moves_the_simulated_rig_and_ends_with_a_signal(tmp_path: Path) -> None:
    with running("console", "--bind", "127.0.0.1:0", "--json", cwd=tmp_path) as process:
        url = reached(process)
        assert url.startswith("http://127.0.0.1:")
        command = {"do": "goto", "axes": {"pan": 3}, "seconds": 0.5, "wait": True}
        assert ask(url, "api/command", command)[1]["ok"]
        state = ask(url, "api/state")[1]
        assert state["axes"]["pan"]["commanded"] == pytest.approx(3)
        assert state["holder"] is None
        assert ask(url, "api/command", {"do": "goto", "axes": {"pan": 999}})[0] == 422
        assert ask(url, "api/stop", {})[0] == 200
        assert ask(url, "api/state")[1]["stopped"]
        assert ask(url, "api/command", {"do": "goto", "axes": {"pan": 0}})[0] == 422
        process.terminate()
        assert process.wait(20) == 130
        assert process.stdout is not None
        assert json.loads(process.stdout.read())["reasons"] == [
            "SIGTERM received",
            "ended while stopped: STOP by HTTP 127.0.0.1",
        ]


def test_a_move_that_plays_with_a_console_is_seen_and_stopped(tmp_path: Path) -> None:
    with running("play", "nudge", "--console", "127.0.0.1:0", "--json", cwd=tmp_path) as process:
        url = reached(process)
        assert ask(url, "api/state")[1]["move"]["title"]
        assert ask(url, "api/stop", {})[0] == 200
        assert ask(url, "api/state")[1]["stopped"]
        assert ask(url, "api/command", {"do": "goto", "axes": {"pan": 0}})[0] == 422
        assert ask(url, "api/command", {"do": "abort"})[0] == 200
        assert process.wait(20) == 130


def test_the_address_of_console_may_be_left_out() -> None:
    assert with_console(["live", "--console"]) == ["live", "--console=127.0.0.1:8470"]
    assert with_console(["play", "--console", "reveal"]) == ["play", "--console=127.0.0.1:8470", "reveal"]
    assert with_console(["play", "reveal", "--console", "0.0.0.0:80"]) == ["play", "reveal", "--console=0.0.0.0:80"]
    assert with_console(["live", "--console", "[::1]:0", "--json"]) == ["live", "--console=[::1]:0", "--json"]
    assert with_console(["live", "--console=:9"]) == ["live", "--console=:9"]


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["live", "--token", "x"], "--token: needs --console"),
        (["play", "reveal", "--fast", "--console"], "--console: a browser is in real time; leave out --fast"),
        (["console", "--moves", "nowhere"], "--moves nowhere: is no folder"),
    ],
)
def test_what_cannot_be_is_refused_with_the_reason(
    arguments: list[str], reason: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(arguments) == 2
    assert reason in capsys.readouterr().err


@pytest.mark.parametrize(("bind", "announced"), [("127.0.0.1:0", False), ("0.0.0.0:0", True)])
def test_only_a_console_that_others_can_reach_is_announced_on_the_network(
    bind: str, announced: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    options, profile = Options(rig="sim"), load_profile("sim")
    with ConsoleOptions().gateway(bind, options, profile) as gateway:
        told = gateway.settings.get("announcement")
        assert (told is not None) == announced
        if told:
            assert (told["rig"], told["host"], told["tls"]) == (profile.name, "0.0.0.0", False)
            assert f":{told['port']}/" in capsys.readouterr().out
