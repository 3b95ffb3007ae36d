"""The operator's controls of a sequence that plays: pause, resume, faster, slower, from key to key, go, end and trim.

A key asks; `Playback` decides what becomes of it and when, and `LiveOffset` where an axis is trimmed to. The
`StopGuard` above it handles a STOP: it suspends all of this and resumes it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from teleop.core.axes import Axis, Motion, State
from teleop.core.errors import Interrupted
from teleop.core.events import SourceEvent, TickEvent
from teleop.core.interfaces import Feedback
from teleop.core.operator_input import Command, Input, Press
from teleop.core.run_status import Hint, RunStatus
from teleop.core.setpoints import Demand, StateTarget
from teleop.manual.live_offset import LiveOffset
from teleop.sequence.phases import SequencePhase
from teleop.sequence.progress import run_status
from teleop.sequence.source import SequenceSource

SPEED_STEP = 0.1  # of the written speed, by which a key changes it
KEYS_PERIOD = 0.05  # s between two looks at the keys while nothing moves
HINTS = (Hint("space", "STOP"), Hint("p", "pause"), Hint("q", "end"), Hint("- +", "speed"), Hint("< >", "key"))
WAITING_HINTS = (Hint("enter", "continue"), Hint("space", "STOP"), Hint("q", "end"))
HELP = "space STOP  p pause  - + speed  < > key  q end"
WAITING_HELP = "enter continue  space STOP  q end"
ARMED_HELP = "enter start  space STOP  q end"
TRIM_HELP = "arrows hjkl [ ] ( ) trim  v its speed  z to 0  w write"


class PlaybackControls:
    """`sequence` under `keys`, None for no terminal, and the inputs of `trimming`, of which the keys are one.

    `keep` writes the trim as it is now, and returns a line for the operator.
    """

    def __init__(
        self,
        sequence: SequenceSource,
        keys: Input | None,
        trimming: LiveOffset | None = None,
        keep: Callable[[], str] | None = None,
    ) -> None:
        self._sequence, self._keys, self._trimming, self._keep = sequence, keys, trimming, keep
        self._note = self._stopped = ""
        self._lost_pauses = False  # for a lost input
        self._noted = sequence.phase  # when that was
        playback = sequence.playback
        self._actions: Mapping[Command, Callable[[float], None]] = {
            Command.PAUSE: self._pause,
            Command.SLOWER: lambda now: self._change_speed(-SPEED_STEP, now),
            Command.FASTER: lambda now: self._change_speed(SPEED_STEP, now),
            Command.NEXT: lambda now: playback.step(1, now),
            Command.PREVIOUS: lambda now: playback.step(-1, now),
        }

    @property
    def note(self) -> str:
        """What the operator is to know now, in a line or two."""
        playback = self._sequence.playback
        speed = f"{playback.chosen:.0%}"
        if playback.paused:
            speed = "paused" if playback.chosen == 1 else f"paused, continues at {speed}"
        line = ARMED_HELP if self._sequence.phase is SequencePhase.ARMED else f"{speed}  {HELP}"
        line = WAITING_HELP if self._sequence.waiting else line
        line = f"{self._sequence.missed}: {line}" if self._sequence.missed else line
        line = playback.refusal or self._note or (line if self._keys else "no terminal: Ctrl-C stops")
        return line if self._trimming is None else f"{line}\n{self._trim_note(self._trimming)}"

    def status(self, now: float) -> RunStatus:
        """What a view shows of the run at `now`; for the control thread."""
        status, playback = run_status(self._sequence, now), self._sequence.playback
        note = playback.refusal or self._note or self._sequence.missed
        if self._trimming:
            note = f"{note}\n{self._trim_note(self._trimming)}".strip()
        hints = HINTS if self._keys else ()
        if self._keys and (self._sequence.waiting or self._sequence.phase is SequencePhase.ARMED):
            hints = WAITING_HINTS
        return replace(status, note=note, hints=hints)

    def start(self, now: float, motion: Motion) -> None:
        self._sequence.start(now, motion)
        self._noted = self._sequence.phase

    @property
    def resumable(self) -> bool:
        return not self._sequence.moves_drone

    @property
    def pauses(self) -> bool:
        return self._sequence.phase is SequencePhase.PLAYING

    busy, quits = False, True  # nothing that it has begun has to be ended

    def pause(self, now: float) -> bool | None:
        playback = self._sequence.playback
        if not self._lost_pauses and not playback.paused:
            self._lost_pauses = True
            playback.pause(now)
        elif playback.paused or not playback.changing(now):
            self._lost_pauses = False
            return playback.paused
        return None

    def suspend(self, now: float) -> None:
        self._lost_pauses = False
        self._sequence.suspend(now)
        if self._trimming:
            self._trimming.halt()

    def linger(self, now: float) -> Sequence[TickEvent]:  # noqa: ARG002 - nothing has been begun
        return ()

    def resume(self, now: float, motion: Motion) -> None:
        offsets: Mapping[Axis, State] = self._trimming.offsets if self._trimming else {}
        bare = {axis: State(each.position - offsets.get(axis, State(0.0)).position) for axis, each in motion.items()}
        self._note = ""
        self._sequence.resume(now, bare)

    def read(self, now: float, feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        """Raises Interrupted once an operator has ended it."""
        self._check_keys(now)
        if self._stopped:
            raise Interrupted(self._stopped)
        demand, acts = self._sequence.read(now, feedback)
        if self._noted is not self._sequence.phase:
            self._note, self._noted = "", self._sequence.phase
        if self._trimming:
            demand = self._trimmed(self._trimming, demand)
        return demand, acts

    def next_change(self, now: float) -> float:
        change = self._sequence.next_change(now)
        if math.isinf(change):
            return change
        return now if self._trimming else min(change, now + KEYS_PERIOD)

    def _check_keys(self, now: float) -> None:
        if self._trimming is None:
            for press in self._keys.read(now).presses if self._keys else ():
                self._handle(press, now)
            return
        for name, press in self._trimming.read(now):
            if not self._turn_trim(self._trimming, name, press):
                self._handle(press, now)

    def _handle(self, press: Press, now: float) -> None:
        self._note = ""
        if press.command is Command.QUIT:
            name = press.by or (self._keys.name if self._keys else "hand")
            self._stopped = self._stopped or f"stopped by {name}"
        elif press.command is Command.GO or (press.command is Command.PAUSE and self._sequence.waiting):
            self._sequence.go()
        elif press.command not in self._actions:
            self._note = f"{press.command}: not available while a sequence plays"
        elif self._sequence.phase is not SequencePhase.PLAYING:
            self._note = "the move has not begun"
        elif self._sequence.waiting and press.command in (Command.NEXT, Command.PREVIOUS):
            self._note = f"the move is waiting: {WAITING_HELP}"
        else:
            self._actions[press.command](now)

    def _turn_trim(self, trimming: LiveOffset, name: str, press: Press) -> bool:
        """Whether it was for the trim. On a device, slower and faster are; the keys have them for the move."""
        by_keys = self._keys is not None and name == self._keys.name
        match press.command:
            case Command.RECENTER:
                trimming.release(name)
            case Command.RANGE:
                trimming.change_range(1, around=True)
            case Command.SLOWER | Command.FASTER if not by_keys:
                trimming.change_range(1 if press.command is Command.FASTER else -1)
            case Command.KEEP:
                self._note = self._keep() if self._keep else "trim not written: give --trim-out"
            case _:
                return False
        return True

    def _trimmed(self, trimming: LiveOffset, demand: Demand) -> Demand:
        states = {axis: State(*setpoint) for axis, setpoint in demand.items() if isinstance(setpoint, StateTarget)}
        return {axis: StateTarget(*state) for axis, state in trimming.step(states, self._trims).items()}

    @property
    def _trims(self) -> bool:
        """Not on the way to the first start, nor once all is over."""
        phase = self._sequence.phase
        return phase is not SequencePhase.OVER and not (phase is SequencePhase.EASING and self._sequence.number == 1)

    def _trim_note(self, trimming: LiveOffset) -> str:
        message = f"  {trimming.messages[0].text}" if trimming.messages else ""
        if not self._trims:
            return f"the trim begins once the rig is at the start{message}\n{TRIM_HELP}"
        offsets = "  ".join(f"{axis} {round(o.position, 3) + 0.0:+.3f}" for axis, o in trimming.offsets.items())
        return f"trim at {trimming.share:.0%}  {offsets}{message}\n{TRIM_HELP}"

    def _pause(self, now: float) -> None:
        playback = self._sequence.playback
        if self._sequence.moves_drone:
            self._note = f"a drone keeps flying while its sticks are paused: {HELP}"
            return
        (playback.resume if playback.paused else playback.pause)(now)

    def _change_speed(self, share: float, now: float) -> None:
        playback = self._sequence.playback
        chosen = max(SPEED_STEP, round(playback.chosen / SPEED_STEP) * SPEED_STEP + share)
        playback.speed(min(chosen, playback.at_most) if chosen > playback.chosen else chosen, now)
