"""ARCHITECTURE.md names only what exists, the troubleshooting page only texts that the program has."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCE = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "teleop").rglob("*.py"))
ARCHITECTURE = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
TROUBLESHOOTING = (ROOT / "docs/how-to/troubleshooting.md").read_text(encoding="utf-8")
NAMES = sorted(set(re.findall(r"`([A-Z][A-Za-z]*[a-z][A-Za-z]*(?:\.\w+)?)`", ARCHITECTURE)))
MESSAGES = re.findall(r"^\| `([^`]+)` \|", TROUBLESHOOTING, re.MULTILINE)


@pytest.mark.parametrize("name", NAMES)
def test_a_name_of_the_architecture_exists(name: str) -> None:
    owner, _, member = name.partition(".")
    assert re.search(rf"^class {owner}\b|^{owner} = ", SOURCE, re.MULTILINE), owner
    assert not member or re.search(rf"\bdef {member}\b|^    {member}: ", SOURCE, re.MULTILINE), member


@pytest.mark.parametrize("text", MESSAGES)
def test_a_message_of_the_troubleshooting_page_is_one_of_the_program(text: str) -> None:
    assert text in SOURCE


def test_both_pages_were_read() -> None:
    assert len(NAMES) > 40
    assert len(MESSAGES) > 20
