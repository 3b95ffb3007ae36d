"""What moves for DFMoco: one way of the door at a time, with a place and a speed of its own for each motor.

Each motor has a way and a rate of its own: together they are one way of the door, with a speed for each axis. What the
rig refuses stays where it is.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from teleop.core.axes import Axis
from teleop.exchange.client import Client
from teleop.exchange.dfmoco.motors import Motor

JOGGING, INCHING, EXPOSING = "jog", "inch", "exposure"


class Goal(NamedTuple):
    """Where an axis goes, and at most how fast, in units; `kind` is "" for a plain move."""

    place: float
    speed: float
    kind: str = ""


@dataclass
class Way:
    """What moves for a client: `number` is the action at the door."""

    client: Client
    number: int
    goals: Mapping[Axis, Goal]


class Ways:
    """`notify` gets why the rig has refused something. `reported` are the motors whose position is due once more."""

    def __init__(self, motors: Sequence[Motor], notify: Callable[[str], object]) -> None:
        self._motors, self._notify = motors, notify
        self._way: Way | None = None
        self.reported: set[Motor] = set()
        self._moved: set[Motor] = set()
        self._said = ""
        self._tasks: set[asyncio.Task[None]] = set()

    def look(self) -> None:
        """The motors have been told the newest state."""
        moving = {motor for motor in self._motors if self.is_moving(motor)}
        self.reported |= self._moved - moving
        self._moved = moving

    def is_moving(self, motor: Motor) -> bool:
        goal = self.goal(motor)
        return bool(motor.speed) or (goal is not None and (goal.kind == EXPOSING or not motor.is_at(goal.place)))

    def goal(self, motor: Motor) -> Goal | None:
        return None if self._way is None else self._way.goals.get(motor.axis)

    async def send(self, client: Client, motor: Motor, goal: Goal) -> bool:
        """One motor there, beside those that are on their way already."""
        if not motor.reaches(goal.place):
            missing = motor.limits is None
            where = "the rig has no such axis" if missing else f"{goal.place:g} is outside the soft limits"
            self.say(f"{client.name}: {motor.axis}: {where}")
            return False
        return await self.goto(client, {**self._going(client, motor), motor.axis: goal})

    def _going(self, client: Client, but: Motor) -> Mapping[Axis, Goal]:
        """The other motors of that client that are still on their way."""
        way = self._way
        if way is None or way.client is not client:
            return {}
        others = {each.axis for each in self._motors if each is not but and self.is_moving(each)}
        return {axis: goal for axis, goal in way.goals.items() if axis in others and goal.kind != EXPOSING}

    async def goto(self, client: Client, goals: Mapping[Axis, Goal]) -> bool:
        axes = {axis.value: goal.place for axis, goal in goals.items()}
        speeds = {axis.value: goal.speed for axis, goal in goals.items()}
        return await self.give(client, {"do": "goto", "axes": axes, "speeds": speeds}, goals)

    async def give(self, client: Client, command: Mapping[str, Any], goals: Mapping[Axis, Goal]) -> bool:
        answer = await client.command(command)
        if "ok" not in answer:
            self.say(f"{client.name}: {answer.get('error', '')}")
            return False
        self._said = ""
        way = self._way = Way(client, answer["id"], goals)
        task = asyncio.get_running_loop().create_task(self._follow(way))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return True

    async def _follow(self, way: Way) -> None:
        end = await way.client.finished(way.number)
        if self._over(way) and (why := end.get("error", "")):
            self.say(f"{way.client.name}: {why}")

    def _over(self, way: Way) -> bool:
        """Whether it was the way in hand, which is over: its last positions are due."""
        if self._way is not way:
            return False
        self._way = None
        self.reported |= {motor for motor in self._motors if motor.axis in way.goals}
        return True

    async def stop(self, motor: Motor) -> None:
        """This motor comes to rest; the others of its way go on."""
        way = self._way
        if way is None or motor.axis not in way.goals:
            return
        if others := self._going(way.client, motor):
            await self.goto(way.client, others)
        else:
            await self._abort(way)

    async def stop_all(self, client: Client) -> None:
        """What moves for DFMoco comes to rest; what moves for another one is a STOP's to end."""
        if self._way is not None:
            await self._abort(self._way)
        elif any(motor.speed for motor in self._motors):
            client.stop()

    async def _abort(self, way: Way) -> None:
        answer = await way.client.command({"do": "abort"})
        if answer.get("kind") == "lost":
            way.client.stop()
        self._over(way)

    async def end_jog(self, client: Client) -> None:
        """Of a client that is gone: what it jogs comes to rest, what is bounded goes on."""
        way = self._way
        if way is not None and way.client is client and any(goal.kind == JOGGING for goal in way.goals.values()):
            await self._abort(way)

    def say(self, why: str) -> None:
        if why != self._said:
            self._said = why
            self._notify(why)
