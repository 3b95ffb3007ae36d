"""`teleop fleet sticks`: a distant rig in the hands of this machine's operator."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path
from time import monotonic, sleep
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from teleop.cli.fleet.options import DEFAULTS, FleetOptions
from teleop.cli.options import RIGS
from teleop.core.errors import UsageError

if TYPE_CHECKING:
    from teleop.core.operator_input import Input
    from teleop.studio.fleet import Fleet
    from teleop.studio.rig_state import RigState
    from teleop.studio.sticks import RigSticks

EVERY = 0.05  # s between two pictures
NO_INPUT = "fleet sticks: no joystick and no terminal: plug in a joystick, or run it on a terminal"


def fleet_sticks(
    name: Annotated[str, Parameter(metavar="NAME", help="The rig.")],
    *,
    inputs: Annotated[
        str,
        Parameter(metavar="NAME|FILE", help="The profile whose `inputs` say what the joystick does.", completer=RIGS),
    ] = "sim",
    input_recording: Annotated[
        tuple[Path, ...],
        Parameter(
            metavar="FILE", consume_multiple=False, help="Device recorded by `teleop devices record`.", negative=()
        ),
    ] = (),
    options: FleetOptions = DEFAULTS,
) -> int:
    """Move a distant rig by the joystick or the keys of this machine; q ends it.

    The rig stops by its own clock when it does not hear the stick for 0.25 s. After a gap: press e to take control
    again, with the stick centered.
    """
    from teleop.studio.sticks import RigSticks

    lines: list[str] = []
    with ExitStack() as stack:
        opened = _inputs(stack, inputs, input_recording)
        fleet = stack.enter_context(options.fleet())
        sticks = stack.enter_context(RigSticks(fleet, name, opened, lines.append))
        _turn(stack, fleet, sticks, name, lines)
    return 0


def _inputs(stack: ExitStack, profile: str, recordings: Sequence[Path]) -> Sequence[Input]:
    """Every joystick, and the keys of the terminal. Raises UsageError where there is neither."""
    from teleop.app.operator_inputs import open_devices
    from teleop.cli.key_terminal import key_terminal
    from teleop.config.profile import load_profile
    from teleop.core.clock import SystemClock
    from teleop.inputs.hid.recording import read_recording
    from teleop.inputs.keyboard import Keyboard

    descriptor = key_terminal()
    read = [read_recording(file, number) for number, file in enumerate(recordings, 1)]
    begin = monotonic() + 1.0
    devices, _absent = open_devices(
        stack, load_profile(profile), SystemClock(), descriptor is not None, NO_INPUT, read, lambda: begin
    )
    if not devices and descriptor is None:
        raise UsageError(NO_INPUT)
    keys = [] if descriptor is None else [stack.enter_context(Keyboard(descriptor))]
    return [*devices, *keys]


def _turn(stack: ExitStack, fleet: Fleet, sticks: RigSticks, name: str, lines: list[str]) -> None:
    show, shown = _shown(stack, fleet, sticks, name, lines), 0.0
    while not sticks.over:
        due = sticks.turn()
        if due - shown > EVERY:
            shown = due
            show()
        sleep(max(0.0, due - monotonic()))


def _shown(stack: ExitStack, fleet: Fleet, sticks: RigSticks, name: str, lines: list[str]) -> Callable[[], object]:
    """Draws the rig's row, what its stick waits for, and the newest lines."""
    import sys

    from rich.console import Group
    from rich.live import Live
    from rich.text import Text

    from teleop.cli.screens.fleet_rows import fleet_table
    from teleop.core.plain import plain

    if not sys.stdout.isatty():
        return lambda: None
    live = stack.enter_context(Live(auto_refresh=False))

    def draw() -> None:
        rig = fleet.rig(name)
        below = Text("\n".join(map(plain, [_waits(rig, sticks), *lines[-3:]])))
        keys = Text("space STOP   c clear   e take control   arrows step   r record   q quit", style="dim")
        live.update(Group(fleet_table([rig], fleet.problems), below, keys), refresh=True)

    return draw


def _waits(rig: RigState, sticks: RigSticks) -> str:
    if not rig.alive:
        return f"{rig.name} is lost"
    if rig.stopped:
        return "STOP is not cleared: c clears it"
    return f"the stick is locked: {sticks.waits_for} (e takes control)" if sticks.waits_for else "the stick moves it"
