"""What can be sent to a drone from a shell reaches a simulated one as real frames; what must not be sent does not."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from far_drone import BAUD, far_drone
from waiting import wait_until

from teleop.cli import run
from teleop.cli.send.drone import Exchange, asked_for, readable, refusal
from teleop.config.documents.document import DocumentError
from teleop.core.clock import VirtualClock
from teleop.core.errors import DeviceError
from teleop.dji.drone import messages as drone
from teleop.dji.drone.command_table import COMMANDS, PLAIN, hazard, never
from teleop.dji.drone.encryption import Cipher
from teleop.dji.drone.enums import ActivationCode, ArmOrder, ControlCode, ControlOrder, TaskKind
from teleop.dji.drone.session import OnboardSession
from teleop.dji.frame import Frame
from teleop.dji.message import Opaque

APP_ID = 1030093
SECRETS = (str(APP_ID), f"{APP_ID:x}", APP_ID.to_bytes(4, "little").hex(), "5ec2e7" * 10)
MOVE = "move stable=true frame=body yaw_control=rate vertical=velocity horizontal=velocity x=1 y=0 z=0 yaw=0"


@pytest.fixture(autouse=True)
def no_credentials(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in ("TELEOP_DJI_APP_ID", "TELEOP_DJI_APP_KEY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))


def send(words: str, url: str, *options: str) -> int:
    return run(["send", "drone", *words.split(), "--rig", "m100", "--link", f"drone={url}", *options])


def test_a_session_from_the_shell(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TELEOP_DJI_APP_ID", str(APP_ID))
    with far_drone() as (far, url):
        assert send("version", url) == 0
        assert capsys.readouterr().out == (
            "drone.version: not_activated\n"
            "  checksum  0xA6453AAC\n  id        041D492163\n  version   SDK-v1.0 BETA M100-03.01.01.00\n"
        )
        assert send("frequency control=hz_50", url) == 0
        capsys.readouterr()
        assert send("release control", url) == 1
        assert capsys.readouterr().err == (
            "teleop: drone.control was refused: not_activated: teleop send drone activate comes first\n"
        )
        assert send("activate", url) == 0
        assert capsys.readouterr() == ("drone.activate: ok\n", "")
        assert send("frequency control=hz_50", url) == 0
        assert send("obtain control", url, "--i-understand") == 0
        assert send("arm", url, "--i-understand") == 0
        assert send("arm", url, "--i-understand") == 0  # which it is
        assert capsys.readouterr().out.endswith("drone.control: obtained\ndrone.arm: ok\ndrone.arm: already\n")
        assert send("take off", url, "--i-understand") == 1
        assert "take-off also the motors off" in capsys.readouterr().err
        assert send("disarm", url, "--i-understand") == 0
        assert send("take off", url, "--i-understand") == 0
        wait_until(lambda: far.autopilot.flight.airborne, "flight")
        assert send("disarm", url, "--i-understand") == 1
        assert send("land", url, "--i-understand", "--json") == 0
        assert json.loads(capsys.readouterr().out.splitlines()[-1])["fields"] == {"code": "started"}
        assert send("release control", url) == 0
        assert send(MOVE, url, "--i-understand") == 0
        assert capsys.readouterr().out.endswith("drone.move: sent once, it is never acknowledged\n")
        wait_until(lambda: far.counts["drone.move"] == 1, "the movement")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("arm", "drone.arm: it starts the motors; to send it all the same, give --i-understand"),
        ("arm order=disarm", "drone.arm: it stops the motors; to send it all the same, give --i-understand"),
        ("take off", "drone.task: the drone flies without an operator; to send it all the same, give --"),
        ("return home", "drone.task: the drone flies"),
        ("land", "drone.task: the drone flies"),
        (MOVE, "drone.move: the drone flies"),
        ("obtain control", "drone.control: it takes the drone from its pilot"),
        ("virtual rc off", "drone.virtual_rc: it takes the drone from whatever flies it by virtual RC"),
        ("virtual_rc on=true --i-understand", "drone.virtual_rc is not sent by itself: virtual RC without a stream"),
        ("sticks --i-understand", "drone.sticks is not sent by itself: sticks fly on for 1 s without an operator"),
        ("sticks throttle=1684 --i-understand", "drone.sticks is not sent by itself"),
        ("activate app_id=5", "drone activate takes no fields"),
        ("activate", "the drone needs the app id that DJI gave you: in TELEOP_DJI_APP_ID, or app_id in "),
        ("", "name a command for the drone; teleop send drone --help lists all"),
        ("tkae off", "unknown command drone tkae off; did you mean drone take off?"),
        ("event event=control_lost", "unknown command drone event"),
        ("broadcast", "unknown command drone broadcast"),
        ("frequency control=hz_51", "drone.frequency: control must be one of off, hz_1, hz_10, hz_50, hz_100, hold"),
        ("version --retries 2", "--retries is for the gimbal"),
        (MOVE.replace("x=1", "x=11") + " --i-understand", "drone.move: x must be -10..10 m/s, not 11"),
    ],
)
def test_what_is_not_sent_is_said_before_a_port_opens(
    words: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert send(words, f"serial:/dev/nothing-here@{BAUD}") == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.startswith(said)
    assert printed.err.count("\n") == 1


def test_whatever_can_make_it_fly_is_a_hazard_and_the_rest_is_not() -> None:
    harmless = {
        *("drone version", "drone frequency", "drone gimbal speed", "drone gimbal angle", "drone task result"),
        *("drone photo", "drone start video", "drone stop video", "drone activate", "drone release control"),
    }
    given = {
        "drone control": "order=release",
        "drone task": "task=land",
        "drone arm": "order=arm",
        "drone move": MOVE.partition(" ")[2],
        "drone gimbal speed": "yaw=1 roll=0 pitch=0",
        "drone gimbal angle": "yaw=1 roll=0 pitch=0 duration=1",
        "drone virtual rc": "on=true",
    }
    for name in (*COMMANDS, *PLAIN):
        if name in ("drone virtual rc", "drone sticks"):
            with pytest.raises(DocumentError, match="is not sent by itself"):
                asked_for([*name.split(), *given.get(name, "").split()], understood=True)
            continue
        message = asked_for([*name.split(), *given.get(name, "").split()], understood=True)
        assert not never(message)
        assert bool(hazard(message)) is (name not in harmless and name != "drone control"), name


def test_a_rig_without_a_drone_says_so(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["send", "drone", "version"]) == 2
    assert capsys.readouterr().err == (
        "Simulated rig has no drone: --rig m100 has one, --rig sim-drone a simulated one\n"
    )


def test_what_is_simulated_is_activated_for_each_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["send", "drone", "frequency", "control=hz_50", "--rig", "sim-drone"]) == 0
    assert run(["send", "drone", "take", "off", "--rig", "sim-drone"]) == 1
    assert "failed: a task needs control" in capsys.readouterr().err


def test_help_has_what_can_be_sent(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["send", "drone", "--help"]) == 0
    page = capsys.readouterr().out
    assert re.search("^drone frequency$", page, re.MULTILINE)
    assert "drone take off" in " ".join(page.split())
    assert "recenter" not in page.partition("╯\n")[2].replace("plain words, as recenter", "")
    assert "drone sticks" not in page
    assert "app_id" not in page


def test_the_app_id_is_on_the_wire_and_in_nothing_that_is_printed(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setenv("TELEOP_DJI_APP_ID", str(APP_ID))
    monkeypatch.setenv("TELEOP_DJI_APP_KEY", "5ec2e7" * 10 + "0000")
    caplog.set_level(0)
    heard = []

    def refuse(message: drone.Activate) -> drone.ActivateAck:
        heard.append(message.app_id)
        return drone.ActivateAck(ActivationCode.REFUSED)

    with far_drone() as (far, url):
        assert send("activate", url, "--debug", "--json") == 0
        monkeypatch.setitem(far._handlers, drone.Activate, refuse)
        assert send("activate", url, "--debug", "--json") == 1
    assert heard == [APP_ID]
    printed = capsys.readouterr()
    assert "drone.activate was refused: refused" in printed.err
    everything = printed.out + printed.err + caplog.text
    assert not [secret for secret in SECRETS if secret in everything]


class SlowDrone:
    """Control changes hands only the third time; everything else is never acknowledged."""

    def __init__(self) -> None:
        self._session = OnboardSession()
        self._said = bytearray()
        self.heard: list[Frame] = []
        self._codes = iter((ControlCode.OBTAINING, ControlCode.OBTAINING, ControlCode.OBTAINED))

    def send(self, data: bytes) -> None:
        for received in self._session.receive(data, 0.0):
            self.heard.append(received.frame)
            if isinstance(received.message, drone.Control):
                self._said += self._session.reply(received.frame, drone.ControlAck(next(self._codes)))

    def receive(self) -> bytes:
        said = bytes(self._said)
        self._said.clear()
        return said


def test_control_that_is_changing_hands_is_asked_for_again() -> None:
    clock, far = VirtualClock(), SlowDrone()
    obtain = drone.Control(ControlOrder.OBTAIN)
    record = Exchange(far, "sim:", clock).ask(obtain)
    assert record["fields"] == {"code": "obtained"}
    assert (len(far.heard), len({frame.sequence for frame in far.heard})) == (3, 3)
    assert 1.0 <= clock.now() < 1.1
    assert refusal(obtain, record) == ""
    assert refusal(drone.Control(ControlOrder.RELEASE), record) == "obtained"


def test_without_an_acknowledgement_it_is_sent_again_byte_for_byte() -> None:
    clock, far = VirtualClock(), SlowDrone()
    with pytest.raises(DeviceError) as raised:
        Exchange(far, "serial:x@1", clock).ask(drone.Version())
    assert str(raised.value).startswith(
        "serial:x@1: no acknowledgement of drone.version within 300 ms, sent 3 times: is it on, is the cable in, is"
    )
    assert (len(far.heard), len(set(far.heard))) == (3, 1)
    with pytest.raises(DeviceError, match=r"no acknowledgement of drone\.arm within 100 ms: is it on"):
        Exchange(far, "serial:x@1", clock).ask(drone.Arm(ArmOrder.ARM))


class FarEnd:
    """Answers every request with these bytes, and keeps what it understood."""

    def __init__(self, value: bytes, cipher: Cipher | None = None) -> None:
        self._session, self._value, self._said = OnboardSession(cipher=cipher), value, bytearray()
        self.heard: list[Frame] = []

    def send(self, data: bytes) -> None:
        for received in self._session.receive(data, 0.0):
            self.heard.append(received.frame)
            self._said += self._session.reply(received.frame, Opaque(b"", self._value))

    def receive(self) -> bytes:
        said = bytes(self._said)
        self._said.clear()
        return said


@pytest.mark.parametrize(
    ("value", "code", "refused"),
    [
        ("0200", "started", ""),
        ("0100", "failed", "failed: a task needs control"),
        ("0000", 0, "0"),
        ("0500", 5, "5"),
        ("02ff", "no_rights", "no_rights: "),
    ],
)
def test_a_task_has_started_only_by_answer_2(value: str, code: object, refused: str) -> None:
    take_off = drone.Task(TaskKind.TAKE_OFF)
    record = Exchange(FarEnd(bytes.fromhex(value)), "sim:", VirtualClock()).ask(take_off)
    assert record["fields"] == {"code": code}
    assert refusal(take_off, record).startswith(refused)
    assert bool(refusal(take_off, record)) is bool(refused)


def test_a_real_matrice_100_is_shown_as_it_says_it_is() -> None:
    value = bytes.fromhex("01ff ac3a45a6") + b"041D492163\0" + b"SDK-v1.0 BETA M100-03.01.01.00".ljust(32, b"\0")
    record = Exchange(FarEnd(value), "sim:", VirtualClock()).ask(drone.Version())
    assert refusal(drone.Version(), record) == ""
    assert list(readable("drone.version", record)) == [
        "drone.version: not_activated",
        "  checksum  0xA6453AAC",
        "  id        041D492163",
        "  version   SDK-v1.0 BETA M100-03.01.01.00",
    ]


def test_an_encrypted_link_is_encrypted_but_for_what_comes_before_activation() -> None:
    cipher = Cipher(bytes(range(32)))
    far = FarEnd(b"\2\0", cipher)
    exchange = Exchange(far, "sim:", VirtualClock(), cipher)
    exchange.ask(drone.Activate(1))
    assert exchange.ask(drone.Task(TaskKind.LAND))["fields"] == {"code": "started"}
    assert exchange.stream(drone.Photo())["message"] == "drone.photo"
    assert [frame.is_encrypted for frame in far.heard] == [False, True, True]


def test_an_encrypted_rig_without_a_key_sends_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (Path(__file__).parents[3] / "profiles" / "m100.yaml").read_text()
    (tmp_path / "rig.yaml").write_text(text.replace("{type: virtual-rc,", "{type: virtual-rc, encrypted: true,"))
    assert run(["send", "drone", "version", "--rig", str(tmp_path / "rig.yaml")]) == 2
    assert "encrypted: true needs the app's key: in TELEOP_DJI_APP_KEY" in capsys.readouterr().err


def test_an_acknowledgement_of_nothing_known_is_a_refusal() -> None:
    record = {"message": "drone.task", "reply": True, "fields": {"value": "00"}}
    assert refusal(drone.Task(TaskKind.LAND), record) == "an acknowledgement of unknown meaning"
