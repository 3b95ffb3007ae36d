"""Nothing that is asked, in whatever order, leads outside the limits; what is asked is done."""

import math

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits, State
from teleop.core.setpoints import PositionTarget, Setpoint, StateTarget, Stop, VelocityTarget
from teleop.planner.live import Live

PAN, TILT, ROLL, FOCUS = Axis.PAN, Axis.TILT, Axis.ROLL, Axis.FOCUS
LIMITS = {
    PAN: Limits(-170, 170, 60, 120, 600),
    TILT: Limits(-30, 40, 40, 90, 480),
    ROLL: Limits(-math.inf, math.inf, 60, 120, 600),
    FOCUS: Limits(0, 1, 0.8, 3, 20),
}
DT = 0.01
TOLERANCE = 1e-6


def placed(**positions):
    live = Live(LIMITS, DT)
    live.reset({axis: State(positions.get(axis.value, 0.0)) for axis in LIMITS})
    return live


def run(live, demand, seconds):
    motion = live.motion
    for _ in range(round(seconds / DT)):
        motion = live.step(demand)
    return motion


def violations(before, after, seconds, limits):
    """By how much a step leaves each limit; a position may be outside as long as it is not further outside."""
    yield after.position - max(limits.maximum, before.position)
    yield min(limits.minimum, before.position) - after.position
    yield abs(after.velocity) - limits.velocity
    yield abs(after.acceleration) - limits.acceleration
    yield abs(after.acceleration - before.acceleration) / seconds - limits.jerk
    yield abs(after.position - before.position) - limits.velocity * seconds
    yield abs(after.velocity - before.velocity) - limits.acceleration * seconds


def wishes(axis):
    limits = LIMITS[axis]
    low, high = max(limits.minimum, -400.0), min(limits.maximum, 400.0)
    reach = (high - low) / 10
    position = st.one_of(st.floats(low - reach, high + reach), st.sampled_from([low, high]))
    velocity = st.one_of(
        st.floats(-1.2 * limits.velocity, 1.2 * limits.velocity),
        st.sampled_from([0.0, limits.velocity, -limits.velocity]),
    )
    gentle = st.one_of(st.none(), st.floats(0.0, 1.2))
    cruise = st.builds(
        lambda v, a, j: VelocityTarget(v, a and a * limits.acceleration, j and j * limits.jerk),
        velocity,
        gentle,
        gentle,
    )
    goto = st.builds(PositionTarget, position, st.one_of(st.none(), st.floats(0, 8)))
    follow = st.builds(StateTarget, position, velocity, st.floats(-limits.acceleration, limits.acceleration))
    return st.one_of(cruise, cruise, goto, follow, st.just(Stop()))


demands = st.fixed_dictionaries({}, optional={axis: wishes(axis) for axis in LIMITS})
phases = st.lists(
    st.tuples(demands, st.sampled_from([1, 2, 7, 40, 150]), st.sampled_from([1, 1, 1, 1, 2, 5])),
    min_size=4,
    max_size=12,
)
starts = st.fixed_dictionaries(
    {
        PAN: st.floats(-190, 190),
        TILT: st.floats(-40, 50),
        ROLL: st.floats(-400, 400),
        FOCUS: st.floats(-0.1, 1.1),
    }
)


@settings(
    max_examples=400,  # of about 260 ticks
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
@given(starts, phases)
def test_no_limit_is_ever_left(start, phases):
    live = Live(LIMITS, DT)
    live.reset({axis: State(position) for axis, position in start.items()})
    before = live.motion
    for demand, ticks, dt_steps in phases:
        for _ in range(ticks):
            after = live.step(demand, dt_steps)
            for axis, limits in LIMITS.items():
                worst = max(violations(before[axis], after[axis], dt_steps * DT, limits))
                assert worst <= TOLERANCE, (axis, before[axis], after[axis], demand.get(axis))
            before = after
    for _ in range(1000):  # whatever it was, it can be stopped, and then nothing changes any more
        live.step({})
        if live.at_rest:
            break
    rest = live.motion
    assert live.step({}) == rest
    assert live.at_rest
    assert all(state[1:] == (0.0, 0.0) for state in rest.values())


def test_a_stick_is_followed_and_stops_on_the_soft_limit():
    live = placed()
    motion = run(live, {PAN: VelocityTarget(60.0)}, 2.0)
    assert motion[PAN].velocity == pytest.approx(60)
    motion = run(live, {PAN: VelocityTarget(60.0)}, 4.0)
    assert motion[PAN] == pytest.approx(State(170.0), abs=1e-6)
    assert live.at_rest


@pytest.mark.parametrize("start", [40.0, 40.0 - 1e-7, 40.0 - 2e-7])
def test_a_stick_into_the_soft_limit_it_lies_on_moves_nothing(start):
    live = placed(tilt=start)
    assert run(live, {TILT: VelocityTarget(20.0)}, 0.1)[TILT] == State(start)
    assert live.at_rest
    assert live.step({TILT: VelocityTarget(-20.0)})[TILT].position < start


def test_jogging_back_from_a_soft_limit_works():
    live = placed(tilt=40.0)
    run(live, {TILT: VelocityTarget(20.0)}, 0.5)
    assert live.motion[TILT].position == pytest.approx(40)
    assert run(live, {TILT: VelocityTarget(-20.0)}, 1.0)[TILT].position < 30


def test_a_stick_slower_than_the_way_it_came_is_slowed_to_not_reversed():
    live = placed()
    run(live, {PAN: VelocityTarget(60.0)}, 1.5)
    velocities = [live.step({PAN: VelocityTarget(2.0)})[PAN].velocity for _ in range(150)]
    assert min(velocities) > 2 - 1e-9
    assert velocities[-1] == pytest.approx(2)


def test_gentler_limits_are_kept_from_rest():
    live = placed()
    state = State(0.0)
    for _ in range(250):
        last, state = state, live.step({PAN: VelocityTarget(60.0, acceleration=30.0, jerk=90.0)})[PAN]
        assert abs(state.acceleration) <= 30 + 1e-9
        assert abs(state.acceleration - last.acceleration) <= 90 * DT + 1e-9
    assert state.velocity == pytest.approx(60)


def test_a_gentle_stick_meets_the_soft_limit_gently():
    live = placed(pan=100.0)
    peak, state = 0.0, State(100.0)
    for _ in range(1000):
        state = live.step({PAN: VelocityTarget(40.0, acceleration=30.0, jerk=90.0)})[PAN]
        peak = max(peak, abs(state.acceleration))
    assert state.position == pytest.approx(170)
    assert peak <= 30 + 1e-6


def test_halt_is_the_fastest_stop():
    live = placed()
    run(live, {PAN: VelocityTarget(60.0, acceleration=30.0)}, 2.2)
    assert live.motion[PAN].velocity == pytest.approx(60)
    ticks = 0
    while live.step({PAN: Stop()})[PAN].velocity > 0:
        ticks += 1
    assert ticks == pytest.approx(70, abs=1)  # V/A + A/J = 0.7 s, whatever the stick's limits were


@pytest.mark.parametrize(("start", "outward"), [(-190.0, -60.0), (185.0, 60.0)])
def test_from_outside_only_inward_motion_is_allowed(start, outward):
    live = placed(pan=start)
    assert run(live, {PAN: VelocityTarget(outward)}, 1.0)[PAN] == State(start)
    assert live.at_rest
    assert run(live, {}, 1.0)[PAN] == State(start)
    last = abs(start)
    for _ in range(300):
        now = abs(live.step({PAN: VelocityTarget(-outward)})[PAN].position)
        assert now <= last
        last = now
    assert last < 170


def test_presets_given_a_time_arrive_together():
    live = placed(focus=0.2)
    demand = {PAN: PositionTarget(30.0, 4.0), TILT: PositionTarget(-20.0, 4.0), FOCUS: PositionTarget(0.8, 4.0)}
    motion = run(live, demand, 3.9)
    assert all(motion[axis].velocity != 0 for axis in demand)
    motion = run(live, demand, 0.11)
    assert {axis: motion[axis] for axis in demand} == {PAN: State(30.0), TILT: State(-20.0), FOCUS: State(0.8)}


def test_presets_given_too_little_time_still_arrive_together():
    live = placed()
    demand = {PAN: PositionTarget(120.0, 0.5), TILT: PositionTarget(5.0, 0.5)}
    arrival = {}
    for tick in range(600):
        for axis, state in live.step(demand).items():
            if axis in demand and axis not in arrival and state == State(demand[axis].position):
                arrival[axis] = tick
    assert arrival[PAN] == arrival[TILT] > 200


def test_a_preset_may_count_its_arrival_down_with_the_clock():
    live, motion = placed(), {}
    for tick in range(400):
        motion = live.step({PAN: PositionTarget(30.0, 4.0 - tick * DT)})
    assert motion[PAN] == State(30.0)


def test_a_preset_can_be_interrupted_and_taken_up_again():
    live = placed()
    run(live, {PAN: PositionTarget(100.0)}, 1.0)
    interrupted = run(live, {PAN: VelocityTarget(-10.0)}, 1.0)
    assert interrupted[PAN].velocity == pytest.approx(-10)
    assert run(live, {PAN: PositionTarget(100.0)}, 5.0)[PAN] == State(100.0)


def test_a_preset_outside_the_soft_limits_is_met_at_the_limit():
    assert run(placed(), {PAN: PositionTarget(200.0)}, 6.0)[PAN] == State(170.0)


def test_kinds_of_demand_mix_across_axes():
    live = placed(focus=0.5)
    motion = run(live, {PAN: VelocityTarget(20.0), TILT: StateTarget(0.0, 0.0, 0.0), FOCUS: PositionTarget(0.9)}, 3.0)
    assert motion[PAN].velocity == pytest.approx(20)
    assert motion[TILT] == State(0.0)
    assert motion[FOCUS] == State(0.9)
    assert motion[ROLL] == State(0.0)


def test_a_late_tick_is_one_longer_step():
    punctual, late = placed(), placed()
    demand = {PAN: VelocityTarget(30.0)}
    for _ in range(6):
        punctual.step(demand)
    assert late.step(demand, dt_steps=6)[PAN] == pytest.approx(punctual.motion[PAN], abs=1e-9)


def test_new_limits_in_flight_are_come_back_to():
    live = placed()
    run(live, {PAN: VelocityTarget(60.0)}, 2.0)
    live.limit({PAN: Limits(-170, 120, 20, 120, 600)})
    state = live.motion[PAN]
    for _ in range(500):
        last, state = state, live.step({PAN: VelocityTarget(60.0)})[PAN]
        assert abs(state.acceleration - last.acceleration) <= 600 * DT + TOLERANCE
        assert abs(state.acceleration) <= 120 + TOLERANCE
    assert state == pytest.approx(State(120.0), abs=1e-6)


def test_a_preset_hours_away_arrives_in_its_time_from_wherever_it_was_moving():
    live = placed()
    run(live, {PAN: VelocityTarget(20.0)}, 1.0)
    hours = 3 * 3600.0
    wish: dict[Axis, Setpoint] = {PAN: PositionTarget(30.0, hours), TILT: PositionTarget(-20.0, hours)}
    motion = run(live, wish, 2.0)
    assert motion[PAN].velocity < 0.01
    ticks = 2
    while not live.at_rest and ticks < 4 * 3600:
        motion = live.step(wish, 100)
        ticks += 1
        assert abs(motion[PAN].velocity) < 0.02
    assert ticks == pytest.approx(hours, rel=0.001)
    assert (motion[PAN], motion[TILT]) == (State(30.0), State(-20.0))


@pytest.mark.parametrize("wish", [VelocityTarget(math.nan), PositionTarget(math.nan), StateTarget(math.nan, 0.0, 0.0)])
def test_nonsense_is_a_stop(wish):
    live = placed()
    run(live, {PAN: VelocityTarget(60.0)}, 1.0)
    assert run(live, {PAN: wish}, 2.0)[PAN].velocity == 0.0


def test_an_axis_not_placed_takes_no_part():
    live = Live(LIMITS, DT)
    assert live.step({PAN: VelocityTarget(10.0)}) == {}
    live.reset({TILT: State(3.0)})
    assert live.step({PAN: VelocityTarget(10.0)}) == {TILT: State(3.0)}
    live.reset({PAN: State(1.0)})
    assert set(live.motion) == {PAN, TILT}


@pytest.mark.parametrize("outward", [1.0, 2.0, 80.0])
@pytest.mark.parametrize("start", [40.001, 40.1, 45.0])
def test_coming_back_inside_is_no_licence_to_leave_again(start, outward):
    """A reference on the soft limit that accelerates outward, for an axis that comes from beyond it."""
    live = placed(tilt=start)
    before = live.motion[TILT]
    for demand in [{TILT: StateTarget(40.0, 0.0, outward)}] * 400 + [{}] * 100:
        after = live.step(demand)[TILT]
        assert after.position <= max(40.0, before.position) + TOLERANCE
        before = after
