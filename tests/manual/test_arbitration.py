"""Which input moves which axis: the first that is unlocked, one at a time, and rest once none does."""

from __future__ import annotations

from hands import LIMITS, FakeInput

from teleop.config.operator_settings import SticksSection
from teleop.core.axes import Axis, State
from teleop.core.setpoints import PositionTarget, VelocityTarget
from teleop.manual.arbitration import Arbitration
from teleop.manual.interlock import Interlock
from teleop.manual.recall import Recall

STICKS = SticksSection.model_validate({"ramp": 0, "low_pass": 0})
REST = {axis: State(0.0) for axis in LIMITS}


class Bench:
    """Two inputs, the first with priority, both centered."""

    def __init__(self) -> None:
        self.first, self.second = FakeInput("first"), FakeInput("second")
        self.locks = [Interlock(self.first), Interlock(self.second)]
        self.said: list[str] = []
        self.arbitration = Arbitration(LIMITS, self.locks, STICKS, self.said.append)
        self.motion = dict(REST)
        self.demand()

    def demand(self) -> dict:
        for lock in self.locks:
            lock.read(0.0, True)
        return self.arbitration.setpoints(0.0, 0.01, self.motion, 0.5)


def test_the_first_input_has_an_axis_that_both_deflect_and_the_second_the_others() -> None:
    bench = Bench()
    bench.first.hold(pan=1.0)
    bench.second.hold(pan=-1.0, tilt=1.0)
    demand = bench.demand()
    assert demand == {Axis.PAN: VelocityTarget(60.0), Axis.TILT: VelocityTarget(45.0)}
    assert bench.arbitration.drivers == {Axis.PAN: bench.locks[0], Axis.TILT: bench.locks[1]}


def test_a_locked_input_moves_nothing_and_the_next_one_does() -> None:
    bench = Bench()
    bench.first.hold(pan=1.0)
    bench.first.trouble = "first: unplugged"
    bench.second.hold(pan=-1.0)
    assert bench.demand() == {Axis.PAN: VelocityTarget(-60.0)}


def test_an_axis_that_was_moved_is_brought_to_rest_and_then_left_alone() -> None:
    bench = Bench()
    bench.first.hold(pan=1.0)
    bench.demand()
    bench.motion[Axis.PAN] = State(1.0, 30.0)
    bench.first.hold(pan=0.0)
    assert bench.demand() == {Axis.PAN: VelocityTarget(0.0)}
    bench.motion[Axis.PAN] = State(2.0)
    assert bench.demand() == {}


def test_a_stick_ends_a_recall_and_says_so() -> None:
    bench = Bench()
    bench.arbitration.begin(Recall("preset 1", bench.locks[0], {Axis.PAN: 20.0}, 0.0, 3.0))
    assert bench.demand() == {Axis.PAN: PositionTarget(20.0, 3.0)}
    bench.second.hold(tilt=1.0)
    assert bench.demand()[Axis.TILT] == VelocityTarget(45.0)
    assert bench.said == ["preset 1 ended: second moved tilt"]
    assert bench.arbitration.recall is None


def test_a_step_of_a_locked_input_is_refused_with_the_reason() -> None:
    bench = Bench()
    bench.locks[0].relock()
    bench.first.hold(pan=1.0)
    bench.first.turn(Axis.TILT, 1.0)
    assert Axis.TILT not in bench.demand()
    assert bench.said == ["first is locked: center its sticks"]


def test_once_everything_is_let_go_every_axis_rests() -> None:
    bench = Bench()
    bench.first.hold(pan=1.0)
    bench.demand()
    bench.first.hold(pan=0.0)
    bench.arbitration.drop_all()
    bench.motion[Axis.PAN] = State(1.0, 30.0)
    assert bench.demand()[Axis.PAN] == VelocityTarget(0.0)
