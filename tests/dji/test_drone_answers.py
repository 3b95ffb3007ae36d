"""What the drone answers, byte for byte as the documents and a real Matrice 100 have it."""

from __future__ import annotations

import pytest

from teleop.dji.drone import messages as drone
from teleop.dji.drone.onboard_sdk import M100
from teleop.dji.frame import REPLY, Frame
from teleop.dji.message import Message

NAME = b"SDK-v1.0 BETA M100-03.01.01.00"


def fields(request: Message, value: bytes) -> dict[str, object]:
    frame = Frame(value, REPLY | 2, 7)
    decoded = M100.decode(frame, request.data()[:2])
    assert decoded.message.encode() == value, "it comes out byte for byte again"
    return decoded.message.fields()


@pytest.mark.parametrize(("id_", "given"), [(b"041D492163\0", {"id": "041D492163"}), (b"", {})])
def test_a_real_drone_says_which_it_is_with_and_without_its_serial_number(id_: bytes, given: dict[str, str]) -> None:
    value = bytes.fromhex("01ff ac3a45a6") + id_ + NAME.ljust(32, b"\0")
    assert fields(drone.Version(), value) == {
        "code": "not_activated",
        "checksum": 0xA6453AAC,
        **given,
        "version": NAME.decode(),
    }


@pytest.mark.parametrize(
    ("request_", "value", "code"),
    [
        (drone.Task(task=4), "0100", "failed"),
        (drone.Task(task=4), "0200", "started"),
        (drone.Task(task=4), "02ff", "no_rights"),
        (drone.Task(task=4), "0000", 0),  # no answer that the document has: not a success
        (drone.TaskResult(), "0100", "wrong_number"),
        (drone.TaskResult(), "0300", "in_progress"),
        (drone.TaskResult(), "0400", "failed"),
        (drone.TaskResult(), "0500", "succeeded"),
        (drone.Control(1), "0300", "obtaining"),
        (drone.Control(0), "0400", "releasing"),
    ],
)
def test_answers_are_named_as_the_open_protocol_has_them(request_: Message, value: str, code: object) -> None:
    assert fields(request_, bytes.fromhex(value)) == {"code": code}


def test_the_result_of_a_task_is_asked_for_by_its_number() -> None:
    assert drone.TaskResult(3).data() == bytes.fromhex("0102 03")
