"""Control that is obtained and released over lines that lose, delay and deafen: nothing is called confirmed unanswered.

Released means: answered by 1, or another control device in the broadcast (docs/protocol-facts.md). Until then the
order is repeated, and at the end of a run the drone is named as one that has not confirmed it.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest
from drone_fault_bench import FLIGHT, READY, DroneFaultBench, drone_fault_bench

from teleop.core.operator_input import Command
from teleop.core.run_state import Result
from teleop.devices.drone.control_authority import AGAIN
from teleop.devices.drone.engagement import Stage
from teleop.devices.drone.sink import RELEASE_FOR
from teleop.dji.drone import messages as drone
from teleop.dji.drone.enums import ControlOrder
from teleop.dji.drone.movement import Move
from teleop.sim.drone.controls import Pilot
from teleop.sim.drone.settings import DroneSettings

CONFIRMED = "drone: control is released: the drone confirms it"
SILENT = "drone: control: released, but the drone reports that it is still on: take it over with its RC"
UNHEARD = "drone: control: released, but the drone reports nothing: take it over with its RC"


def orders(bench: DroneFaultBench, order: ControlOrder) -> list[float]:
    return [time for time, message in bench.of(drone.Control) if message.order == order]


def deafen(bench: DroneFaultBench, begin: float, end: float = 1e9) -> None:
    bench.at(begin, lambda: setattr(bench.cable, "deaf", True))
    if end < 1e9:
        bench.at(end, lambda: setattr(bench.cable, "deaf", False))


def disengage_at(bench: DroneFaultBench, seconds: float) -> None:
    bench.at(seconds, lambda: bench.keys.press(Command.DISENGAGE))


def test_a_release_that_a_deaf_line_has_lost_is_sent_until_the_drone_confirms_it(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne()
        bench.engage_at(READY)
        deafen(bench, READY + 2, READY + 6)
        disengage_at(bench, READY + 3)
        bench.at(READY + 5.9, lambda: pilots.append(bench.drone.autopilot.pilot))
        bench.at(READY + 5.9, lambda: said.extend(bench.said))
        pilots: list[Pilot] = []
        said: list[str] = []
        bench.quit_at(READY + 12)
        bench.run()
    assert pilots == [Pilot.ONBOARD], "it still obeys,"
    assert CONFIRMED not in said, "and nobody says otherwise"
    assert SILENT in said
    assert bench.said[-1] == CONFIRMED
    assert bench.drone.autopilot.pilot is Pilot.RC
    assert bench.ended.result is Result.DONE
    releases = orders(bench, ControlOrder.RELEASE)
    assert all(later - earlier >= AGAIN - 1e-6 for earlier, later in pairwise(releases)), "each after a pause"
    assert releases[-1] < READY + 9, "and none once it is confirmed"


@pytest.mark.parametrize("seconds", [1.0, 2.5])
def test_one_second_of_deafness_over_a_disengagement_ends_with_the_pilot(seconds: float, tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne()
        bench.engage_at(READY)
        deafen(bench, READY + 1, READY + 1.1 + seconds)
        disengage_at(bench, READY + 1.1)
        bench.quit_at(READY + 10)
        bench.run()
    assert bench.drone.autopilot.pilot is Pilot.RC
    assert not bench.drone.autopilot.obtained
    assert bench.said[-1] == CONFIRMED


def test_a_drone_that_is_deaf_to_the_end_is_named_as_one_that_has_not_confirmed(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne()
        bench.engage_at(READY)
        deafen(bench, READY + 2)
        bench.quit_at(READY + 3)
        bench.run()
    assert bench.ended.result is Result.FAILED
    assert SILENT.replace("drone:", "drone: unconfirmed:") in bench.ended.reasons
    assert CONFIRMED not in bench.said
    last = orders(bench, ControlOrder.RELEASE)[-1]
    assert RELEASE_FOR - 1.5 < last - READY - 3 < RELEASE_FOR + 0.5, "it is repeated for a bounded time"
    assert bench.drone.autopilot.pilot is Pilot.ONBOARD


def test_a_release_that_is_never_answered_is_confirmed_by_the_broadcast(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne()
        bench.engage_at(READY)
        bench.at(READY + 2, lambda: setattr(bench.drone, "acknowledges", False))
        disengage_at(bench, READY + 2.5)
        bench.quit_at(READY + 8)
        bench.run()
    assert bench.said[-1] == CONFIRMED
    assert bench.drone.autopilot.pilot is Pilot.RC
    assert bench.ended.result is Result.DONE


def test_a_release_without_answer_and_without_broadcast_is_not_confirmed(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne()
        bench.engage_at(READY)
        bench.at(READY + 2, lambda: setattr(bench.drone, "acknowledges", False))
        bench.at(READY + 2, lambda: bench.drone.hide("control"))
        disengage_at(bench, READY + 2.5)
        bench.quit_at(READY + 8)
        bench.run()
    assert UNHEARD in bench.said
    assert CONFIRMED not in bench.said
    assert bench.ended.result is Result.FAILED
    assert UNHEARD.replace("drone:", "drone: unconfirmed:") in bench.ended.reasons


def test_an_answer_alone_confirms_where_the_broadcast_does_not_say_who_has_control(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne()
        bench.drone.hide("control")
        bench.engage_at(READY)
        disengage_at(bench, READY + 2)
        bench.quit_at(READY + 6)
        bench.run()
    assert bench.said[0] == "drone: engaged: the drone confirms control"
    assert bench.said[-1] == CONFIRMED
    assert bench.drone.autopilot.pilot is Pilot.RC


def test_control_whose_answers_are_lost_is_confirmed_by_the_broadcast(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne()
        bench.at(READY - 0.5, lambda: setattr(bench.drone, "acknowledges", False))
        bench.engage_at(READY)
        bench.quit_at(READY + 6)
        bench.run()
    assert "drone: engaged: the drone confirms control" in bench.said
    assert bench.of(Move), "and it is flown"


@pytest.mark.parametrize("late", [0.05, 0.3, 0.7, 0.95])
@pytest.mark.parametrize("settings", [DroneSettings(), DroneSettings(asks_twice=False)], ids=["twice", "once"])
def test_late_answers_are_waited_for(late: float, settings: DroneSettings, tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.drone.settings = settings
        bench.airborne()
        bench.at(READY - 0.3, lambda: setattr(bench.cable, "late", late))
        bench.engage_at(READY)
        disengage_at(bench, READY + 5)
        bench.quit_at(READY + 15)
        bench.run()
    assert "drone: engaged: the drone confirms control" in bench.said, bench.said
    assert bench.said[-1] == CONFIRMED
    assert bench.drone.autopilot.pilot is Pilot.RC
    assert bench.ended.result is Result.DONE


def test_a_new_engagement_ends_the_repetition_and_an_old_answer_is_none_of_it(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne()
        bench.engage_at(READY)
        deafen(bench, READY + 1, READY + 5.5)
        disengage_at(bench, READY + 1.5)
        bench.engage_at(READY + 5)
        bench.quit_at(READY + 9)
        bench.run()
    releases = orders(bench, ControlOrder.RELEASE)
    assert not [time for time in releases if READY + 5.01 < time < READY + 8.99]
    assert bench.pilot(READY + 8.9) is Pilot.ONBOARD
    assert bench.said.count("drone: engaged: the drone confirms control") == 2
    assert bench.said[-1] == CONFIRMED


def test_a_drone_that_has_control_again_by_an_old_request_is_given_back_again(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne()
        bench.engage_at(READY)
        disengage_at(bench, READY + 2)
        bench.at(READY + 6, lambda: bench.drone.autopilot.obtain())
        bench.quit_at(READY + 10)
        bench.run()
    assert "drone: the drone reports control on again: releasing it" in bench.said
    assert bench.drone.autopilot.pilot is Pilot.RC
    assert bench.said[-1] == CONFIRMED


def test_it_is_engaged_again_at_once_since_movement_locks_nothing(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne()
        for second in range(4):
            bench.engage_at(1.3 + second)
            disengage_at(bench, 1.7 + second)
        bench.quit_at(6)
        bench.run()
    assert bench.said.count("drone: engaged: the drone confirms control") == 4
    assert not [text for text in bench.said if "wait" in text]


def test_control_is_flown_and_given_back_over_an_encrypted_link(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TELEOP_DJI_APP_KEY", "5a" * 32)
    with drone_fault_bench(tmp_path, FLIGHT.replace("link", "encrypted: true, link")) as bench:
        bench.airborne()
        bench.engage_at(READY)
        bench.hold_at(READY + 1, stick_pitch=0.5)
        bench.tell_at(READY + 4, "land")
        disengage_at(bench, READY + 8)
        bench.quit_at(READY + 11)
        bench.run()
    assert "drone: land: started" in bench.said
    assert bench.said[-1] == CONFIRMED
    assert bench.drone.autopilot.pose.north > 3
    assert bench.sink.state(bench.clock.now()).stage == Stage.IDLE.value
