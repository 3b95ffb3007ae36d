"""Whether a drone is held: one way in, and every way out ends in neutral sticks and one giving back."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.devices.drone.engagement import (
    CHECK,
    CONFIRM,
    GAP,
    HELD,
    LAST_NEUTRALS,
    OFF_AFTER,
    TRANSITIONS,
    Engagement,
    EngagementError,
    EngagementEvent,
    Order,
    Stage,
)

TICK = 0.01


class Drone:
    """An engagement on the loop's grid, and a drone that answers `lag` s late; `orders` with their times."""

    def __init__(self, lag: float = 0.1) -> None:
        self.said: list[str] = []
        self.engagement = Engagement("virtual RC", 0.05, 0.0, self.said.append)
        self.now = 5.0
        self.hand = True
        self.silent = False
        self.on = False
        self.lag = lag
        self.changes: list[tuple[float, bool]] = []
        self.orders: list[tuple[float, Order]] = []
        self.taken: list[float] = []

    def engage(self) -> None:
        if not self.engagement.refusal(self.now):
            self.engagement.engage(self.now)
            self.taken.append(self.now)
            self.changes.append((self.now + self.lag, True))

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds / TICK)):
            self.now = round(self.now + TICK, 6)
            for at, on in self.changes:
                self.on = on if at <= self.now else self.on
            order = self.engagement.advance(self.now, self.hand, None if self.silent else self.on)
            if order is not Order.NOTHING:
                self.orders.append((self.now, order))
            if order is Order.GIVE_BACK:
                self.changes.append((self.now + self.lag, False))

    def of(self, order: Order) -> list[float]:
        return [time for time, each in self.orders if each is order]

    @property
    def stage(self) -> Stage:
        return self.engagement.stage


def test_only_an_operator_takes_it() -> None:
    drone = Drone()
    drone.run(10)
    assert drone.orders == []
    assert {event for (_, event), to in TRANSITIONS.items() if to is Stage.TAKING} == {EngagementEvent.ENGAGE}


def test_sticks_are_sent_at_once_and_twenty_times_a_second() -> None:
    drone = Drone()
    drone.engage()
    drone.run(2)
    times = drone.of(Order.DRIVE)
    assert times[0] - drone.taken[0] <= TICK + 1e-9
    assert all(later - earlier == pytest.approx(0.05) for earlier, later in pairwise(times))
    assert drone.said == ["engaged: the drone confirms virtual RC"]


def test_leaving_is_neutral_then_one_giving_back_then_silence() -> None:
    drone = Drone()
    drone.engage()
    drone.run(2)
    drone.engagement.leave(drone.now, "disengaged by the operator", asked=True)
    left = drone.now
    drone.run(5)
    after = [order for time, order in drone.orders if time > left]
    assert after == [Order.NEUTRAL] * LAST_NEUTRALS + [Order.GIVE_BACK]
    assert drone.stage is Stage.IDLE
    assert drone.said[-1] == "virtual RC is released: the drone confirms it"
    assert drone.engagement.failure == ""


def test_without_a_hand_it_is_neutral_at_once_and_given_back_after_a_second() -> None:
    drone = Drone()
    drone.engage()
    drone.run(2)
    drone.hand = False
    lost = drone.now
    drone.run(4)
    assert all(order is not Order.DRIVE for time, order in drone.orders if time > lost)
    [given] = drone.of(Order.GIVE_BACK)
    assert OFF_AFTER <= given - lost < OFF_AFTER + 0.5
    assert drone.engagement.failure == "no stick input for 1 s"


def test_a_hand_that_is_back_in_time_goes_on() -> None:
    drone = Drone()
    drone.engage()
    drone.run(2)
    drone.hand = False
    drone.run(0.5)
    drone.hand = True
    drone.run(1)
    assert drone.stage is Stage.ENGAGED
    assert drone.orders[-1][1] is Order.DRIVE


def test_a_drone_that_does_not_confirm_is_given_back_and_not_taken_again() -> None:
    drone = Drone(lag=1e9)
    drone.engage()
    drone.run(10)
    assert len(drone.of(Order.GIVE_BACK)) == 1
    assert drone.of(Order.GIVE_BACK)[0] - drone.taken[0] < CONFIRM + 0.5
    assert drone.said[0].startswith("the drone does not confirm virtual RC")
    assert len(drone.taken) == 1


def test_a_drone_that_says_nothing_of_it_is_flown_with_a_warning() -> None:
    drone = Drone()
    drone.silent = True
    drone.engage()
    drone.run(3)
    assert drone.stage is Stage.ENGAGED
    assert "does not report whether virtual RC is on" in drone.said[0]
    drone.engagement.leave(drone.now, "bye", asked=True)
    drone.run(1 + CHECK)
    assert drone.stage is Stage.IDLE
    assert drone.said[-1] == "virtual RC: released, but the drone reports nothing: take it over with its RC"
    assert drone.engagement.unreturned == drone.said[-1]


def test_a_drone_that_no_longer_says_that_it_is_held_is_given_back() -> None:
    drone = Drone()
    drone.engage()
    drone.run(2)
    drone.silent = True
    drone.run(1 + CHECK)
    assert drone.said[1].startswith("the drone no longer reports whether virtual RC is on")
    assert len(drone.of(Order.GIVE_BACK)) == 1


def test_a_pilot_who_takes_it_back_is_told_to_have_it() -> None:
    drone = Drone()
    drone.engage()
    drone.run(2)
    drone.changes.append((drone.now, False))
    drone.run(3)
    assert drone.stage is Stage.IDLE
    assert "the drone has ended virtual RC" in drone.said[1]
    assert len(drone.of(Order.GIVE_BACK)) == 1


def test_the_wait_counts_from_the_last_enable_and_is_never_said_to_be_nothing() -> None:
    engagement = Engagement("virtual RC", 0.05, 100.0, lambda _text: None)
    assert engagement.refusal(100.5).startswith("wait 1.5 s: twice within 2 s")
    assert engagement.refusal(101.999).startswith("wait 0.1 s"), "not 0.0"
    assert engagement.refusal(102.0) == ""


def test_without_an_enable_or_a_gap_there_is_no_wait() -> None:
    assert Engagement("virtual RC", 0.05, -math.inf, print).refusal(0.0) == ""
    assert Engagement("control", 0.02, 5.0, print, gap=0.0).refusal(5.0) == ""


def test_a_drone_that_must_not_be_taken_is_not_taken_even_by_a_defect() -> None:
    drone = Drone()
    drone.engage()
    with pytest.raises(EngagementError, match="it is engaged"):
        drone.engagement.engage(drone.now)


def test_what_can_be_given_back_again_stays_unconfirmed_until_the_drone_says_otherwise() -> None:
    drone = Drone()
    drone.engagement = Engagement("control", 0.02, -math.inf, drone.said.append, gap=0.0, repeats=True)
    drone.engage()
    drone.run(2)
    drone.lag = 1e9
    drone.engagement.leave(drone.now, "bye", asked=True)
    drone.run(60)
    assert drone.stage is Stage.UNCONFIRMED
    assert drone.engagement.unreturned.endswith("take it over with its RC")
    assert drone.engagement.refusal(drone.now) == "", "it can be taken again"
    drone.changes.append((drone.now, False))
    drone.run(0.1)
    assert drone.stage is Stage.IDLE
    assert drone.said[-1] == "control is released: the drone confirms it"
    assert drone.engagement.unreturned == ""


def test_a_confirmation_that_is_contradicted_long_after_leads_to_another_giving_back() -> None:
    drone = Drone()
    drone.engage()
    drone.run(2)
    drone.engagement.leave(drone.now, "bye", asked=True)
    drone.run(1)
    assert drone.stage is Stage.IDLE
    drone.engagement.contradicted(drone.now)
    assert drone.stage is Stage.IDLE, "an older broadcast may still be under way"
    drone.run(3)
    drone.engagement.contradicted(drone.now)
    drone.run(1)
    assert len(drone.of(Order.GIVE_BACK)) == 2


STEPS = st.lists(
    st.tuples(st.sampled_from(["engage", "leave", "hand", "silent", "off", "wait"]), st.floats(0.0, 2.5)), max_size=30
)


@given(STEPS, st.floats(0.0, 0.5))
def test_whatever_happens_it_is_taken_once_per_act_and_given_back_once(
    steps: list[tuple[str, float]], lag: float
) -> None:
    drone = Drone(lag)
    for what, seconds in steps:
        if what == "engage":
            drone.engage()
        elif what == "leave":
            drone.engagement.leave(drone.now, "asked", asked=True)
        elif what == "hand":
            drone.hand = not drone.hand
        elif what == "silent":
            drone.silent = not drone.silent
        elif what == "off":
            drone.changes.append((drone.now, False))
        drone.run(seconds)
    drone.engagement.leave(drone.now, "the end", asked=True)
    drone.run(4)
    assert drone.stage is Stage.IDLE
    assert len(drone.of(Order.GIVE_BACK)) == len(drone.taken)
    assert all(later - earlier >= GAP - 1e-6 for earlier, later in pairwise(drone.taken))
    frames = [time for time, order in drone.orders if order is not Order.GIVE_BACK]
    assert all(later - earlier >= 0.05 - 1e-6 for earlier, later in pairwise(frames))
    for taken, returned in zip(drone.taken, drone.of(Order.GIVE_BACK), strict=True):
        last = [order for time, order in drone.orders if taken <= time < returned][-LAST_NEUTRALS:]
        assert last == [Order.NEUTRAL] * LAST_NEUTRALS


def test_a_giving_back_that_did_not_leave_is_tried_again() -> None:
    drone = Drone()
    drone.engage()
    drone.run(2)
    drone.engagement.leave(drone.now, "bye", asked=True)
    while drone.stage is not Stage.CHECKING:
        drone.run(TICK)
    drone.changes.clear()
    drone.engagement.not_sent(drone.now)
    assert drone.stage is Stage.LEAVING
    drone.run(3)
    assert drone.stage is Stage.IDLE
    assert len(drone.of(Order.GIVE_BACK)) == 2


def test_the_table_knows_what_is_held() -> None:
    assert {stage for stage in Stage if (stage, EngagementEvent.LEAVE) in TRANSITIONS} == HELD
