"""The fault table of a drone in the air, on virtual time: what was sent, what it did, what the operator was told.

Each row breaks something while the drone flies with half a stick forward. `DroneFaultBench` checks every sent
frame: never two enables within two seconds, never sticks that no hand holds, never more than 25 frames in a second.
What a row adds is who flies afterwards, and the words.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest
from drone_fault_bench import READY, VIRTUAL_RC, DroneFaultBench, drone_fault_bench

from teleop.config.documents.document import DocumentError
from teleop.core.operator_input import Command
from teleop.core.run_state import Result
from teleop.devices.drone.engagement import LAST_NEUTRALS, Stage
from teleop.dji.drone.virtual_rc import NEUTRAL, Sticks
from teleop.sim.drone.controls import Pilot, Switch

BREAKS = 8.0  # s after the start
FORWARD = 1024 + 330


def fly(bench: DroneFaultBench) -> None:
    bench.airborne()
    bench.engage_at(READY)
    bench.hold_at(READY + 1, stick_pitch=0.5)


def test_it_is_engaged_flown_and_given_back(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path) as bench:
        fly(bench)
        bench.at(BREAKS, lambda: bench.keys.press(Command.DISENGAGE))
        bench.quit_at(BREAKS + 4)
        bench.run()
    assert bench.ended.result is Result.DONE
    [enabled], [disabled] = bench.enables, bench.disables
    sticks = bench.of(Sticks)
    assert sticks[0][0] - enabled <= 0.011, "sticks follow the enable at once"
    assert [message for _, message in sticks[-LAST_NEUTRALS:]] == [NEUTRAL] * LAST_NEUTRALS
    assert disabled - sticks[-1][0] <= 0.06
    assert max(message.pitch for _, message in sticks) == FORWARD
    assert len(sticks) == pytest.approx(20 * (disabled - enabled), abs=2)
    assert bench.pilot(BREAKS - 0.1) is Pilot.VIRTUAL
    assert bench.pilot(BREAKS + 1) is Pilot.RC
    assert bench.said == [
        "drone: engaged: the drone confirms virtual RC",
        "drone: disengaged by the operator: sticks neutral, releasing virtual RC",
        "drone: virtual RC is released: the drone confirms it",
    ]


def hand_is_gone(bench: DroneFaultBench) -> None:
    bench.pad.trouble = "pad: silent for 0.2 s"


def everything_stops(bench: DroneFaultBench) -> None:
    bench.keys.press(Command.STOP)


def pilot_leaves_f(bench: DroneFaultBench) -> None:
    bench.drone.turn_switch(bench.clock.now(), Switch.P)


def control_is_lost(bench: DroneFaultBench) -> None:
    bench.drone.lose_control(bench.clock.now())


def battery_runs_low(bench: DroneFaultBench) -> None:
    bench.drone.set_battery(bench.clock.now(), 20)


def status_is_no_longer_told(bench: DroneFaultBench) -> None:
    bench.drone.hide("status")


def the_bit_is_no_longer_told(bench: DroneFaultBench) -> None:
    bench.drone.hide("control")


def nothing_comes_from_it(bench: DroneFaultBench) -> None:
    bench.cable.mute = True


def nothing_reaches_it(bench: DroneFaultBench) -> None:
    bench.cable.deaf = True


def every_byte_is_damaged(bench: DroneFaultBench) -> None:
    bench.cable.damage = lambda data: bytes([data[0] ^ 1]) + data[1:]


def every_frame_is_cut(bench: DroneFaultBench) -> None:
    bench.cable.damage = lambda data: data[: len(data) // 2]  # of a whole checksum the next frame may be the rest


def unplugged(bench: DroneFaultBench) -> None:
    bench.cable.unplugged = True


def signal(bench: DroneFaultBench) -> None:
    bench.loop.interrupt("SIGTERM received")


def stalls_300_ms(bench: DroneFaultBench) -> None:
    bench.clock.stall(0.3)


def stalls_1500_ms(bench: DroneFaultBench) -> None:
    bench.clock.stall(1.5)


def defect(bench: DroneFaultBench) -> None:
    def fails(*_arguments: object) -> None:
        raise ZeroDivisionError("a defect")

    bench.operator.read = fails  # type: ignore[method-assign]  # a defect is put in


@dataclass(frozen=True)
class Row:
    """What breaks, what is said of it, by whom it flies then, within how many s of the break the sticks are neutral."""

    breaks: Callable[[DroneFaultBench], None]
    said: str
    within: float = 0.07
    result: Result = Result.DONE
    disables: int = 1
    given_back: float = 2.0  # s after the break, by which its RC has it


ROWS = [
    Row(hand_is_gone, "no stick input for 1 s"),
    Row(everything_stops, "STOP: sticks neutral"),
    Row(pilot_leaves_f, "the drone has ended virtual RC"),
    Row(control_is_lost, "the drone reports that control was lost"),
    Row(battery_runs_low, "the battery is at 20 %", within=1.1),
    Row(status_is_no_longer_told, "the drone no longer reports its flight status", within=1.1),
    Row(the_bit_is_no_longer_told, "no longer reports whether virtual RC is on", within=1.1, result=Result.FAILED),
    Row(nothing_comes_from_it, "take it over with its RC", within=1.1, result=Result.FAILED),
    Row(nothing_reaches_it, "the drone has ended virtual RC", within=1.1),
    Row(every_byte_is_damaged, "the drone has ended virtual RC", within=1.1),
    Row(every_frame_is_cut, "the drone has ended virtual RC", within=1.1),
    Row(unplugged, "goes back to its RC by itself, 1 s after", result=Result.FAILED, disables=0),
    Row(signal, "STOP", result=Result.INTERRUPTED),
    Row(stalls_300_ms, "the computer stalled for 0.30 s", within=0.37, result=Result.FAILED),
    Row(stalls_1500_ms, "the computer stalled for 1.5", within=1.57, result=Result.FAILED),
    Row(defect, "ZeroDivisionError: a defect", result=Result.FAILED),
]


@pytest.mark.parametrize("row", ROWS, ids=[row.breaks.__name__ for row in ROWS])
def test_whatever_breaks_the_drone_is_back_with_its_pilot(row: Row, tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path) as bench:
        fly(bench)
        bench.at(BREAKS, lambda: row.breaks(bench))
        bench.quit_at(BREAKS + 6)
        bench.run()
    assert bench.pilot(BREAKS - 0.01) is Pilot.VIRTUAL, "it flew until then"
    assert bench.ended.result is row.result, bench.ended.reasons
    assert any(row.said in text for text in (*bench.said, *bench.ended.reasons)), (bench.said, bench.ended.reasons)
    assert len(bench.enables) == 1, "never again by itself"
    assert len(bench.disables) == row.disables
    after = [message for time, message in bench.of(Sticks) if time > BREAKS + row.within]
    assert all(message == NEUTRAL for message in after)
    assert bench.pilot(BREAKS + row.given_back) is Pilot.RC
    if row.disables:
        given_back = bench.disables[0]
        assert [message for time, message in bench.of(Sticks) if time < given_back][-LAST_NEUTRALS:] == [
            NEUTRAL
        ] * LAST_NEUTRALS
        assert not bench.of(Sticks) or bench.of(Sticks)[-1][0] < given_back, "nothing after it"
    pose = bench.drone.autopilot.pose
    assert abs(complex(pose.velocity_north, pose.velocity_east)) < 0.1, "it hovers"
    assert not bench.drone.autopilot.flight.crashed


def test_a_stall_centres_the_sticks_before_the_gimbal_is_found_again(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, gimbal=True) as bench:
        fly(bench)
        bench.hold_at(READY + 1, stick_pitch=0.5, pan=1.0)
        bench.at(BREAKS, lambda: setattr(bench.rig.simulated["gimbal"], "tells_angles", False))
        bench.at(BREAKS, lambda: stalls_300_ms(bench))
        bench.run()
    assert bench.ended.result is Result.FAILED
    after = [(time, message) for time, message in bench.of(Sticks) if time > BREAKS + 0.1]
    assert after[0][0] <= BREAKS + 0.37, "at once, though the gimbal is still looked for"
    assert all(message == NEUTRAL for _, message in after)
    assert len(bench.disables) == 1


def test_a_stick_whose_own_hand_is_gone_is_centred_while_the_others_fly(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path) as bench:
        fly(bench)
        bench.hold_at(READY + 1, stick_pitch=0.5)
        bench.at(1, lambda: bench.keys.hold(stick_roll=0.0))
        bench.at(READY + 0.9, lambda: bench.pad.hold(stick_pitch=0.0))
        bench.at(READY + 1, lambda: bench.pad.hold(stick_pitch=0.5))
        bench.at(READY + 1.5, lambda: bench.keys.hold(stick_roll=1.0))
        bench.at(BREAKS, lambda: setattr(bench.keys, "trouble", "keys: gone"))
        bench.at(BREAKS + 2, lambda: hand_is_gone(bench))
        bench.at(BREAKS + 6, lambda: bench.loop.interrupt("the end"))
        bench.run()
    assert max(message.roll for time, message in bench.of(Sticks) if time < BREAKS) == 1684
    after = [message for time, message in bench.of(Sticks) if BREAKS + 0.07 < time < BREAKS + 2]
    assert {(message.roll, message.pitch) for message in after} == {(1024, FORWARD)}


def test_a_hand_that_is_back_within_a_second_has_to_be_centred_first(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path) as bench:
        fly(bench)
        bench.at(BREAKS, lambda: hand_is_gone(bench))
        bench.at(BREAKS + 0.4, lambda: setattr(bench.pad, "trouble", ""))
        bench.hold_at(BREAKS + 0.6)
        bench.hold_at(BREAKS + 0.7, stick_pitch=0.5)
        bench.quit_at(BREAKS + 3)
        bench.run()
    assert "drone: stick input is back" in bench.said
    deflected = [time for time, message in bench.of(Sticks) if message != NEUTRAL and time > BREAKS + 0.07]
    assert deflected[0] > BREAKS + 0.69
    assert len(bench.enables) == 1


def test_an_enable_that_is_not_answered_is_not_repeated(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path) as bench:
        bench.airborne()
        bench.drone.autopilot.enable_virtual = lambda back_to_rc: None  # type: ignore[method-assign]  # it does not
        fly(bench)
        bench.quit_at(BREAKS)
        bench.run()
    assert len(bench.enables) == len(bench.disables) == 1
    assert any("the drone does not confirm virtual RC" in text for text in bench.said)


def test_a_drone_that_hides_the_bit_is_flown_and_that_is_said(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path) as bench:
        bench.drone.hide("control")
        fly(bench)
        bench.quit_at(BREAKS)
        bench.run()
    assert any("sends no control field" in text for text in bench.said)
    assert any("engaged, but the drone does not report whether virtual RC is on" in text for text in bench.said)
    assert max(message.pitch for _, message in bench.of(Sticks)) == FORWARD
    assert len(bench.enables) == len(bench.disables) == 1
    assert bench.ended.result is Result.FAILED, "whether it was given back is not known"


def test_lost_acknowledgements_are_asked_for_again_and_then_end_the_run(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path) as bench:
        bench.drone.acknowledges = False
        bench.at(0.15, lambda: setattr(bench.drone, "acknowledges", True))
        fly(bench)
        bench.quit_at(BREAKS)
        bench.run()
    assert bench.ended.result is Result.DONE
    assert len(bench.enables) == 1
    with drone_fault_bench(tmp_path) as bench:
        bench.drone.acknowledges = False
        bench.run()
    assert bench.ended.reasons[0] == "drone on sim: does not answer: is it on, is the cable in?"
    assert bench.enables == []


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda bench: bench.hold_at(0.0, stick_roll=0.5), "no input holds its sticks"),
        (lambda bench: bench.hold_at(2.0, stick_roll=0.5), "center its sticks"),
        (pilot_leaves_f, "mode switch is in P"),
        (battery_runs_low, "the battery is at 20 %: 25 % is too low to begin with"),
        (lambda bench: bench.drone.hide("rc"), "does not report where its RC's mode switch is"),
        (lambda bench: bench.drone.hide("battery"), "does not report its battery"),
        (lambda bench: bench.keys.press(Command.STOP), "STOP is not cleared"),
    ],
)
def test_what_is_not_fit_to_fly_is_not_engaged(
    spoil: Callable[[DroneFaultBench], None], said: str, tmp_path: Path
) -> None:
    with drone_fault_bench(tmp_path) as bench:
        bench.at(0.5, lambda: spoil(bench)) if spoil.__name__ != "<lambda>" else spoil(bench)
        bench.engage_at(READY + 1)
        bench.quit_at(READY + 2)
        bench.run()
    told = [*bench.said, *(message.text for message in bench.operator.status.messages)]
    assert any(said in text for text in told), told
    assert bench.of(Sticks) == []
    assert bench.enables == []


def test_it_is_not_engaged_twice_within_two_seconds_however_often_it_is_asked(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path) as bench:
        bench.airborne()
        for tenth in range(100):
            bench.engage_at(0.1 * tenth)
            bench.at(0.1 * tenth + 0.05, lambda: bench.keys.press(Command.DISENGAGE))
        bench.quit_at(11)
        bench.run()
    assert len(bench.enables) >= 3
    assert any("twice within 2 s would lock the drone" in text for text in bench.said)


def test_it_is_engaged_at_once_after_the_start_since_the_wait_counts_from_an_enable(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path) as bench:
        bench.airborne()
        bench.engage_at(1.3)
        bench.quit_at(4)
        bench.run()
    assert bench.enables == [pytest.approx(1.3, abs=0.02)]
    assert not any("wait" in text for text in bench.said)


def test_it_is_not_enabled_while_it_is_on_for_another_nor_soon_after(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path) as bench:
        bench.airborne()
        bench.at(1.0, lambda: bench.drone.autopilot.enable_virtual(back_to_rc=True))  # it lasts for a second
        bench.engage_at(1.5)
        bench.engage_at(2.3)
        bench.engage_at(3.5)
        bench.quit_at(6)
        bench.run()
    assert bench.said[0].startswith("drone: not engaged: virtual RC is on already, for another program")
    assert bench.said[1].startswith("drone: not engaged: wait 0.8 s: an earlier run or another program enabled")
    assert bench.enables == [pytest.approx(3.5, abs=0.02)]


def test_motors_start_by_gesture_in_standby_and_are_never_cut_in_the_air(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path) as bench:
        bench.engage_at(READY)
        bench.tell_at(READY + 0.5, "arm")
        bench.hold_at(READY + 4, stick_throttle=0.8)
        bench.tell_at(READY + 7, "disarm")
        bench.hold_at(READY + 8)
        bench.quit_at(READY + 10)
        bench.run()
    corners = [time for time, message in bench.of(Sticks) if (message.roll, message.throttle) == (364, 364)]
    assert corners[0] >= READY + 0.5
    assert corners[-1] <= READY + 2.6
    assert bench.drone.autopilot.flight.airborne
    assert not bench.drone.autopilot.flight.crashed
    assert "disarm refused: the drone reports in air" in bench.said[-3]


def test_switches_are_set_while_it_is_engaged_and_neutral_is_p_mode(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path) as bench:
        bench.airborne()
        bench.tell_at(READY - 1, "mode-a")
        bench.engage_at(READY)
        bench.tell_at(READY + 1, "mode-a")
        bench.tell_at(READY + 1.5, "gear-up")
        bench.tell_at(READY + 2, "home")
        bench.at(READY + 3, lambda: bench.keys.press(Command.DISENGAGE))
        bench.quit_at(READY + 5)
        bench.run()
    switches = [(message.mode, message.gear, message.go_home) for _, message in bench.of(Sticks)]
    assert switches[0] == switches[-1] == (1552, 1324, 1024)
    assert (1024, 1684, 1024) in switches
    assert bench.said[0] == "drone: mode-a refused: it is not engaged"
    assert any("the profile has no channel value for it" in text for text in bench.said)


def test_the_loop_ends_idle_when_nobody_ever_engaged(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path) as bench:
        bench.hold_at(3, stick_pitch=1.0)
        bench.quit_at(5)
        bench.run()
        assert bench.sink.state(bench.clock.now()).stage == Stage.IDLE.value
    assert bench.of(Sticks) == []
    assert bench.enables == bench.disables == []


def test_it_is_flown_encrypted_by_the_apps_key(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    encrypted = VIRTUAL_RC.replace("link", "encrypted: true, link")
    with (
        pytest.raises(DocumentError, match="encrypted: true needs the app's key: in TELEOP_DJI_APP_KEY"),
        drone_fault_bench(tmp_path, encrypted),
    ):
        pass
    monkeypatch.setenv("TELEOP_DJI_APP_KEY", "5a" * 32)
    with drone_fault_bench(tmp_path, encrypted) as bench:
        fly(bench)
        bench.at(BREAKS, lambda: bench.keys.press(Command.DISENGAGE))
        bench.quit_at(BREAKS + 3)
        bench.run()
    assert bench.ended.result is Result.DONE
    assert bench.of(Sticks) == [], "nobody without the key can read them"
    assert bench.pilot(BREAKS - 0.1) is Pilot.VIRTUAL
    assert bench.pilot(BREAKS + 1) is Pilot.RC
    assert bench.drone.autopilot.pose.north > 10
