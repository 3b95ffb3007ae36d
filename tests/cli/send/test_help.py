"""The help of `teleop send`: which commands it has for which words, and how they are laid out."""

from __future__ import annotations

import pytest

from teleop.cli.send.help import VOCABULARIES, print_help
from teleop.config.documents.document import DocumentError


def catalogue(capsys: pytest.CaptureFixture[str], *words: str) -> list[str]:
    """The lines on the commands, without the usage and the options before them."""
    print_help(words)
    return capsys.readouterr().out.rpartition("╯\n")[2].splitlines()


def headings(lines: list[str]) -> list[str]:
    return [line for line in lines if line and not line.startswith(" ")]


@pytest.fixture(autouse=True)
def _wide(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")


def test_words_begin_a_command_only_as_whole_words(capsys: pytest.CaptureFixture[str]) -> None:
    assert headings(catalogue(capsys, "gimbal", "position")) == ["gimbal position"]
    with pytest.raises(DocumentError, match="no command begins with 'gimbal posi'"):
        print_help(["gimbal", "posi"])
    assert capsys.readouterr().out == "", "not even the usage"


def test_the_commands_of_a_device_are_found_without_it_too(capsys: pytest.CaptureFixture[str]) -> None:
    assert catalogue(capsys, "position") == catalogue(capsys, "gimbal", "position")


def test_what_is_always_refused_is_in_no_help(capsys: pytest.CaptureFixture[str]) -> None:
    refused = {
        name
        for vocabulary in VOCABULARIES
        for name, command in vocabulary.commands.items()
        if command in vocabulary.refused
    }
    shown = {heading.partition(",")[0] for heading in headings(catalogue(capsys))}
    assert refused
    assert shown & refused == set()
    for name in refused:
        with pytest.raises(DocumentError):
            print_help(name.split())


def test_only_all_of_it_has_examples(capsys: pytest.CaptureFixture[str]) -> None:
    assert any("teleop send " in line for line in catalogue(capsys))
    assert not any("teleop send " in line for line in catalogue(capsys, "gimbal"))


def test_a_wide_terminal_is_not_filled_and_plain_words_are_not_broken(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    lines = catalogue(capsys, "gimbal")
    assert 90 < max(map(len, lines)) <= 100
    start = lines.index("gimbal: plain words") + 1
    plain = lines[start : lines.index("", start)]
    assert len(plain) > 1
    assert all(line.endswith(",") for line in plain[:-1])
