"""A drone in an operator's hands: its sticks sent while it is engaged, and everything that ends an engagement.

Nothing is sent to it before an operator engages it, by a held button or a typed word. What flies it then is the
planner's motion of the four sticks, but a stick only counts in a tick that demands it: an axis that
is not demanded is centered on the wire at once, whatever the planner still has it do. When none is demanded, when a
halt is demanded, when the ticks stop coming, the `Engagement` goes its way to giving back, and only an operator begins
again. `report` is called in every state of the run, so it also looks after a drone that no tick reaches.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Iterator, Mapping, Sequence

from teleop.config.device_commands import DRONE
from teleop.core.axes import STICKS, Axis, Reading
from teleop.core.errors import DeviceError, LinkError
from teleop.core.events import DeviceCommand, Tick
from teleop.core.setpoints import Demand, Stop
from teleop.devices.drone.control_mode import ControlMode, Deflections
from teleop.devices.drone.engagement import HELD, Engagement, Order, Stage
from teleop.devices.drone.preflight import refusals, troubles
from teleop.devices.drone.state import DroneState, drone_state
from teleop.devices.drone.telemetry import Telemetry

CENTERED = 0.02  # of full deflection: a stick that is seen there once is centered
LATE = 0.2  # s without a tick after which its sticks are stale
READY_TIMEOUT = 4.0  # s after activation in which a drone that a script engages must be ready
RELEASE_LOOK = 0.01  # s between looks while giving back
RELEASE_FOR = 4.0  # s for which a run that ends goes on giving back what is not confirmed

log = logging.getLogger(__name__)


class DroneSink:
    """Sink and reporter of one drone, reached at `opened` (s).

    `notify` is for what the operator is to know: the log, unless a screen takes its place. With
    `by_script` it is engaged at the first tick, and what ends that ends the run.
    """

    def __init__(self, mode: ControlMode, telemetry: Telemetry, opened: float, low_battery: int) -> None:
        self.notify: Callable[[str], object] = log.warning
        self.by_script = False
        self.telemetry = telemetry
        self._mode, self._low_battery = mode, low_battery
        self._opened = opened
        self._engagement = Engagement(
            mode.what,
            mode.period,
            mode.taken,
            lambda text: self.notify(f"drone: {text}"),
            gap=mode.gap,
            repeats=mode.repeats,
        )
        mode.notify = lambda text: self.notify(f"drone: {text}")
        self._sticks: Deflections = dict.fromkeys(STICKS, 0.0)
        self._input = False
        self._written = self._activated = math.inf
        self._control_lost = 0
        self._readings: dict[Axis, Reading] = {}
        self._turned = -math.inf
        self._ends = math.inf  # s: since when the run ends

    @property
    def period(self) -> float:
        """s between two frames, moving or not."""
        return self._mode.period

    @property
    def engaged(self) -> bool:
        return self._engagement.stage in HELD

    def state(self, now: float) -> DroneState:
        """What is known of it, for a view and a take."""
        return drone_state(self.telemetry, now, self._engagement.stage, self._sticks)

    def report(self, now: float) -> Mapping[Axis, Reading]:
        """The sticks, which are not measured: centered, once the drone is ready to be flown.

        Raises LinkError and DeviceError as bringing up does.
        """
        with self._explaining():
            self.telemetry.service(now)
        if self.engaged and now - self._written > LATE:
            self._input = False
            self._turn(now)
        if not self._readings and self._ready(now):
            self._readings = dict.fromkeys(STICKS, Reading(0.0, self._opened))
        return self._readings

    def write(self, tick: Tick) -> None:
        """Raises LinkError as the link does, DeviceError when what a script engaged is no longer."""
        first, self._written = math.isinf(self._written), tick.time
        self._take_sticks(tick)
        for act in tick.actions:
            if isinstance(act, DeviceCommand) and act.device == DRONE:
                self._command(act.name, tick.time)
        if self.by_script and first:
            self._engage(tick.time)
        self._turn(tick.time)
        if self.by_script and self._engagement.failure:
            failure, self._engagement.failure = self._engagement.failure, ""
            raise DeviceError(f"drone: {failure}")

    def release(self, now: float) -> float | None:
        """Neutral sticks, giving back, and a look at whether it worked; nothing where nothing was taken.

        Raises DeviceError, once, when the drone has not confirmed it: what can be sent again is, for RELEASE_FOR.
        """
        self._input = False
        self._ends = min(self._ends, now)
        self._engagement.leave(now, "the run ends", asked=True)
        self._withdraw()
        stage = self._engagement.stage
        if stage is Stage.IDLE or (stage is Stage.UNCONFIRMED and now - self._ends >= RELEASE_FOR):
            unreturned, self._engagement.unreturned = self._engagement.unreturned, ""
            if unreturned:
                raise DeviceError(f"drone: unconfirmed: {unreturned}")
            return None
        self._turn(now)
        return now + RELEASE_LOOK

    def _ready(self, now: float) -> bool:
        """Whether the run may begin: by a script only when it can begin by engaging."""
        if not self.telemetry.activated or self.telemetry.get("status", now) is None:
            return False
        self._activated = min(self._activated, now)
        wanting = list(self._refusals(now)) if self.by_script else []
        if wanting and now - self._activated > READY_TIMEOUT:
            raise DeviceError(f"the drone cannot be engaged: {'; '.join(wanting)}")
        return not wanting

    def _take_sticks(self, tick: Tick) -> None:
        asked = [axis for axis in STICKS if axis in tick.motion and _asks(tick.demand, axis)]
        self._sticks = {axis: tick.motion[axis].position if axis in asked else 0.0 for axis in STICKS}
        self._input = bool(asked)
        if any(isinstance(tick.demand.get(axis), Stop) for axis in STICKS):
            self._engagement.leave(tick.time, "STOP", asked=True)

    def _turn(self, now: float) -> None:
        """Look after the engagement, and send what it says; once for each time."""
        if now == self._turned:
            return
        self._turned = now
        for trouble in self._troubles(now):
            self._engagement.leave(now, trouble)
        self._mode.watch(self.telemetry, now)
        if self._mode.contradicted(self.telemetry, now):
            self._engagement.contradicted(now)
        held = self._mode.held(self.telemetry, now)
        order = self._engagement.advance(now, self._input, held, self._mode.patience)
        self._withdraw()
        try:
            with self._explaining():
                self._send(order, now)
        except Exception:
            self._engagement.not_sent(now)
            raise

    def _withdraw(self) -> None:
        """An order that is sent again later would outlive its input; giving back is not among these yet."""
        if self._engagement.stage in (Stage.ADRIFT, Stage.LEAVING):
            self._mode.withdraw()

    def _send(self, order: Order, now: float) -> None:
        match order:
            case Order.DRIVE:
                self._mode.drive(self._sticks, self.telemetry, now)
            case Order.NEUTRAL:
                self._mode.neutral(self.telemetry, now)
            case Order.GIVE_BACK:
                self._mode.give_back(now)
            case Order.NOTHING if self._engagement.stage in (Stage.CHECKING, Stage.UNCONFIRMED):
                self._mode.give_back_again(now)

    def _troubles(self, now: float) -> Iterator[str]:
        if not self.engaged:
            return
        if self.telemetry.control_lost > self._control_lost:
            self._control_lost = self.telemetry.control_lost
            yield "the drone reports that control was lost"
        yield from troubles(self.telemetry, now, self._low_battery)

    def _refusals(self, now: float) -> Iterator[str]:
        yield from refusals(self.telemetry, now, self._low_battery)
        if self.telemetry.activated:
            yield from self._mode.refusals(self.telemetry, now)
        if refusal := self._engagement.refusal(now):
            yield refusal

    def _engage(self, now: float) -> None:
        wanting = list(self._refusals(now))
        if not self._input:
            wanting.append("no input holds its sticks")
        elif any(abs(deflection) > CENTERED for deflection in self._sticks.values()):
            wanting.append("center its sticks")
        if wanting:
            self._refuse(wanting)
            return
        for warning in self._mode.warnings(self.telemetry, now):
            self.notify(f"drone: {warning}")
        self._control_lost = self.telemetry.control_lost
        self._engagement.engage(now)
        with self._explaining():
            self._mode.take(self.telemetry, now)

    def _refuse(self, wanting: Sequence[str]) -> None:
        text = f"not engaged: {'; '.join(wanting)}"
        if self.by_script:
            raise DeviceError(f"drone: {text}")
        self.notify(f"drone: {text}")

    def _command(self, word: str, now: float) -> None:
        if word == "engage":
            self._engage(now)
        elif word == "disengage":
            self._engagement.leave(now, "disengaged by the operator", asked=True)
        elif self._engagement.stage is not Stage.ENGAGED:
            self.notify(f"drone: {word} refused: it is not engaged")
        else:
            try:
                self.notify(f"drone: {self._mode.tell(word, self.telemetry, now)}")
            except KeyError:
                self.notify(f"drone: unknown command {word}")

    def _explaining(self) -> _Explaining:
        return _Explaining(self._engagement.stage is not Stage.IDLE, self._mode.alone)


class _Explaining:
    """Adds to a lost link what becomes of the drone, if it was held."""

    def __init__(self, held: bool, alone: str) -> None:
        self._held, self._alone = held, alone

    def __enter__(self) -> None: ...

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if isinstance(error, LinkError) and self._held:
            raise LinkError(f"{error}; nothing more reaches the drone: {self._alone}") from error


def _asks(demand: Demand, axis: Axis) -> bool:
    return axis in demand and not isinstance(demand[axis], Stop)
