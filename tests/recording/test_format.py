"""What a take's messages hold: only what changed, numbers cut, nothing that JSON does not know."""

from __future__ import annotations

import io
import json
import math
from dataclasses import dataclass
from enum import Enum

import pytest
from mcap.reader import make_reader

from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.events import Tick
from teleop.core.setpoints import Demand, PositionTarget, StateTarget, Stop, VelocityTarget
from teleop.recording.format import About, TakeWriter
from teleop.recording.topics import SCHEMAS, plain

LIMITS = {Axis.PAN: Limits(-math.inf, math.inf, 120, 240, 1200)}


def written(*ticks: Tick) -> list[tuple[float, str, dict]]:
    stream = io.BytesIO()
    writer = TakeWriter(stream, About("Bench", "t", 1.7e9, LIMITS, "0"))
    for tick in ticks:
        writer.add(tick, None)
    writer.end("done", [], 0)
    found = make_reader(io.BytesIO(stream.getvalue())).iter_messages()
    return [((m.log_time - 1.7e18) / 1e9, channel.topic, json.loads(m.data)) for _, channel, m in found]


def tick(time: float, state: State, demand: Demand, reading: Reading | None = None) -> Tick:
    return Tick(time, {Axis.PAN: state}, demand, (), {} if reading is None else {Axis.PAN: reading})


def contents(messages: list[tuple[float, str, dict]], topic: str) -> list[dict]:
    return [content for _, of, content in messages if of == topic]


@pytest.mark.parametrize(
    ("setpoint", "content"),
    [
        (VelocityTarget(1.23456789), {"wish": "cruise", "velocity": 1.234568}),
        (PositionTarget(5, 2.0), {"wish": "goto", "position": 5, "arrive": 2.0}),
        (Stop(), {"wish": "halt"}),
        (StateTarget(1, 2, 3), {"wish": "follow"}),
        (StateTarget(1, 2, 4), {"wish": "follow", "position": 1, "velocity": 2, "acceleration": 4}),
    ],
)
def test_a_setpoint_has_its_numbers_unless_it_was_met(setpoint: object, content: dict) -> None:
    [demand] = contents(written(tick(0, State(1, 2, 3), {Axis.PAN: setpoint})), "/demand")  # type: ignore[dict-item]
    assert demand == {"pan": content}


def test_a_demand_is_written_on_change_and_a_reading_once() -> None:
    reading = Reading(0.5, 0.003)
    ticks = [tick(number / 100, State(1), {Axis.PAN: Stop()}, reading) for number in range(3)]
    messages = written(*ticks)
    assert len(contents(messages, "/motion")) == 3
    assert len(contents(messages, "/demand")) == 1
    [(time, content)] = [(time, content) for time, topic, content in messages if topic == "/measured"]
    assert (time, content) == (pytest.approx(0.003, abs=1e-6), {"pan": 0.5})


def test_the_description_has_null_for_a_limit_that_there_is_not() -> None:
    about = About("Bench", "t", 1.5, LIMITS, "0").record()
    assert json.loads(about["axes"])["pan"]["minimum"] is None
    assert float(about["started"]) == 1.5


def test_every_topic_has_a_schema_with_a_title_and_a_description() -> None:
    assert all(schema["title"] and schema["description"].endswith(".") for schema in SCHEMAS.values())


class Color(Enum):
    RED = "red"


@dataclass(frozen=True)
class Nested:
    color: Color
    numbers: tuple[float, ...]


def test_a_status_becomes_plain_json() -> None:
    assert plain({Color.RED: Nested(Color.RED, (1.23456789, math.nan))}) == {
        "red": {"color": "red", "numbers": [1.234568, None]}
    }
    assert plain(Reading(1.0, 2.0)) == {"position": 1.0, "time": 2.0}
    assert plain(1 + 2j) == "(1+2j)"
