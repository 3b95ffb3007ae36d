"""What is known of a drone on the screen: each state in its words, and a dash for what it does not say."""

from __future__ import annotations

from teleop.cli.screens.drone_rows import drone_rows, summary
from teleop.devices.drone.engagement import Stage
from teleop.devices.drone.state import DroneState

FLYING = DroneState(
    stage=Stage.ENGAGED.value,
    sticks={},
    activated=True,
    status="in air",
    attitude=(1.2, -3.4, 90.0),
    latitude=52.5,
    longitude=13.4,
    height=12.34,
    gps_health=4,
    velocity=(3.0, 4.0, -0.5),
    battery=28,
    rc=(0.0, 0.0, 0.5, 0.0),
    rc_mode="F",
    gimbal=(0.0, -10.0, 30.0),
    device="remote controller",
    virtual_rc=True,
)


def text(state: DroneState) -> str:
    return "\n".join(row.plain for row in drone_rows(state))


def test_it_says_where_the_drone_is_and_who_has_it() -> None:
    shown = text(FLYING)
    for word in (
        *("ENGAGED", "in air", "battery 28 %", "GPS 4/5", "height 12.3 m", "speed 5.0 m/s", "climb -0.5"),
        *("roll +1 pitch -3 yaw +90 deg", "52.500000 13.400000", "RC in F, sticks moved", "virtual RC on"),
        *("control: remote controller", "gimbal +30 -10"),
    ):
        assert word in shown
    assert summary(FLYING) == "drone engaged, in air, 12.3 m, 5.0 m/s, battery 28 %"


def test_what_it_does_not_say_is_a_dash() -> None:
    shown = text(DroneState(Stage.IDLE.value, {}, False))
    assert "not engaged: d engage Enter" in shown
    assert "unknown" in shown
    assert "battery - %" in shown
    assert "virtual RC -" in shown


def test_a_low_battery_is_red() -> None:
    [row, *_] = drone_rows(FLYING)
    assert any("red" in str(span.style) and "battery" in row.plain[span.start : span.end] for span in row.spans)
