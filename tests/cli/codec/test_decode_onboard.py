"""`teleop decode onboard` and `teleop encode onboard` are each other's inverse, with the key and without."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.cli import run
from teleop.cli.codec.decode import decode_hex
from teleop.cli.codec.encode import encode_lines
from teleop.dji.drone import messages as drone
from teleop.dji.drone.broadcast import PARTS, Several
from teleop.dji.drone.enums import ControlCode, ControlOrder
from teleop.dji.drone.onboard_sdk import A3, M100
from teleop.dji.drone.session import OnboardSession

VECTORS = json.loads((Path(__file__).parents[2] / "data" / "onboard.json").read_text())["vectors"]
FRAMES = [vector["hex"] for vector in VECTORS]
[ENCRYPTED] = [vector for vector in VECTORS if vector["enc"]]


@pytest.fixture(autouse=True)
def no_key(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv("TELEOP_DJI_APP_KEY", raising=False)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))


def said(capsys: pytest.CaptureFixture[str], *arguments: str) -> list[dict[str, Any]]:
    assert run(arguments) == 0
    return [json.loads(line) for line in capsys.readouterr().out.splitlines()]


@pytest.mark.parametrize("registry", [M100, A3])
def test_published_frames_come_out_as_they_went_in(registry: Any) -> None:
    lines = list(decode_hex(FRAMES, registry))
    assert len(lines) == len(FRAMES)
    assert list(encode_lines(lines, registry)) == FRAMES


@given(st.lists(st.binary(max_size=30) | st.sampled_from(FRAMES).map(bytes.fromhex), max_size=8))
def test_encoding_what_was_decoded_gives_every_byte_back(parts: list[bytes]) -> None:
    lines = decode_hex([part.hex() for part in parts], M100)
    assert "".join(encode_lines(lines, M100)) == b"".join(parts).hex()


def test_the_model_is_the_layout_of_the_broadcast(capsys: pytest.CaptureFixture[str]) -> None:
    [full] = [vector["hex"] for vector in VECTORS if vector["name"] == "a3_bcast_full"]
    [record] = said(capsys, "decode", "onboard", "--model", "a3", full)
    assert record["fields"]["gps"]["latitude"] == 22.5545
    assert run(["encode", "onboard", "--model", "a3", json.dumps(record)]) == 0
    assert capsys.readouterr().out.strip() == full
    [other] = said(capsys, "decode", "onboard", full)
    assert other["fields"].keys() == {"value"}


def test_an_acknowledgement_says_more_beside_its_command(capsys: pytest.CaptureFixture[str]) -> None:
    host, far = OnboardSession(), OnboardSession()
    asked, _ = host.request(drone.Control(ControlOrder.OBTAIN), 0.0)
    [command] = far.receive(asked, 0.0)
    acknowledged = far.reply(command.frame, drone.ControlAck(ControlCode.NOT_IN_F_MODE))
    [_, ack] = said(capsys, "decode", "onboard", asked.hex(), acknowledged.hex())
    assert (ack["message"], ack["fields"]) == ("drone.control", {"code": "not_in_f_mode"})
    [alone] = said(capsys, "decode", "onboard", acknowledged.hex())
    assert (alone["message"], alone["fields"]) == ("raw", {"value": "0000"})


@pytest.mark.parametrize("place", ["file", "environment", "kept"])
def test_the_key_comes_from_a_file_or_the_environment(
    place: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    given: list[str] = []
    if place == "file":
        (tmp_path / "key").write_text(ENCRYPTED["key"] + "\n")
        given = ["--key-file", str(tmp_path / "key")]
    elif place == "environment":
        monkeypatch.setenv("TELEOP_DJI_APP_KEY", ENCRYPTED["key"])
    else:
        (tmp_path / "teleop").mkdir()
        (tmp_path / "teleop" / "dji.yaml").write_text(f'key: "{ENCRYPTED["key"]}"\n')
    [record] = said(capsys, "decode", "onboard", ENCRYPTED["hex"], *given)
    assert (record["message"], record["fields"]) == ("drone.virtual_rc", {"on": True, "back_to_rc": True})
    assert (record["encryption"], len(record["filling"])) == (0x2D, 26)
    assert run(["encode", "onboard", json.dumps(record), *given]) == 0
    assert capsys.readouterr().out.strip() == ENCRYPTED["hex"]


def test_without_the_key_it_is_opaque_and_cannot_be_encrypted_again(capsys: pytest.CaptureFixture[str]) -> None:
    [record] = said(capsys, "decode", "onboard", ENCRYPTED["hex"])
    assert record["message"] == "raw"
    assert run(["encode", "onboard", json.dumps(record)]) == 0
    assert capsys.readouterr().out.strip() == ENCRYPTED["hex"]
    assert run(["encode", "onboard", json.dumps(record | {"filling": "00"})]) == 2
    assert "line 1: 'filling' says that it was encrypted: give the key" in capsys.readouterr().err


def test_a_bad_key_file_is_one_line_without_its_content(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "key").write_text("5ec2e7")
    assert run(["decode", "onboard", "aa", "--key-file", str(tmp_path / "key")]) == 2
    assert capsys.readouterr() == ("", f"teleop: {tmp_path}/key: a key is 64 hexadecimal digits\n")
    (tmp_path / "key").write_bytes(b"\xff\xfe")
    assert run(["decode", "onboard", "aa", "--key-file", str(tmp_path / "key")]) == 2
    assert run(["decode", "onboard", "aa", "--key-file", str(tmp_path / "absent")]) == 2
    assert capsys.readouterr().err.endswith("absent: No such file or directory\n")


def test_the_library_is_asked_for_only_when_something_is_encrypted(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "cryptography.hazmat.primitives.ciphers", None)
    monkeypatch.setenv("TELEOP_DJI_APP_KEY", ENCRYPTED["key"])
    assert len(said(capsys, "decode", "onboard", FRAMES[0])) == 1
    assert run(["decode", "onboard", ENCRYPTED["hex"]]) == 2
    assert capsys.readouterr().err == (
        "teleop: encryption needs the package cryptography: pip install 'rs-teleop[aes]'\n"
    )


def test_the_parts_of_the_broadcast_are_listed_with_units_and_whether_they_are_raw_or_fused(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run(["decode", "onboard", "--parts"]) == 0
    page = capsys.readouterr().out
    for name, part in PARTS.items():
        assert f"{name}: m100 " in page
        for field in part.cls.layout.fields if isinstance(part, Several) else ():
            assert field.name == "reserved" or f"    {field.name:14} " in page
    assert "gps: m100 none, a3 bit 6, 32 bytes" in page
    assert "    x              a number, m/s2 if fused, g if raw" in page
    for text in (
        "raw (barometer) or fused",
        "raw (gyroscopes) or fused",
        "raw (ultrasound, valid within 3 m) or fused",
    ):
        assert text in " ".join(page.split())
