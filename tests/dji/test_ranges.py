"""What lies beyond the document's tables is refused on sending, in one line, and carried on receiving."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from teleop.cli import run
from teleop.dji.gimbal import focus
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.session import Session
from teleop.dji.message import FieldError, Message

LIMITS = gimbal.SetLimits(145, 55, 179, 179, 30, 30)
TABLE: list[tuple[Message, str, Any, Any]] = [  # the field, and what is just allowed and just not
    *((gimbal.Position(0, 0, 0), name, *ends) for name, ends in (("yaw", (180.0, 180.1)), ("yaw", (-180.0, -180.1)))),
    *((gimbal.Position(0, 0, 0), name, *ends) for name, ends in (("roll", (30.0, 30.1)), ("roll", (-30.0, -30.1)))),
    *((gimbal.Position(0, 0, 0), name, *ends) for name, ends in (("pitch", (146.0, 146.1)), ("pitch", (-56.0, -56.1)))),
    (gimbal.Position(0, 0, 0, False), "yaw", 180.0, 360.0),
    (gimbal.Position(0, 0, 0), "time_for_action", 0.1, 0.0),
    (gimbal.Position(0, 0, 0), "reserved", 0, 0x10),
    *(
        (gimbal.Speed(0, 0, 0), name, sign * 360.0, sign * 360.1)
        for name in ("yaw", "roll", "pitch")
        for sign in (1, -1)
    ),
    *((gimbal.Joystick(0, 0, 0), name, 15000, 15001) for name in ("yaw", "roll", "pitch")),
    *((gimbal.Joystick(0, 0, 0), name, -15000, -15001) for name in ("yaw", "roll", "pitch")),
    (gimbal.Dial(0), "speed", 2048, 2049),
    (gimbal.Dial(0), "speed", -2048, -2049),
    (LIMITS, "pitch_max", 145, 155),
    (LIMITS, "pitch_min", 55, 56),
    *((LIMITS, name, 179, 180) for name in ("yaw_max", "yaw_min")),
    *((LIMITS, name, 30, 31) for name in ("roll_max", "roll_min")),
    *((gimbal.SetStiffness(0, 0, 0), name, 100, 101) for name in ("pitch", "roll", "yaw")),
    (gimbal.Limits(), "operation", 1, 2),
    (gimbal.PushSettings(1), "switch", 2, 3),
    (gimbal.Angles(), "kind", 2, 3),
    (gimbal.Orient(1), "orientation", 5, 6),
    (gimbal.Calibrate(), "type", 1, 2),
    (gimbal.ActiveTrack(), "track", 3, 0),
    (focus.Set(1), "position", 4095, 4096),
    (focus.Calibrate(action=1), "action", 6, 7),
]


@pytest.mark.parametrize(("message", "name", "allowed", "refused"), TABLE, ids=lambda value: str(value)[:40])
def test_what_the_tables_do_not_have_is_refused_on_sending_and_carried_on_receiving(
    message: Message, name: str, allowed: Any, refused: Any
) -> None:
    inside, outside = (replace(message, **{name: value}) for value in (allowed, refused))
    session = Session()
    session.command(inside)
    for send in (session.command, lambda each: session.request(each, 0.0)):
        with pytest.raises(FieldError, match=f"^{message.name}: {name} must be [^\n]+, not [^\n]+$"):
            send(outside)
    assert type(outside).decode(outside.encode()) == outside


def test_a_time_for_action_never_wraps() -> None:
    Session().command(gimbal.Position(0, 0, 0, time_for_action=25.5))
    with pytest.raises(FieldError, match=r"^gimbal.position: time_for_action must be 0.1..25.5 s, not 25.6$"):
        Session().command(gimbal.Position(0, 0, 0, time_for_action=25.6))


@pytest.mark.parametrize(
    ("words", "wrong"),
    [
        ("gimbal position yaw=180.1 roll=0 pitch=0", "yaw must be -180..180 deg, not 180.1"),
        ("gimbal speed yaw=0 roll=-361 pitch=0", "roll must be -360..360 deg/s, not -361"),
        ("gimbal joystick yaw=0 roll=0 pitch=15001", "pitch must be -15000..15000, not 15001"),
        ("gimbal dial speed=-2049", "speed must be -2048..2048, not -2049"),
        ("focus set position=4096", "position must be 0..4095, not 4096"),
    ],
)
def test_a_shell_gets_one_line_before_a_port_is_opened(
    words: str, wrong: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["send", *words.split(), "--link", "gimbal=serial:/dev/no-such-port@9600"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert wrong in captured.err
