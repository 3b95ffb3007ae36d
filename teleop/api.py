"""The Python API: plan a move, open a rig, move it, play sequences, read takes.

    import teleop

    move = teleop.plan("reveal", rig="sim")
    with teleop.open("sim") as rig:
        rig.move(pan=30, tilt=5, seconds=2)
        report = rig.play("reveal")

Angles are degrees, focus is 0 (near) .. 1 (far), times are seconds. Everything here may be called from any thread; one
thread at a time moves a rig. Nothing is printed, and no terminal or signal handler is touched.
"""

# pyright: strict

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self, cast

from teleop.app.clocks import real_links
from teleop.app.move import Move, Samples
from teleop.app.planning import plan_content, plan_file
from teleop.app.program import BusyError, EventJob, JogJob, MoveJob, StoppedError
from teleop.app.session import Session
from teleop.app.session_play import AxisReport, Passes, Report, play
from teleop.config.documents.document import DocumentError, UnplayableError
from teleop.config.profile import Profile, load_profile
from teleop.core.axes import STICKS, Axis, State
from teleop.core.errors import DeviceError, LinkError, TeleopError, UsageError
from teleop.core.events import Action
from teleop.core.response import Response
from teleop.planner.shortest import shortest_seconds
from teleop.recording.reader import Take

if TYPE_CHECKING:
    from teleop.studio.api import Rigs

__all__ = [
    "AxisReport",
    "BusyError",
    "DeviceError",
    "DocumentError",
    "LinkError",
    "Move",
    "Report",
    "Response",
    "Rig",
    "Samples",
    "State",
    "StoppedError",
    "Take",
    "TeleopError",
    "UnplayableError",
    "UsageError",
    "fleet",
    "open",
    "plan",
    "read_take",
]

Source = str | Path | Mapping[str, Any]
"""A sequence: a shipped one's name, a file, or the content of one as a dict."""


def plan(sequence: Source, rig: str | Path = "sim") -> Move:
    """The move that `sequence` makes on `rig` (a shipped profile's name, or a file); nothing is opened.

    For a timelapse this is the rehearsal, at the speed of its clip. Raises DocumentError with a line for each mistake
    in the file, UnplayableError when the rig cannot make the move.
    """
    profile = load_profile(str(rig))
    return _planned(sequence, profile)


def read_take(file: str | Path) -> Take:
    """A recorded run: `times` (n,), `motion` and `measured` as arrays by axis. Raises DocumentError."""
    from teleop.recording.reader import read_take as read

    return read(Path(file))


def fleet(connect: Sequence[str], *, credentials: str | Path | None = None, name: str = "") -> Rigs:
    """Several rigs, at the endpoints in `connect` (rigs and routers), to be used in a `with` block.

    `credentials` is the operator's file from `teleop fleet keys`; rigs on this computer need none. `name` is what the
    holder of control is called. Raises UsageError without the packages: `pip install 'rs-teleop[fleet]'`.
    """
    from teleop.studio.api import Rigs

    return Rigs(connect, credentials, name)


def open(  # noqa: A001 - `teleop.open` reads well, and nothing here opens files
    rig: str | Path = "sim", links: Mapping[str, str] | None = None, *, virtual: bool = False
) -> Rig:
    """Open `rig` (a shipped profile's name, or a file), with other URLs for some of its `links`.

    On the `virtual` clock, which needs `sim:` links, hours pass in seconds, and the same program gives the same motion.
    Raises DocumentError for a bad profile, LinkError and DeviceError when a device does not answer.
    """
    profile = load_profile(str(rig), links)
    if virtual and (real := real_links(profile)):
        raise UsageError(f"virtual=True: {', '.join(real)} runs in real time; only sim: links can be virtual")
    return Rig(Session(profile, virtual))


class Rig:
    """An open rig: use it in a `with` block.

    However the block is left (its end, an exception, Ctrl-C), axes ramp to rest, devices are released and links are
    closed. A fault of a device ends the run in the same way; every later call then raises DeviceError with the reason.
    """

    def __init__(self, session: Session) -> None:
        self._session = session

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Ramp to rest, release every device, close the links. Leaving the `with` block does this."""
        self._session.close()

    @property
    def name(self) -> str:
        return self._session.profile.name

    @property
    def axes(self) -> tuple[Axis, ...]:
        return tuple(self._session.axes)

    @property
    def stopped(self) -> bool:
        """Whether a STOP is latched."""
        return self._session.program.stopped

    def angles(self) -> dict[str, float]:
        """The last measured position of every axis, by its name: degrees, and 0..1 for focus."""
        self._session.check()
        tick = self._session.program.tick
        if tick is None:
            return {}
        reported = tick.reported
        return {axis.value: reported[axis].position for axis in self._session.axes if axis in reported}

    def responses(self) -> dict[str, Response]:
        """How each axis answers its commands, by its name: delay (s), gain, drift (deg/s), each with its doubt.

        Only of axes in the modes speed and stick, once they have moved enough. It is kept for later runs, except on the
        virtual clock.
        """
        return {axis.value: response for axis, response in self._session.rig.responses.items()}

    def move(self, *, seconds: float | None = None, **axes: float) -> None:
        """Move to positions (degrees; focus 0..1) and wait until the rig is there.

        All axes arrive together after `seconds`, or as soon as the limits allow. Raises UsageError for an unknown axis,
        a position beyond a soft limit, or a time that is too short; StoppedError when STOP ends it.
        """
        targets = self._known(axes, "move")
        for axis, target in targets.items():
            limits = self._session.profile.limits[axis]
            if not limits.minimum <= target <= limits.maximum:
                raise UsageError(
                    f"move: {axis}={target:g} is outside the soft limits, {limits.minimum:g} to {limits.maximum:g}"
                )
        if seconds is not None:
            seconds = _number("move: seconds", seconds)
            if seconds < 0:
                raise UsageError(f"move: seconds={seconds:g} must be 0 or longer, or None for as soon as possible")
            self._refuse_haste(targets, seconds)
        self._session.run(MoveJob(targets, seconds))

    def jog(self, *, seconds: float, **axes: float) -> None:
        """Move at velocities (degrees/s; focus 1/s) for `seconds`, then stop; soft limits hold.

        Raises UsageError for an unknown axis or a velocity beyond its limit; StoppedError when STOP ends it.
        """
        velocities = self._known(axes, "jog")
        for axis, velocity in velocities.items():
            most = self._session.profile.limits[axis].velocity
            if abs(velocity) > most:
                raise UsageError(f"jog: {axis}={velocity:g} exceeds the velocity limit, {most:g}")
        if (seconds := _number("jog: seconds", seconds)) <= 0:
            raise UsageError(f"jog: seconds={seconds:g} must be above 0")
        self._session.run(JogJob(velocities, seconds))

    def play(
        self,
        sequence: Source | Move,
        *,
        take: str | Path | None = None,
        speed: float = 1.0,
        passes: int = 1,
        learn: bool | str | Path = False,
        learned: str | Path | None = None,
    ) -> Report:
        """Ease to the first keyframe, play the move, and report how well the rig followed.

        `take` records the run to a new .mcap file; `speed` is the share of the written speed. What ends the move early
        (a fault, a STOP) is in the report: `ok` is False and `reason` says why.

        With `learn` each of the `passes` is corrected by the error of those before it, and the best correction kept in
        a file: the one named, or with True beside the `take`. `learned` plays with such a file. Raises DocumentError
        and UnplayableError for a sequence that this rig cannot play.
        """
        if (speed := _number("play: speed", speed)) <= 0:
            raise UsageError(f"play: speed={speed:g} must be above 0")
        self._session.check()
        move = sequence if isinstance(sequence, Move) else _planned(sequence, self._session.profile)
        file = None if take is None else Path(take)
        return play(self._session, move, file, speed, _passes(passes, learn, learned, file, speed))

    def record(self) -> None:
        """Start recording on the camera; returns once it has confirmed. Raises DeviceError when it refuses."""
        self._camera(Action.RECORD)

    def stop_recording(self) -> None:
        """Stop recording; returns once the camera has confirmed. Raises DeviceError when it refuses."""
        self._camera(Action.STOP)

    def shutter(self) -> None:
        """Take one picture; returns once the camera has confirmed. Raises DeviceError when it refuses."""
        self._camera(Action.SHUTTER)

    def stop(self) -> None:
        """STOP, from any thread: every axis to rest at the fastest legal rate. Latched until `clear()`.

        It is no emergency stop: the motors stay powered.
        """
        self._session.program.stop()

    def clear(self) -> None:
        """Clear a STOP, so that the rig may move again."""
        self._session.program.clear()

    def _camera(self, action: Action) -> None:
        self._session.check()
        if self._session.rig.camera is None:
            raise UsageError(f"{self.name} has no camera: add {{type: camera, link: ...}} to its sinks")
        self._session.run(EventJob(action, self._session.camera_waiting))

    def _known(self, axes: Mapping[str, float], call: str) -> dict[Axis, float]:
        if not axes:
            raise UsageError(f"{call}: name an axis: {', '.join(self._session.axes)}")
        if flown := [name for name in axes if name in STICKS]:
            raise UsageError(f"{call}: {flown[0]} flies a drone, which needs an operator: use `teleop live`")
        unknown = [name for name in axes if name not in self._session.axes]
        if unknown:
            raise UsageError(f"{call}: {self.name} has no axis {unknown[0]}; it has {', '.join(self._session.axes)}")
        return {Axis(name): _number(f"{call}: {name}", value) for name, value in axes.items()}

    def _refuse_haste(self, targets: Mapping[Axis, float], seconds: float) -> None:
        """Raises UsageError where the limits do not allow the move in so short a time."""
        self._session.check()
        tick = self._session.program.tick
        least = 0.0 if tick is None else shortest_seconds(tick.motion, targets, self._session.profile.limits)
        if seconds < least - 1e-6:
            least = math.ceil(least * 100) / 100  # what is named is long enough
            raise UsageError(f"move: seconds={seconds:g} is too short: this move needs {least:.2f} s")

    def __repr__(self) -> str:
        return f"<Rig {self.name}: {', '.join(self._session.axes)}>"


def _passes(
    count: int, learn: bool | str | Path, learned: str | Path | None, take: Path | None, speed: float
) -> Passes:
    """Raises UsageError for what does not go together."""
    if count < 1:
        raise UsageError(f"play: passes={count} must be at least 1")
    if learn and count < 2:
        raise UsageError("play: learn: needs passes to learn from, as in passes=3")
    if (learn or learned) and speed != 1:
        raise UsageError("play: learn and learned: leave out speed")
    if learn is True and take is None:
        raise UsageError("play: learn=True: give take, or the file to keep the correction in")
    file = None if learn is False else take.with_suffix(".learned.json") if learn is True and take else Path(str(learn))
    known = None if learned is None else Path(learned)
    if file is not None and file.exists() and file != known:
        raise UsageError(f"play: learn: {file} already exists; go on from it with learned=")
    return Passes(count, file, known)


def _number(place: str, value: float) -> float:
    """`value` as a float; raises UsageError for anything but a finite number."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise UsageError(f"{place}={value!r} must be a number") from None
    if not math.isfinite(number):
        raise UsageError(f"{place}={number:g} must be a finite number")
    return number


def _planned(sequence: Source, profile: Profile) -> Move:
    """The sequence for the rig of `profile`; of a timelapse its rehearsal."""
    if isinstance(sequence, Mapping):
        plan = plan_content(sequence, profile)
    elif isinstance(cast("object", sequence), str | Path):
        plan = plan_file(str(sequence), profile)
    else:
        raise UsageError("sequence: must be a name, a file or a dict")
    return Move(plan.sequence, profile)
