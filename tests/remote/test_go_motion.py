"""A go-motion by the door: the exposure of a frame from its start, and a goto with a speed for each axis."""

from __future__ import annotations

from itertools import pairwise

import pytest
from remote_bench import RemoteBench

RUN = {"axes": {"pan": 0.1}, "before": {"pan": 0.0}, "after": {"pan": 0.2}, "exposure": 1.0, "blur": 0.5}


def recorded(bench: RemoteBench, seconds: float) -> list[float]:
    places: list[float] = []
    for _ in range(round(seconds * 100)):
        bench.tick()
        places.append(bench.at())
    return places


def test_it_ramps_for_exactly_a_second_and_is_at_its_place_at_mid_exposure(held: RemoteBench) -> None:
    number = held.say("go_motion", **RUN)
    places = recorded(held, 4.0)
    assert held.ends[number]["ok"]
    assert places[100] == pytest.approx(0.05, abs=2e-3)  # where the exposure begins, after 1 s of ramp
    assert places[150] == pytest.approx(0.1, abs=2e-3)
    assert places[200] == pytest.approx(0.15, abs=2e-3)
    assert places[-1] == pytest.approx(0.2, abs=1e-4)
    assert all(after >= before for before, after in pairwise(places))


def test_it_must_rest_where_it_begins(held: RemoteBench) -> None:
    refused = held.ask("go_motion", **{**RUN, "axes": {"pan": 10.0}, "before": {"pan": 9.9}, "after": {"pan": 10.1}})
    assert "must rest at 9.9" in refused["error"]


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ({"exposure": 0.01, "before": {"pan": -0.5}, "after": {"pan": 0.7}, "blur": 1.0}, "velocity limit"),
        ({"axes": {"pan": 179.9}, "before": {"pan": 170.0}, "after": {"pan": 190.0}}, "soft limit"),
        ({"axes": {"pan": 300.0}}, "outside the soft limits"),
        ({"after": {"tilt": 0.2}}, "the same axes"),
        ({"axes": {"focus": 0.1}, "before": {"focus": 0.1}, "after": {"focus": 0.1}}, "focus"),
    ],
)
def test_what_the_limits_do_not_allow_is_refused(held: RemoteBench, changed: dict[str, object], why: str) -> None:
    assert why in held.ask("go_motion", **{**RUN, **changed})["error"]
    held.run(0.5)
    assert held.at() == 0


def test_a_stop_ends_it(held: RemoteBench) -> None:
    number = held.say("go_motion", **RUN)
    held.run(1.5)
    held.ask("stop")
    held.run(1.0)
    assert "STOP" in held.ends[number]["error"]
    assert held.rests


def test_each_axis_of_a_goto_has_its_own_speed(held: RemoteBench) -> None:
    held.ask("goto", axes={"pan": 10.0, "tilt": 10.0}, speeds={"pan": 5.0, "tilt": 20.0})
    fastest = {"pan": 0.0, "tilt": 0.0}
    for _ in range(300):
        held.tick()
        for name, axis in held.state["axes"].items():
            fastest[name] = max(fastest[name], axis["speed"])
    assert fastest == {"pan": pytest.approx(5.0, abs=0.01), "tilt": pytest.approx(20.0, abs=0.01)}
    assert "not both" in held.ask("goto", axes={"pan": 0.0}, speeds={"pan": 5.0}, seconds=1.0)["error"]
