"""docs/protocol-facts.md stays true to the code, where that is mechanical."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from teleop.cli.sim import BAUD
from teleop.config.sinks_section import FlightSection, VirtualRcSection
from teleop.devices import focus
from teleop.devices.drone import engagement, preflight
from teleop.dji import frame
from teleop.dji.drone import virtual_rc
from teleop.dji.drone.onboard_sdk import A3, M100
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal import session
from teleop.dji.gimbal.joystick import FULL_DEFLECTION
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.links.can import GIMBAL_ID, HOST_ID
from teleop.links.url import R_SDK_BITRATE

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "protocol-facts.md").read_text()
KINDS = {"hardware", "maker's code", "client", "document", "inferred"}
GIMBAL, DRONE = (PAGE.split(f"## The {device}'s commands")[1].split("\n## ")[0] for device in ("gimbal", "drone"))


def commands(table: str) -> set[str]:
    return {
        match[1].replace(" ", "").lower() for match in re.finditer(r"^\| ([0-9A-F]{2} [0-9A-F]{2}) \|", table, re.M)
    }


@pytest.mark.parametrize(("table", "registries"), [(GIMBAL, [R_SDK]), (DRONE, [M100, A3])], ids=["gimbal", "drone"])
def test_every_command_is_on_the_page(table: str, registries: list) -> None:
    known = {cls.set_and_id.hex() for registry in registries for cls in registry.messages}
    assert known - commands(table) == set()


@pytest.mark.parametrize(
    ("row", "values"),
    [
        ("CRC-16: poly 0x8005", ["0x3AA3"]),
        ("the longest frame", [f"{frame.LARGEST} bytes", f"0x{frame.LARGEST:X}"]),
        ("start byte", [f"0x{frame.START:X}", f"{frame.HEADER_SIZE} bytes", f"{frame.TAIL_SIZE} bytes"]),
        ("marks a reply", [f"0x{frame.REPLY:X}"]),
        ("partial frame", [f"{frame.PARTIAL_PATIENCE * 1000:.0f} ms"]),
        ("the host sends on", [f"0x{HOST_ID:X}", f"0x{GIMBAL_ID:X}", f"{R_SDK_BITRATE // 1_000_000} Mbit/s"]),
        ("pieces of", [f"{frame.PIECE} bytes"]),
        ("counts as lost", [f"{session.REPLY_TIMEOUT * 1000:.0f} ms"]),
        ("joystick: type 1", [f"+-{FULL_DEFLECTION}"]),
        ("device id", [f"0x{gimbal.R_SDK_DEVICE:08X}"]),
        ("focus position", [f"{focus.LOWEST}..{focus.FULL}"]),
        ("8N1", [f"{BAUD} baud"]),
        ("sticks are sent at", [f"{VirtualRcSection.model_fields['rate'].default} Hz"]),
        ("movement, ", [f"{FlightSection.model_fields['rate'].default} Hz"]),
        ("enabling virtual RC again", [f"{engagement.GAP:g} s"]),
        ("horizontal velocity needs", [f"health {preflight.GPS_HEALTH}"]),
        ("sticks: 16 u32", [f"{virtual_rc.CENTER} +- {virtual_rc.DEFLECTION}"]),
    ],
)
def test_the_constants_on_the_page_are_those_of_the_code(row: str, values: list[str]) -> None:
    [line] = [line for line in PAGE.splitlines() if line.startswith("|") and row in line]
    for value in values:
        assert value in line


def test_the_crc_register_is_that_of_the_code() -> None:
    sample = bytes.fromhex("AA 1A 00 03 00 00 00 00 22 11 A2 42 0E 00 20 00 30 00 40 00 01 14 7B 40 97 BE")
    assert frame.Frame(sample[12:-4], 0x03, 0x1122).encode() == sample
    assert "0x3AA3" in (ROOT / "teleop" / "dji" / "frame.py").read_text()


def rows() -> list[list[str]]:
    """The cells of every row of a table whose last column is a kind."""
    found, in_facts = [], False
    for line in PAGE.splitlines():
        in_facts = (in_facts or line.endswith("| kind |")) and line.startswith("|")
        if in_facts and not line.endswith("| kind |") and not line.startswith("|---"):
            found.append([cell.strip() for cell in line.strip("|").split("|")])
    return found


def test_every_fact_has_a_source_and_a_kind() -> None:
    assert len(rows()) > 70
    for cells in rows():
        assert len(cells) == 4, cells
        assert all(cells), cells
        assert cells[-1] in KINDS, cells


def test_the_files_that_it_names_exist() -> None:
    named = set(re.findall(r"`((?:\w+/)*\w+\.py)`", PAGE))
    assert named
    for name in named:
        assert (ROOT / "teleop" / name).exists(), name


def test_no_code_cites_a_page_that_nobody_else_has() -> None:
    private = re.compile(r"r-sdk-facts|osdk-facts|osdk-appendix|virtual-rc\.md")
    assert [path for path in (ROOT / "teleop").rglob("*.py") if private.search(path.read_text())] == []


def test_it_says_that_nothing_was_tried_on_hardware_and_is_linked() -> None:
    assert "Nothing on this page was tried on hardware by\nus." in PAGE
    for page in ("README.md", "ARCHITECTURE.md"):
        assert "docs/protocol-facts.md" in (ROOT / page).read_text()
