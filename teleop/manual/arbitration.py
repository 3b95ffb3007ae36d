"""Which input moves which axis: sticks merged, steps and sliders, and the recall under way, as one demand.

Whatever moves an axis belongs to an input, and stops with it: a stick while it is deflected, a recall or a jog until it
arrives. An axis that was moved is brought to rest before anything beneath may take it over: gently when the stick was
released, as fast as the axis may when the input was lost.

A drone's stick is a position: that of the operator's stick, centered too, as long as an unlocked input has it. When
none has, the demand does not name it, and so the drone knows that there is no input.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from teleop.config.operator_settings import SticksSection
from teleop.core.axes import Axis, Limits, Motion
from teleop.core.setpoints import PositionTarget, Setpoint, VelocityTarget
from teleop.manual.interlock import Interlock
from teleop.manual.jog import Jog
from teleop.manual.recall import Recall
from teleop.manual.velocity_shaping import VelocityShaping

LATE = 0.05  # s after which a recall is reported as late


class Arbitration:
    """`locks` are the inputs in the order of their priority; `notify` takes lines for the operator.

    `drivers` are the inputs that deflect an axis, `deflections` (-1..1) by how much, `recall` what is under way.
    `taken` are the axes that inputs deflect or have sent somewhere.
    """

    def __init__(
        self,
        limits: Mapping[Axis, Limits],
        locks: Sequence[Interlock],
        sticks: SticksSection,
        notify: Callable[[str], object],
    ) -> None:
        self._limits, self._locks, self._notify = limits, locks, notify
        self._sticks = [axis for axis in limits if axis.is_stick]
        self._shaping = {
            axis: VelocityShaping(of, sticks.ramp, sticks.low_pass) for axis, of in limits.items() if not axis.is_stick
        }
        self._jog = Jog(limits)
        self.recall: Recall | None = None
        self.drivers: dict[Axis, Interlock] = {}
        self.deflections: dict[Axis, float] = {}
        self.taken: set[Axis] = set()
        self._driven: dict[
            Axis, Interlock | None
        ] = {}  # not yet at rest since this input moved it; None: it is to rest

    def begin(self, recall: Recall) -> None:
        """Take the axes somewhere; what else was under way is over."""
        self._jog.clear()
        self.recall = recall

    def setpoints(self, now: float, seconds: float, motion: Motion, share: float) -> dict[Axis, Setpoint]:
        """Setpoints of unlocked inputs for the axes that they move, and rest for those that they moved.

        `seconds` since the last time; `share` is what full deflection is of an axis's velocity.
        """
        self._merge()
        self._take_steps(now, motion)
        sent = self._sent(now, motion, share)
        self.taken = {*self.drivers, *sent}
        demand: dict[Axis, Setpoint] = self._held()
        for axis, shaping in self._shaping.items():
            deflection = self.deflections.get(axis, 0.0)
            lock = None if axis in sent else self.drivers.get(axis, self._driven.get(axis))
            lost = lock is None or not lock.unlocked
            if lost:
                shaping.drop()
            setpoint = shaping.setpoint(deflection, share, motion[axis], seconds)
            if axis in sent or deflection or (lost and axis in self._driven):
                self._driven[axis] = None if lost else lock
            if axis in sent:
                demand[axis] = sent[axis]
            elif setpoint is None:
                self._driven.pop(axis, None)
            elif axis in self._driven:
                demand[axis] = VelocityTarget(0.0) if lost else setpoint
        return demand

    def _held(self) -> dict[Axis, Setpoint]:
        """A drone's sticks, where unlocked inputs have them."""
        mapped = {axis for lock in self._locks if lock.unlocked for axis in lock.held.deflections}
        return {axis: PositionTarget(self.deflections.get(axis, 0.0)) for axis in self._sticks if axis in mapped}

    @property
    def deflected(self) -> Axis | None:
        """An axis that a stick moves, a drone's own sticks apart."""
        return next((axis for axis in self.drivers if not axis.is_stick), None)

    def _merge(self) -> None:
        """Which input drives which axis: the first unlocked one that deflects it. A stick ends what was under way."""
        self.drivers, self.deflections = {}, {}
        for lock in self._locks:
            if not lock.unlocked:
                continue
            for axis, deflection in lock.held.deflections.items():
                if deflection and axis in self._limits and axis not in self.drivers:
                    self.drivers[axis], self.deflections[axis] = lock, deflection
                    self._jog.drop(axis)
        if self.recall and (axis := self.deflected):
            self._end_recall(f"{self.drivers[axis].name} moved {axis}")

    def _take_steps(self, now: float, motion: Motion) -> None:
        """Steps, and sliders that were moved: both send an axis somewhere, unless a stick has it."""
        for lock in self._locks:
            for axis, units in lock.held.steps.items():
                click = lock.held.click.get(axis, 0.0)
                if units and self._may_send(lock, axis) and self._jog.step(axis, units, motion[axis], lock, now, click):
                    self._notify(f"{axis} is at its soft limit")
            for axis, share in lock.slid().items():
                if self._may_send(lock, axis):
                    self._jog.slide(axis, share, lock, now)

    def _may_send(self, lock: Interlock, axis: Axis) -> bool:
        if lock.held.trouble:
            return False
        if not lock.unlocked:
            self._notify(f"{lock.name} is locked: {lock.waits_for}")
        elif axis not in self._limits:
            self._notify(f"{axis} is not an axis of this rig")
        elif axis.is_stick:
            self._notify(f"{axis} moves only while a stick is held")
        elif axis not in self.drivers:
            if self.recall:
                self._end_recall(f"{lock.name} moved {axis}")
            return True
        return False

    def _sent(self, now: float, motion: Motion, share: float) -> dict[Axis, Setpoint]:
        """The axes that are on their way to a position, and there; `share` is the speed range, for steps."""
        recall = self.recall
        if recall and not recall.asker.unlocked:
            self._end_recall(f"{recall.asker.name}: {recall.asker.waits_for}")
        elif recall and recall.is_over(motion):
            late = now - recall.begun - recall.seconds
            slow = f" in {late + recall.seconds:.1f} s: its axes go no faster" if late > LATE else ""
            self._end_recall(f"{recall.title} reached{slow}", reached=True)
        return self.recall.setpoints() if self.recall else self._jog.setpoints(now, motion, share)

    def _end_recall(self, why: str, reached: bool = False) -> None:
        assert self.recall is not None
        self._notify(why if reached else f"{self.recall.title} ended: {why}")
        self.recall = None

    def drop_all(self) -> None:
        """Drop all that inputs asked for; what moves comes to rest as soon as it may."""
        self.recall = None
        self._jog.clear()
        self.drivers, self.deflections, self.taken = {}, {}, set()
        for shaping in self._shaping.values():
            shaping.drop()
        self._driven = dict.fromkeys(self._limits)
