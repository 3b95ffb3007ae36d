"""The table of `teleop fleet` on a terminal of 80 x 24: every rig that fits, and what is wrong first."""

from __future__ import annotations

from time import monotonic

from rich.console import Console

from teleop.cli.screens.fleet_rows import FleetView
from teleop.studio.clocks import Offset
from teleop.studio.rig_state import RigState


def drawn(rigs: list[RigState]) -> list[str]:
    console = Console(width=80, height=24, color_system=None)
    with console.capture() as captured:
        console.print(FleetView(rigs))
    return captured.get().splitlines()


def rig(number: int) -> RigState:
    state = {"run": "running", "holder": "anna@a-desk", "move": {"title": "a wide reveal", "phase": "playing"}}
    return RigState(f"cam-{number:02d}", state, monotonic() + 60, True, offset=Offset(0, 0.001, 0.0003, 0))


def test_few_rigs_have_all_that_is_known():
    lines = drawn([rig(1), rig(2)])
    assert sum("+1.0 ±0.3 ms" in line for line in lines) == 2
    assert not any("…" in line for line in lines)  # folded, and nothing cut off


def test_many_rigs_have_a_line_each_what_is_wrong_first_and_those_left_out_are_counted():
    rigs = [rig(number) for number in range(22)]
    rigs[20].token = False
    lines = drawn(rigs)
    assert len(lines) < 24
    assert lines[1].split()[:2] == ["cam-20", "lost"]
    assert {line.split()[0] for line in lines[1:]} == {each.name for each in rigs}
    assert all(len(line.rstrip()) <= 80 for line in lines)
    lines = drawn([*rigs, *[rig(number) for number in range(30, 40)]])
    assert len(lines) <= 24
    assert lines[-1].strip() == "and 10 rigs more: make the terminal higher"
