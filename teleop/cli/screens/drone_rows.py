"""What is known of a drone as rows of the live screen, made from its state alone."""

from __future__ import annotations

import math

from rich.text import Text

from teleop.devices.drone.engagement import Stage
from teleop.devices.drone.state import DroneState

STYLES = {
    Stage.IDLE.value: "dim",
    Stage.TAKING.value: "bold yellow",
    Stage.ENGAGED.value: "bold white on green",
    Stage.ADRIFT.value: "bold black on yellow",
    Stage.LEAVING.value: "bold black on yellow",
    Stage.CHECKING.value: "bold yellow",
    Stage.UNCONFIRMED.value: "bold white on red",
}
LOW = 30  # % of the battery, from which on it is shown as low
UNKNOWN = "-"


def drone_rows(state: DroneState) -> list[Text]:
    """Three rows: the engagement, where it is, and who has it."""
    stage = "not engaged: d engage Enter" if state.stage == Stage.IDLE.value else state.stage.upper()
    first = Text.assemble((" drone    ", "dim"), (f" {stage} ", STYLES[state.stage]), f"  {_text_of(state.status)}")
    first.append(f"   battery {_number(state.battery, '.0f')} %", "bold red" if (state.battery or 0) < LOW else "")
    first.append(f"   GPS {_number(state.gps_health, '.0f')}/5")
    second = Text("          ")
    second.append(f"height {_number(state.height, '.1f')} m   speed {_speed(state)} m/s   ")
    second.append(f"climb {_part(state.velocity, 2, '+.1f')}   ")
    roll, pitch, yaw = (_part(state.attitude, index, "+.0f") for index in range(3))
    second.append(f"roll {roll} pitch {pitch} yaw {yaw} deg")
    third = Text("          ")
    third.append(f"{_number(state.latitude, '.6f')} {_number(state.longitude, '.6f')}   ")
    third.append(f"RC in {state.rc_mode or UNKNOWN}{_moved(state)}   virtual RC {_bit(state.virtual_rc)}   ")
    third.append(f"control: {_text_of(state.device)}   ")
    third.append(f"gimbal {_part(state.gimbal, 2, '+.0f')} {_part(state.gimbal, 1, '+.0f')}", "dim")
    return [first, second, third]


def summary(state: DroneState) -> str:
    """The same in a few words, for a log."""
    where = f"{_number(state.height, '.1f')} m, {_speed(state)} m/s, battery {_number(state.battery, '.0f')} %"
    return f"drone {state.stage}, {_text_of(state.status)}, {where}"


def _text_of(word: str | None) -> str:
    return "unknown" if word is None else word


def _bit(on: bool | None) -> str:
    return UNKNOWN if on is None else "on" if on else "off"


def _number(value: float | None, form: str) -> str:
    return UNKNOWN if value is None else f"{round(value, 6) + 0.0:{form}}"


def _part(values: tuple[float, float, float] | None, index: int, form: str) -> str:
    return _number(None if values is None else values[index], form)


def _speed(state: DroneState) -> str:
    return _number(None if state.velocity is None else math.hypot(*state.velocity[:2]), ".1f")


def _moved(state: DroneState) -> str:
    """Whether the pilot's hands move the sticks."""
    return ", sticks moved" if state.rc and any(abs(stick) > 0.05 for stick in state.rc) else ""
