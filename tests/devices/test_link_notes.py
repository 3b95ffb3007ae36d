"""Warnings of links: each is passed on once, however long it lasts."""

from __future__ import annotations

from typing import Any, cast

from teleop.core.events import Tick
from teleop.devices.connection import Connection
from teleop.devices.link_notes import LinkNotes

TICK = Tick(0.0, {}, {}, (), {})


class Warned:
    """As much of a connection as is looked at."""

    def __init__(self, *warnings: str) -> None:
        self.warnings: list[str] = list(warnings)


def notes(notified: list[str], *connections: Any) -> LinkNotes:
    return LinkNotes(cast(list[Connection], list(connections)), notified.append)


def test_a_warning_that_lasts_is_passed_on_once() -> None:
    notified: list[str] = []
    observer = notes(notified, Warned("slow"), Warned("shared"))
    observer.observe(TICK)
    observer.observe(TICK)
    assert notified == ["slow", "shared"]


def test_one_that_comes_up_later_is_passed_on_and_one_that_comes_back_is_not() -> None:
    notified: list[str] = []
    link = Warned()
    observer = notes(notified, link)
    observer.observe(TICK)
    for link.warnings in (["slow"], [], ["slow", "shared"]):
        observer.observe(TICK)
    assert notified == ["slow", "shared"]
