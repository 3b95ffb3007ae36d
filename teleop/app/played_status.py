"""What a take is to know of the sequence that is played: where in it, what was planned, on which firmware."""

from __future__ import annotations

from teleop.core.axes import Motion, State
from teleop.core.events import Tick
from teleop.devices.gimbal.version import VersionQuestion
from teleop.devices.rig import Rig
from teleop.planner.trajectory import Move
from teleop.recording.played import Played, SequenceFacts
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.fingerprint import fingerprint
from teleop.sequence.source import SequenceSource


class PlayedStatus:
    """An observer, to be called by the recorder after it; `plan` is the sequence without what was learned."""

    def __init__(self, source: SequenceSource, plan: Move, rig: Rig) -> None:
        self._source, self._plan = source, plan
        links = {section.link for section in rig.profile.sinks if section.type == "gimbal"}
        self._versions = {name: VersionQuestion(rig.connections[name]) for name in sorted(links)}
        self._played = Played(None)

    def observe(self, tick: Tick) -> None:
        for question in self._versions.values():
            question.ask(tick.time)
        firmware = {name: each.version for name, each in self._versions.items() if each.version}
        place, plan = self._source.place(tick.time), {}
        if place is not None and self._source.move is not self._plan:
            plan = {axis: state.position for axis, state in self._plan.at(place[1]).items()}
        self._played = Played(place, plan, firmware)

    def __call__(self) -> Played:
        return self._played


def facts_of(sequence: CompiledSequence) -> SequenceFacts:
    """Which sequence it is, and when its keys are."""
    return SequenceFacts(
        fingerprint(sequence), {axis: [key.at for key in keys] for axis, keys in sequence.keys.items()}
    )


def as_planned(source: SequenceSource, plan: Move, tick: Tick) -> Motion:
    """The tick's motion without what a correction has added: what the measured one is to be compared with."""
    place = source.place(tick.time)
    if place is None or source.move is plan:
        return tick.motion
    played, planned = source.move.at(place[1]), plan.at(place[1])
    return {
        axis: State(state.position - played[axis].position + planned[axis].position, *state[1:])
        if axis in planned
        else state
        for axis, state in tick.motion.items()
    }
