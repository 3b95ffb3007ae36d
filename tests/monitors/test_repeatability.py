"""Passes against the first: at the move's own time, commanded and measured, on the simulated gimbal's grid too."""

import pytest

from teleop.config.profile import load_profile
from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.clock import VirtualClock
from teleop.core.events import Tick
from teleop.core.run_state import Result
from teleop.devices.rig import open_rig
from teleop.monitors.repeatability import Repeatability
from teleop.planner.keyframes.planner import Key, plan
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.cycle import Cycle
from teleop.sequence.source import SequenceSource

PAN = Axis.PAN


def watch(passes: Repeatability, time: float, commanded: float, measured: float, measured_at: float) -> None:
    passes.observe(Tick(time, {PAN: State(commanded)}, {}, (), {PAN: Reading(measured, measured_at)}))


def test_a_pass_is_compared_at_the_moves_own_time_and_readings_once():
    passes = Repeatability(lambda now: None if now < 0 else (int(now // 10) + 1, now % 10))
    watch(passes, -1.0, 99.0, 99.0, -1.0)  # before there is a pass
    for tick in range(5):
        watch(passes, tick, 10.0 * tick, 10.0 * tick, tick)
    for tick in range(4):
        watch(passes, 10.5 + tick, 10.0 * tick + 5.0, 10.0 * tick + 5.3, 10.5 + (tick // 2) * 2)
    pan = passes.passes[2][PAN]
    assert (pan.commanded.readings, pan.commanded.peak) == (4, 0.0)
    assert (pan.measured.readings, pan.measured.peak) == (2, pytest.approx(0.3))


def test_what_the_first_pass_has_not_is_not_compared():
    passes = Repeatability(lambda now: (int(now // 10) + 1, now % 10))
    watch(passes, 1.0, 0.0, 0.0, 1.0)
    watch(passes, 2.0, 0.0, 0.0, 2.0)
    watch(passes, 1.5, 7.0, 7.0, 1.5)  # stepped back along the path
    watch(passes, 10.5, 3.0, 3.0, 10.5)
    watch(passes, 13.0, 3.0, 3.0, 13.0)
    assert passes.passes == {}
    watch(passes, 11.5, 3.0, 3.0, 11.5)
    assert passes.passes[2][PAN].commanded.peak == 3.0


@pytest.mark.parametrize("mode", ["position", "speed"])
def test_on_the_simulated_gimbal_passes_are_commanded_alike_and_measured_within_its_grid(tmp_path, mode):
    (tmp_path / "rig.yaml").write_text(f"""
name: Bench
links: {{gimbal: "sim:"}}
axes: {{pan: {{min: -180, max: 180, velocity: 60, acceleration: 240, jerk: 2400}}}}
sinks: [{{type: gimbal, link: gimbal, mode: {mode}, rate: 50, delay: 0.05}}]
""")
    profile = load_profile(str(tmp_path / "rig.yaml"))
    keys = {PAN: [Key(0, -7.13), Key(1.37, 20.21), Key(3.113, 4.4, hold=1.01), Key(5.9, 31)]}
    limits = {PAN: Limits(-180, 180, 60, 240, 2400)}
    performance = CompiledSequence("Test", plan(keys, limits), [], [], keys)
    clock = VirtualClock(123456.789)
    source = SequenceSource(performance, limits, cycle=Cycle(0.5, passes=4, compared=True))
    repeatability = Repeatability(source.place)
    with open_rig(profile, clock) as rig:
        assert rig.loop([PAN], [source], [repeatability]).run().result is Result.DONE
    assert sorted(repeatability.passes) == [2, 3, 4]
    for axes in repeatability.passes.values():
        commanded, measured = axes[PAN].commanded, axes[PAN].measured
        assert commanded.readings > 300
        assert commanded.peak < 1e-9
        assert measured.readings > 100
        assert measured.peak <= 0.1 + 1e-9
        assert measured.rms < 0.05
