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
import tempfile
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self, cast

from teleop.app.program import BusyError, EventJob, JogJob, MoveJob, SourceJob, StoppedError
from teleop.app.session import Session, shortest_seconds
from teleop.config.document import DocumentError, UnplayableError
from teleop.config.profile import Profile, load_profile
from teleop.core.axes import Axis, State
from teleop.core.errors import DeviceError, LinkError, TeleopError, UsageError
from teleop.core.events import Action
from teleop.core.run_state import Result
from teleop.monitors.tracking_error import Score, TrackingErrorMonitor
from teleop.planner.polynomial import Array
from teleop.recording.reader import Take
from teleop.sequence.compile import CompiledSequence, load_sequence

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from teleop.planner.trajectory import Peaks

__all__ = [
    "AxisReport",
    "BusyError",
    "DeviceError",
    "DocumentError",
    "LinkError",
    "Move",
    "Report",
    "Rig",
    "State",
    "StoppedError",
    "Take",
    "TeleopError",
    "UnplayableError",
    "UsageError",
    "open",
    "plan",
    "read_take",
]

Source = str | Path | Mapping[str, Any]
"""A sequence: a shipped one's name, a file, or the content of one as a dict."""


@dataclass(frozen=True, eq=False)
class Move:
    """A sequence compiled for a rig: what every axis does at every time, checked against the rig's limits."""

    compiled: CompiledSequence
    profile: Profile

    @property
    def title(self) -> str:
        return self.compiled.title

    @property
    def axes(self) -> tuple[Axis, ...]:
        return tuple(self.compiled.move.tracks)

    @property
    def duration(self) -> float:
        """Seconds from 0 to the end of the motion."""
        return self.compiled.move.duration

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the planner remarks on, a line each."""
        return tuple(self.compiled.warnings)

    def at(self, time: float) -> dict[Axis, State]:
        """The state of each axis, `State(position, velocity, acceleration)`, `time` s after the start."""
        return self.compiled.move.at(time)

    def sample(self, times: Array) -> dict[Axis, Array]:
        """For each axis an array (4, n): rows position, velocity, acceleration and jerk at `times` (n,), in s."""
        import numpy as np

        return self.compiled.move.sample(np.asarray(times, float))

    def peaks(self) -> dict[Axis, Peaks]:
        """The exact extremes of each axis: velocity, acceleration, jerk, and the range of positions."""
        return self.compiled.move.peaks()

    def plot(self) -> Figure:
        """A matplotlib figure with a panel each for position, velocity, acceleration and jerk (extra `plot`)."""
        from teleop.plots.drawing import figure

        return figure(self.compiled, self.profile)

    def _repr_html_(self) -> str:
        """The interactive preview, for a notebook."""
        from html import escape

        from teleop.plots.page import page

        text = escape(page(self.compiled, self.profile), quote=True)
        return f'<iframe srcdoc="{text}" style="width: 100%; height: 720px; border: 0"></iframe>'


@dataclass(frozen=True)
class AxisReport:
    """How far the readings of one axis were from what was commanded at their time, in units."""

    readings: int
    rms: float
    peak: float


@dataclass(frozen=True)
class Report:
    """How a run went. `ok` is True when it reached its end; else `reason` says what ended it."""

    ok: bool
    reason: str
    seconds: float
    axes: Mapping[str, AxisReport]
    take: Path | None = None


def plan(sequence: Source, rig: str | Path = "sim") -> Move:
    """The move that `sequence` makes on `rig` (a shipped profile's name, or a file); nothing is opened.

    For a timelapse this is the rehearsal, at the speed of its clip. Raises DocumentError with a line for each mistake
    in the file, UnplayableError when the rig cannot make the move.
    """
    profile = load_profile(str(rig))
    return Move(_compiled(sequence, profile), profile)


def read_take(file: str | Path) -> Take:
    """A recorded run: `times` (n,), `motion` and `measured` as arrays by axis. Raises DocumentError."""
    from teleop.recording.reader import read_take as read

    return read(Path(file))


def open(  # noqa: A001 - `teleop.open` reads well, and nothing here opens files
    rig: str | Path = "sim", links: Mapping[str, str] | None = None, *, virtual: bool = False
) -> Rig:
    """Open `rig` (a shipped profile's name, or a file), with other URLs for some of its `links`.

    On the `virtual` clock, which needs `sim:` links, hours pass in seconds, and the same program gives the same motion.
    Raises DocumentError for a bad profile, LinkError and DeviceError when a device does not answer.
    """
    profile = load_profile(str(rig), links)
    if virtual:
        _refuse_real_links(profile)
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

    def move(self, *, seconds: float | None = None, **axes: float) -> None:
        """Move to positions (degrees; focus 0..1) and wait until the rig is there.

        All axes arrive together after `seconds`, or as soon as the limits allow. Raises UsageError for an unknown axis,
        a position beyond a soft limit, or a time that is too short; StoppedError when STOP ends it.
        """
        targets = self._known(axes, "move")
        for axis, target in targets.items():
            limits = self._session.profile.limits[axis]
            if not (limits.minimum <= target <= limits.maximum and math.isfinite(target)):
                raise UsageError(
                    f"move: {axis}={target:g} is beyond its soft limits, {limits.minimum:g} to {limits.maximum:g}"
                )
        if seconds is not None:
            if not 0 <= seconds < math.inf:
                raise UsageError(f"move: seconds={seconds:g} must be a time, 0 or longer")
            self._session.check()
            least = shortest_seconds(self._session, targets)
            if seconds < least - 1e-6:
                least = math.ceil(least * 100) / 100  # what is named is long enough
                raise UsageError(f"move: seconds={seconds:g} is too short: this move needs {least:.2f} s")
        self._session.run(MoveJob(targets, seconds))

    def jog(self, *, seconds: float, **axes: float) -> None:
        """Move at velocities (degrees/s; focus 1/s) for `seconds`, then stop; soft limits hold.

        Raises UsageError for an unknown axis or a velocity beyond its limit; StoppedError when STOP ends it.
        """
        velocities = self._known(axes, "jog")
        for axis, velocity in velocities.items():
            most = self._session.profile.limits[axis].velocity
            if not abs(velocity) <= most:
                raise UsageError(f"jog: {axis}={velocity:g} is faster than its limit, {most:g}")
        if not 0 < seconds < math.inf:
            raise UsageError(f"jog: seconds={seconds:g} must be above 0")
        self._session.run(JogJob(velocities, seconds))

    def play(self, sequence: Source | Move, *, take: str | Path | None = None, speed: float = 1.0) -> Report:
        """Ease to the first keyframe, play the move, and report how well the rig followed.

        `take` records the run to a new .mcap file; `speed` is the share of the written speed. What ends the move early
        (a fault, a STOP) is in the report: `ok` is False and `reason` says why. Raises DocumentError and
        UnplayableError for a sequence that this rig cannot play.
        """
        from teleop.planner.keyframes.findings import PlanError
        from teleop.sequence.source import SequenceSource

        if not 0 < speed < math.inf:
            raise UsageError(f"play: speed={speed:g} must be above 0")
        self._session.check()
        compiled = sequence.compiled if isinstance(sequence, Move) else _compiled(sequence, self._session.profile)
        self._refuse(compiled)
        try:
            source = SequenceSource(compiled, self._session.profile.limits, speed)
        except PlanError as error:
            raise UnplayableError([f"speed {speed:g}: {error}"]) from None
        monitor = TrackingErrorMonitor(lambda: source.begin)
        if self.stopped:
            return _report(compiled, monitor, "STOPPED: call clear() first", None)
        reason, result = "", Result.INTERRUPTED
        with self._recorded(take, compiled.title) as recorder:
            try:
                self._session.run(SourceJob(source), (monitor,) if recorder is None else (monitor, recorder))
                result = Result.DONE
            except StoppedError as error:
                reason = str(error)
            except (DeviceError, LinkError) as error:
                reason, result = str(error), Result.FAILED
            finally:
                if recorder is not None:
                    recorder.finish(result, [reason] if reason else [])
        return _report(compiled, monitor, reason, None if take is None else Path(take))

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
        camera = self._session.rig.camera
        if camera is None:
            raise UsageError(f"{self.name} has no camera: add {{type: camera, link: ...}} to its sinks")
        self._session.run(EventJob(action, lambda: camera.waiting))

    def _known(self, axes: Mapping[str, float], call: str) -> dict[Axis, float]:
        if not axes:
            raise UsageError(f"{call}: name an axis: {', '.join(self._session.axes)}")
        unknown = [name for name in axes if name not in self._session.axes]
        if unknown:
            raise UsageError(f"{call}: {self.name} has no axis {unknown[0]}; it has {', '.join(self._session.axes)}")
        try:
            return {Axis(name): float(value) for name, value in axes.items()}
        except (TypeError, ValueError):
            raise UsageError(f"{call}: every axis needs a number") from None

    def _refuse(self, compiled: CompiledSequence) -> None:
        if flown := [axis for axis in compiled.move.tracks if axis.is_stick]:
            raise UsageError(f"play: {', '.join(flown)} fly a drone, which needs an operator: use `teleop play`")
        if missing := [axis for axis in compiled.move.tracks if axis not in self._session.axes]:
            raise UnplayableError([f"{compiled.title}: {self.name} has no axis {', '.join(missing)}"])

    @contextmanager
    def _recorded(self, take: str | Path | None, title: str) -> Generator[Any]:
        from teleop.recording.writer import recording

        limits = {axis: self._session.profile.limits[axis] for axis in self._session.axes}
        path = None if take is None else Path(take)
        with recording(path, self.name, title, limits, patient=self._session.is_virtual) as recorder:
            yield recorder


def _report(compiled: CompiledSequence, monitor: TrackingErrorMonitor, reason: str, take: Path | None) -> Report:
    """Of a run that ended for `reason`, "" for its own end; it has every axis of the move, and no other."""
    axes: dict[str, AxisReport] = {}
    for axis in compiled.move.tracks:
        score = monitor.scores.get(axis, Score())
        axes[axis.value] = AxisReport(score.readings, score.rms, score.peak)
    return Report(not reason, reason, monitor.seconds, axes, take)


def _compiled(sequence: Source, profile: Profile) -> CompiledSequence:
    """The sequence for the rig of `profile`; of a timelapse its rehearsal."""
    if isinstance(sequence, Mapping):
        return _compiled_content(sequence, profile)
    from teleop.timelapse.compile import load_timelapse

    if timelapse := load_timelapse(str(sequence), profile.limits, profile.name):
        return timelapse.rehearsal()
    devices = [sink.type for sink in profile.sinks]
    return load_sequence(str(sequence), profile.limits, profile.name, devices)


def _compiled_content(content: Mapping[str, Any], profile: Profile) -> CompiledSequence:
    """A dict is written out as YAML and read as a file is, so that every check and every default is the same."""
    import yaml

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "sequence.yaml"
        try:
            text = yaml.safe_dump(_plain(content), sort_keys=False)
        except yaml.YAMLError as error:
            raise UsageError(f"sequence: {' '.join(map(str, error.args))}") from None
        file.write_text(text, encoding="utf-8")
        try:
            return _compiled(file, profile)
        except DocumentError as error:
            problems = [problem.replace(str(file), "sequence") for problem in error.problems]
            raise type(error)(problems, error.more) from None


def _plain(value: Any) -> Any:
    """What YAML can hold, from mappings, sequences and numbers of any kind (numpy's included)."""
    if isinstance(value, Mapping):
        return {str(key): _plain(each) for key, each in cast("Mapping[Any, Any]", value).items()}
    if isinstance(value, str | Path):
        return str(value)
    if isinstance(value, list | tuple):
        return [_plain(each) for each in cast("list[Any]", value)]
    return value.tolist() if hasattr(value, "tolist") else value


def _refuse_real_links(profile: Profile) -> None:
    from teleop.links import parse

    if real := [f"{name}={url}" for name, url in profile.links.items() if parse(url).kind != "sim"]:
        raise UsageError(f"virtual=True: {', '.join(real)} keeps its own time; only sim: links can be virtual")
