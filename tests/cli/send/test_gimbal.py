"""Every command that can be typed reaches a simulated gimbal as real frames, and what it says comes back in words."""

from __future__ import annotations

import json
import re
import signal
import threading
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest
from command import running, teleop
from network import own_network
from waiting import DEADLINE, wait_until

from teleop.cli import run
from teleop.cli.send.gimbal import ask, asked_for, default_retries
from teleop.cli.sim import serve
from teleop.core.clock import SystemClock, VirtualClock
from teleop.core.errors import DeviceError
from teleop.dji.command_parser import help_of
from teleop.dji.frame import Frame, FrameReader
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.command_table import COMMANDS, PLAIN
from teleop.links import open_link, open_listener
from teleop.sim.gimbal.device import SimulatedGimbal
from teleop.sim.link import SimLink

FIELDS = {
    "gimbal position": "yaw=10 roll=0 pitch=-5.5 time_for_action=0.1",
    "gimbal speed": "yaw=10 roll=0 pitch=0",
    "gimbal angles": "kind=joint",
    "gimbal set limits": "pitch_max=10 pitch_min=11 yaw_max=12 yaw_min=13 roll_max=14 roll_min=15",
    "gimbal set stiffness": "pitch=1 roll=2 yaw=3",
    "gimbal push settings": "switch=on",
    "gimbal version push": "version=01.02.03.04",
    "gimbal joystick": "pitch=15000 roll=-15000 yaw=0",
    "gimbal dial": "speed=-2048",
    "gimbal parameters": "ids=motor",
    "gimbal set parameters": "parameters=motor:00",
    "gimbal orientation": "orientation=portrait",
    "gimbal mode": "mode=sport",
    "focus set": "position=4095",
    "focus calibrate": "action=auto",
    "camera command": "command=record",
    "camera short command": "command=record",
}
"""Of the commands that need some, or whose defaults would prove little."""

DOES: dict[str, Callable[[SimulatedGimbal], bool]] = {
    "gimbal position yaw=10 roll=0 pitch=-5 time_for_action=0.1": lambda far: far.angles.yaw == pytest.approx(10),
    "gimbal speed yaw=10 roll=0 pitch=0": lambda far: far.controlled and far.rates.yaw > 0,
    "gimbal speed yaw=0 roll=0 pitch=0 take_over=false": lambda far: not far.controlled,
    "joystick pitch=0 roll=0 yaw=15000": lambda far: far.rates.yaw > 0,
    "selfie": lambda far: far.angles.yaw > 0,
    "recenter": lambda far: far.counts["gimbal.mode"] == 1,
    "follow lock": lambda far: far.follow == gimbal.FollowMode.LOCK,
    "follow yaw": lambda far: far.follow == gimbal.FollowMode.YAW,
    "follow sport": lambda far: far.follow == gimbal.FollowMode.SPORT,
    "set stiffness pitch=1 roll=2 yaw=3": lambda far: far.settings.stiffness == {"pitch": 1, "yaw": 3, "roll": 2},
    "record": lambda far: far.recording,
    "stop": lambda far: far.counts["camera.command"] == 1,
    "shutter": lambda far: far.shutter_count == 1,
    "focus set position=4095": lambda far: far.focus > 0,
    "focus calibrate": lambda far: far.focus > 0,
}


@contextmanager
def far_gimbal() -> Iterator[tuple[SimulatedGimbal, str]]:
    """A simulated gimbal at the far end of a CAN bus in this process, and the option that names the bus."""
    far, clock, stop, url = SimulatedGimbal(), SystemClock(), threading.Event(), f"virtual:{uuid.uuid4()}"
    link = open_link(url, host=False, now=clock.now)
    thread = threading.Thread(target=serve, args=({"gimbal": link}, {"gimbal": far}, clock, stop))
    thread.start()
    try:
        yield far, f"--link=gimbal={url}"
    finally:
        stop.set()
        thread.join()
        link.close()


@contextmanager
def silent_bus() -> Iterator[tuple[Callable[[], list[Frame]], str]]:
    """A bus on which nobody answers: what has been sent on it, and the option that names it."""
    url = f"virtual:{uuid.uuid4()}"
    listener, reader = open_listener(url, now=lambda: 0.0), FrameReader()

    def sent() -> list[Frame]:
        found = reader.feed(b"".join(data for _, data in listener.receive()), 0.0)
        return [each for each in found if isinstance(each, Frame)]

    yield sent, f"--link=gimbal={url}"
    listener.close()


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_is_obeyed(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    message = COMMANDS[name].name
    with far_gimbal() as (far, link):
        assert run(["send", *name.split(), *FIELDS.get(name, "").split(), link]) == 0
        wait_until(lambda: far.counts[message] == 1)
    assert re.match(f"{message}: (ok|sent; this command has no reply)\n", capsys.readouterr().out)


@pytest.mark.parametrize("name", sorted(PLAIN.keys() - {"focus calibrate manual"}))
def test_every_plain_word_is_obeyed(name: str) -> None:
    with far_gimbal() as (far, link):
        assert run(["send", *name.split(), link]) == 0
        assert far.counts[PLAIN[name].name] == 1


@pytest.mark.parametrize("words", DOES)
def test_what_a_command_does(words: str) -> None:
    with far_gimbal() as (far, link):
        assert run(["send", *words.split(), link]) == 0
        wait_until(lambda: DOES[words](far), words)


@pytest.mark.parametrize(
    ("words", "printed"),
    [
        ("angles", "gimbal.angles: ok\n  kind   attitude\n  yaw    0 deg\n  roll   0 deg\n  pitch  0 deg\n"),
        ("stiffness", "gimbal.stiffness: ok\n  pitch  50 %\n  yaw    50 %\n  roll   50 %\n"),
        ("version", "gimbal.version: ok\n  device   1\n  version  02.02.00.07\n"),
        ("parameters ids=motor", "gimbal.parameters: ok\n  parameters  motor:00\n"),
        ("camera status", "camera.status: ok\n  state  idle\n"),
        ("recenter", "gimbal.mode: ok\n"),
        ("gimbal dial speed=0x10", "gimbal.dial: sent; this command has no reply\n"),
    ],
)
def test_replies_are_printed_in_units(words: str, printed: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["send", *words.split()]) == 0
    assert capsys.readouterr() == (printed, "")


def test_json_is_the_line_of_decode(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["send", "focus", "get", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {
        "message": "focus.get",
        "reply": True,
        "cmd_type": 32,
        "sequence": 0,
        "fields": {"return_code": "ok", "motor": 0, "calibration": "calibrated", "position": 0},
    }
    assert run(["send", "focus", "set", "position=7", "--json"]) == 0
    sent = json.loads(capsys.readouterr().out)
    assert (sent["message"], sent["reply"], sent["fields"]) == ("focus.set", False, {"control": 0, "position": 7})


def test_speed_control_that_was_taken_over_is_said_to_be(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["send", "speed", "yaw=1", "roll=0", "pitch=0"]) == 0
    hint = capsys.readouterr().err
    assert hint.startswith("speed control stays taken over; to release it: teleop send gimbal speed")
    assert run(hint.split("teleop ")[1].split()) == 0
    assert capsys.readouterr().err == ""


def test_axes_that_are_not_named_are_ignored_on_the_wire(capsys: pytest.CaptureFixture[str]) -> None:
    """V2.5 section 2.3.4.1: bits 1, 2, 3 of the ctrl byte have yaw, roll, pitch ignored."""
    with silent_bus() as (sent, link):
        run(["send", "gimbal", "position", "yaw=10", "--retries", "0", link])
        [frame] = sent()
    assert frame.data == bytes.fromhex("0e00 6400 0000 0000 0d 14".replace(" ", ""))
    capsys.readouterr()
    with far_gimbal() as (far, link):
        assert run(["send", "gimbal", "position", "pitch=-5", "roll=3", "time_for_action=0.1", link]) == 0
        wait_until(lambda: far.angles == (0, 3, -5), "roll and pitch")
        assert run(["send", "gimbal", "position", "yaw=10", "time_for_action=0.1", link]) == 0
        wait_until(lambda: far.angles == (10, 3, -5), "yaw alone")
    assert capsys.readouterr().err == ""


def test_a_speed_has_no_such_bit_and_it_is_said_what_was_sent(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["send", "joystick", "yaw=1"]) == 0
    assert capsys.readouterr().err == "gimbal.joystick: roll and pitch not named: sent as 0\n"
    assert run(["send", "speed", "yaw=1", "take_over=false"]) == 0
    assert capsys.readouterr().err == "gimbal.speed: roll and pitch not named: sent as 0\n"


def test_a_refusal_is_a_failure_of_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    with far_gimbal() as (_, link):
        assert run(["send", "set_parameters", "parameters=motor:01", link]) == 0
        capsys.readouterr()
        assert run(["send", "recenter", link]) == 1
        assert capsys.readouterr() == ("", "teleop: gimbal.mode was refused: return code failed\n")
        assert run(["send", "recenter", link, "--json"]) == 1
        printed = capsys.readouterr()
        assert json.loads(printed.out)["fields"] == {"return_code": "failed"}
        assert printed.err.count("\n") == 1


def test_a_reply_that_says_no_with_a_return_code_of_ok_is_a_refusal(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["send", "focus", "calibrate", "manual"]) == 1
    assert capsys.readouterr() == ("", "teleop: focus.calibrate was refused: it failed\n")


@pytest.mark.parametrize(
    ("arguments", "times"),
    [
        (["angles"], 3),
        (["angles", "--retries", "0"], 1),
        (["shutter"], 1),
        (["shutter", "--retries", "1"], 2),
        (["track"], 1),
    ],
)
def test_nobody_there_is_a_failure_of_one_line(
    arguments: list[str], times: int, capsys: pytest.CaptureFixture[str]
) -> None:
    with silent_bus() as (sent, link):
        assert run(["send", *arguments, link]) == 1
        assert len(sent()) == times
    printed = capsys.readouterr()
    assert printed.out == ""
    often = f", asked {times} times" if times > 1 else ""
    assert re.fullmatch(
        rf"teleop: virtual:\S+: no reply to \S+ within 100 ms{often}: is it on, is the cable in\?\n", printed.err
    )


@pytest.mark.parametrize(
    ("words", "retries"),
    [
        ("gimbal position yaw=1 roll=0 pitch=0", 2),
        ("gimbal position yaw=1 roll=0 pitch=0 absolute=false", 0),
        ("orientation portrait", 2),
        ("orientation toggle", 0),
        ("gimbal calibrate", 0),
        ("gimbal calibrate stop", 2),
        ("track", 0),
        ("shutter", 0),
        ("stop shutter", 2),
        ("record", 2),
        ("camera short command command=shutter", 0),
        ("focus calibrate", 0),
        ("focus calibrate stop", 2),
        ("limits", 2),
    ],
)
def test_what_must_not_be_done_twice_is_not_sent_twice(words: str, retries: int) -> None:
    assert default_retries(asked_for(words.split())) == retries


class LossyLink(SimLink):
    """Loses the first `losses` frames."""

    def __init__(self, losses: int, clock: VirtualClock) -> None:
        super().__init__(SimulatedGimbal(), clock.now)
        self._losses = losses

    def send(self, data: bytes) -> None:
        self._losses -= 1
        if self._losses < 0:
            super().send(data)


def test_a_question_that_was_lost_is_asked_again_after_100_ms() -> None:
    clock = VirtualClock()
    record = ask(LossyLink(2, clock), "sim:", gimbal.Version(), clock, tries=3)
    assert record["sequence"] == 2
    assert 0.2 < clock.now() < 0.21
    with pytest.raises(DeviceError, match=r"no reply to gimbal\.version within 100 ms, asked 2 times"):
        ask(LossyLink(2, clock), "sim:", gimbal.Version(), clock, tries=2)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "name a command; teleop send --help lists all"),
        (["recentre"], "unknown command recentre; did you mean recenter?"),
        (["gimbal", "position", "yaw=400", "roll=0", "pitch=0"], "gimbal.position: yaw must be -180..180 deg, not 400"),
        (["focus", "set", "position=x"], "focus.set: position must be 0..4095, not 'x'"),
        (["gimbal", "mode"], "gimbal.mode: give either a mode (lock, yaw, sport) or an action (recenter, selfie)"),
        (["gimbal", "speed"], "gimbal.speed: yaw, roll, pitch missing"),
        (["speed", "yam=1"], "gimbal.speed: no field 'yam', did you mean 'yaw'?"),
        (["recenter", "--retries", "-1"], 'teleop: Invalid value "-1" for --retries. Must be >= 0.'),
        (["xyzzy", "--help"], "no command begins with 'xyzzy'; teleop send --help lists everything"),
    ],
)
def test_what_cannot_be_sent_is_said_before_a_port_opens(
    arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["send", *arguments, "--link", "gimbal=slcan:/dev/nothing-here"]) == 2
    assert capsys.readouterr() == ("", said + "\n")


def test_a_rig_without_the_device_says_so(tmp_path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "rig.yaml").write_text(
        "name: Bare\nlinks: {can: 'sim:'}\naxes: {pan: {min: -1, max: 1, velocity: 1, acceleration: 1, jerk: 1}}\n"
        "sinks: [{type: gimbal, link: can, mode: position, rate: 50}]\n"
    )
    rig = ["--rig", str(tmp_path / "rig.yaml")]
    assert run(["send", "angles", *rig]) == 0
    capsys.readouterr()
    assert run(["send", "shutter", *rig]) == 2
    assert capsys.readouterr().err == "Bare has no camera: its sinks are gimbal\n"


def helped(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    assert run(["send", *words, "--help"]) == 0
    return capsys.readouterr().out


def test_help_lists_every_command_with_fields_units_and_ranges(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    page = helped(capsys)
    assert max(map(len, page.splitlines())) <= 80
    assert page.startswith("Usage: teleop send")
    flat = " ".join(page.split())
    for name in PLAIN:
        assert name.partition(" ")[2] in flat
    for name, command in COMMANDS.items():
        assert re.search(rf"^{name}(,|$)", page, re.MULTILINE)
        assert " ".join((command.__doc__ or "").split()) in flat
        for field, requirement, default in help_of(command):
            assert f" {field} {requirement}{'' if default is None else f' [default: {default}]'}" in flat


@pytest.mark.parametrize(
    ("words", "headings"),
    [
        (["focus"], ["focus: plain words", "focus set, sent once without a reply", "focus calibrate", "focus get"]),
        (["gimbal", "position"], ["gimbal position"]),
        (["position", "yaw=3"], ["gimbal position"]),
        (["follow"], ["gimbal: plain words"]),
    ],
)
def test_help_on_a_part(words: list[str], headings: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    _, _, catalogue = helped(capsys, *words).rpartition("╯\n")
    assert [line for line in catalogue.splitlines() if line and not line.startswith(" ")] == headings


def test_a_command_to_another_process_over_a_real_bus() -> None:
    with own_network("link set lo up", "route add 239.0.0.0/8 dev lo"):
        bus = "gimbal=udp_multicast:239.74.163.2"
        with running("sim", "--link", bus) as far:
            assert far.stdout is not None
            far.stdout.readline()
            turned = teleop("send", "gimbal", "position", "yaw=10", "roll=0", "pitch=-5", "--link", bus)
            assert (turned.returncode, turned.stdout, turned.stderr) == (0, "gimbal.position: ok\n", "")
            where = teleop("send", "angles", "--link", bus, "--json")
            assert json.loads(where.stdout)["fields"]["yaw"] > 0
            far.send_signal(signal.SIGINT)
            far.communicate(timeout=DEADLINE)
        gone = teleop("send", "angles", "--link", bus)
        assert (gone.returncode, gone.stdout, gone.stderr.count("\n")) == (1, "", 1)
