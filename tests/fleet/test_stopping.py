"""STOP for several rigs that come and go, without a network; and a table that shows them while one does not answer."""

from __future__ import annotations

from contextlib import nullcontext
from threading import Event
from time import monotonic

import pytest

from teleop.cli.fleet import table
from teleop.cli.fleet.options import FleetOptions
from teleop.studio.fleet import Fleet
from teleop.studio.link import Link
from teleop.studio.rig_state import RigState
from teleop.studio.stopping import Stopped, stop_rigs

HERE, THERE = "tcp/127.0.0.1:1", "tcp/127.0.0.1:2"


def heard(fleet: Fleet, name: str, endpoint: str, **state: object) -> None:
    """A state of that rig comes by that endpoint."""
    link: Link = next(each for each in fleet._links if each.endpoint == endpoint)
    link.heard = True
    link.ready.set()
    fleet.heard_state(link, name, state, monotonic())


def test_a_rig_that_is_heard_late_is_stopped_too_and_the_first_does_not_wait_for_it(monkeypatch: pytest.MonkeyPatch):
    fleet = Fleet([HERE, THERE], memory=False)
    heard(fleet, "cam-a", HERE)

    def ask(name: str, what: str, *_: object) -> dict[str, object]:
        assert what == "command/stop"
        heard(fleet, name, {"cam-a": HERE, "cam-b": THERE}[name], stopped=True)
        if name == "cam-a":
            heard(fleet, "cam-b", THERE)
        return {"ok": True}

    monkeypatch.setattr(fleet, "ask", ask)
    assert stop_rigs(fleet, None, 60) == Stopped(["cam-a", "cam-b"], [])


def test_an_endpoint_without_a_rig_is_named_for_there_may_be_one():
    fleet = Fleet([HERE], memory=False)
    assert stop_rigs(fleet, None, 0.05) == Stopped([], [HERE])
    assert stop_rigs(fleet, ["cam-x"], 0.05) == Stopped([], ["cam-x"])


class Silent(Fleet):
    """A rig's clock is asked for, and no answer comes until some pictures were drawn."""

    def __init__(self) -> None:
        super().__init__([], memory=False)
        self.pictures, self.drawn = 0, Event()
        self.answered: list[bool] = []

    def measure_clocks(self, names: object = None) -> None:
        self.answered.append(self.drawn.wait(30))

    @property
    def rigs(self) -> list[RigState]:
        self.pictures += 1
        if self.pictures > 3:
            self.drawn.set()
        if self.answered:
            raise KeyboardInterrupt
        return []


def test_the_table_goes_on_while_a_rig_does_not_answer_for_its_clock(monkeypatch: pytest.MonkeyPatch):
    fleet = Silent()
    monkeypatch.setattr(FleetOptions, "fleet", lambda _: nullcontext(fleet))
    monkeypatch.setattr(table, "EVERY", 0.001)
    with pytest.raises(KeyboardInterrupt):
        table.fleet_table()
    assert fleet.answered[0]
