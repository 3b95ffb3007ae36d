"""What each command of DFMoco does with the rig, and its answer, word for word as the maker's firmware gives it.

The motors are one device, whoever is connected. What the rig refuses stays where it is, and the answer is its position.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from teleop.exchange.client import Client
from teleop.exchange.dfmoco.exposure import Exposure, exposure_of
from teleop.exchange.dfmoco.lines import PARSE_ERROR, Line
from teleop.exchange.dfmoco.motors import Motor
from teleop.exchange.dfmoco.ways import EXPOSING, INCHING, JOGGING, Goal, Ways
from teleop.exchange.served import Served

VERSION = "2.0.0"
FULL = 10_000  # of a jog: all of its motor's rate
INCH = 2  # steps
RAMP_MS = 1000  # from `go` to the exposure
Numbers = tuple[int, ...]
Answers = Sequence[str]


class Controller:
    """`notify` gets why the rig has refused something."""

    def __init__(self, served: Served, motors: Sequence[Motor], notify: Callable[[str], object]) -> None:
        self._door, self._limits = served.door, served.rig.moved
        self.motors, self._ways = motors, Ways(motors, notify)
        self._exposure: Exposure | None = None
        self._commands: Mapping[str, Callable[[Client, Numbers], Any]] = {
            "mm": self._move,
            "mp": self._ask,
            "sm": self._stop_motor,
            "jm": self._jog,
            "im": self._inch,
            "pr": self._set_rate,
            "zm": self._zero,
            "np": self._renumber,
        }

    # --- the state

    def look(self) -> None:
        """Take the newest state."""
        state = self._door.state()
        for motor in self.motors:
            motor.update(state)
        self._ways.look()

    @property
    def knows(self) -> bool:
        """Whether there was a first reading of every motor."""
        return all(motor.is_known for motor in self.motors)

    def due(self) -> Answers:
        """What is sent unasked, twice a second: the positions of what moves, and of what has come to rest since."""
        self.look()
        found = [motor for motor in self.motors if motor in self._ways.reported or self._ways.is_moving(motor)]
        self._ways.reported.clear()
        return [self._at(motor) for motor in found] if self.knows else ()

    # --- commands

    async def do(self, client: Client, line: Line) -> Answers:
        """The answers to a command of that client."""
        self.look()
        match line.name:
            case "hi":
                return [f"hi 2 {len(self.motors)} {VERSION}"]
            case "ms":
                return [f"ms {''.join(str(int(self._ways.is_moving(motor))) for motor in self.motors)}"]
            case "sa":
                await self._ways.stop_all(client)
                return ["sa"]
            case _ if line.numbers is None:
                return [PARSE_ERROR]
            case _ if not self.knows:
                return ()
            case "go":
                return [await self._go(client)]
            case "bf":
                return [await self._prepare(client, line.numbers)]
            case _:
                return await self._of_a_motor(client, line.name, line.numbers)

    async def _of_a_motor(self, client: Client, name: str, numbers: Numbers) -> Answers:
        least, most = COUNTS[name]
        if not (least <= len(numbers) <= most and 1 <= numbers[0] <= len(self.motors)):
            return [PARSE_ERROR]
        answers: Answers = await self._commands[name](client, numbers)
        return answers

    async def _ask(self, _client: Client, numbers: Numbers) -> Answers:
        return [self._at(self.motors[numbers[0] - 1])]

    async def _move(self, client: Client, numbers: Numbers) -> Answers:
        motor = self.motors[numbers[0] - 1]
        if numbers[1] == motor.position and not self._ways.is_moving(motor):
            return [self._at(motor)]
        if await self._ways.send(client, motor, Goal(motor.target(numbers[1]), motor.fastest)):
            return [f"mm {numbers[0]} {numbers[1]}"]
        return [self._at(motor)]

    async def _jog(self, client: Client, numbers: Numbers) -> Answers:
        motor, share = self.motors[numbers[0] - 1], numbers[2] if len(numbers) == 3 else FULL
        if not 0 <= share <= FULL:
            return [PARSE_ERROR]
        goal = motor.jog(numbers[1], share / FULL)
        if goal is None:
            await self._ways.stop(motor)
        elif goal[0] != motor.place or self._ways.is_moving(motor):
            await self._ways.send(client, motor, Goal(*goal, JOGGING))
        return [f"jm {numbers[0]}"]

    async def _inch(self, client: Client, numbers: Numbers) -> Answers:
        motor, goal = self.motors[numbers[0] - 1], self._ways.goal(self.motors[numbers[0] - 1])
        goes = goal is not None and goal.kind == INCHING
        if self._ways.is_moving(motor) and not goes:
            await self._ways.stop(motor)
        else:
            start = motor.steps(goal.place) if goes and goal else motor.position
            step = min(max(numbers[1] - start, -INCH), INCH)
            if step:
                await self._ways.send(client, motor, Goal(motor.target(start + step), motor.fastest, INCHING))
        return [f"im {numbers[0]}"]

    async def _stop_motor(self, client: Client, numbers: Numbers) -> Answers:  # noqa: ARG002 - everybody may stop
        motor = self.motors[numbers[0] - 1]
        await self._ways.stop(motor)
        return [f"sm {numbers[0]}", self._at(motor)]

    async def _set_rate(self, client: Client, numbers: Numbers) -> Answers:
        motor = self.motors[numbers[0] - 1]
        if client.allowed:
            motor.set_rate(numbers[1])
        return [f"pr {numbers[0]} {motor.rate}"]

    async def _zero(self, client: Client, numbers: Numbers) -> Answers:
        self._ways.reported.add(self.motors[numbers[0] - 1])
        return await self._renumber(client, (numbers[0], 0))

    async def _renumber(self, client: Client, numbers: Numbers) -> Answers:
        motor = self.motors[numbers[0] - 1]
        if client.allowed:
            motor.position = numbers[1]
        return [self._at(motor)]

    def _at(self, motor: Motor) -> str:
        return f"mp {self.motors.index(motor) + 1} {motor.position}"

    # --- go-motion

    async def _prepare(self, client: Client, numbers: Numbers) -> str:
        """Go to where the exposure begins; a run that the limits do not allow, or that may not begin, is -1."""
        if any(map(self._ways.is_moving, self.motors)) or len(numbers) < 6 or (len(numbers) - 2) % 4:
            return PARSE_ERROR
        if not client.allowed:
            return self._refused(client, "its address is not in allow of the rig's profile")
        self._exposure = None
        exposure = exposure_of(numbers, self.motors)
        if exposure is None:
            return PARSE_ERROR
        if why := exposure.why_not(self._limits):
            return self._refused(client, why)
        starts = exposure.starts(self._limits)
        motors = [motor for motor in self.motors if motor.axis in starts]
        goals = {motor.axis: Goal(starts[motor.axis], motor.fastest) for motor in motors}
        there = all(motor.is_at(starts[motor.axis]) for motor in motors)
        if not there and not await self._ways.goto(client, goals):
            return "bf -1"
        self._exposure = exposure
        return f"bf {RAMP_MS}"

    def _refused(self, client: Client, why: str) -> str:
        self._ways.say(f"{client.name}: {why}")
        return "bf -1"

    async def _go(self, client: Client) -> str:
        exposure = self._exposure
        if exposure is None or any(map(self._ways.is_moving, self.motors)):
            return PARSE_ERROR
        self._exposure = None
        goals = {axis: Goal(start, 0.0, EXPOSING) for axis, start in exposure.starts(self._limits).items()}
        return "go" if await self._ways.give(client, exposure.command(), goals) else PARSE_ERROR

    async def gone(self, client: Client) -> None:
        """A jog does not go on without the one who jogs; what is bounded does."""
        await self._ways.end_jog(client)
        client.close()


COUNTS: Mapping[str, tuple[int, int]] = {
    "mm": (2, 2),
    "mp": (1, 1),
    "sm": (1, 1),
    "jm": (2, 3),
    "im": (2, 2),
    "pr": (2, 2),
    "zm": (1, 1),
    "np": (2, 2),
}
"""How many numbers a command has, the motor's among them."""
