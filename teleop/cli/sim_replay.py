"""`teleop sim --replay`: a capture becomes a gimbal that answers as the captured one did."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from teleop.captures.captured import Captured, CaptureError, Source
from teleop.captures.reader import read
from teleop.cli.sim_dynamics import DYNAMICS_DEFAULTS, DynamicsSim
from teleop.cli.sim_options import GIMBAL_DEFAULTS, GimbalSim
from teleop.core.errors import UsageError
from teleop.dji.frame import Damage, Frame, FrameReader
from teleop.dji.gimbal import messages as gimbal
from teleop.links.can import GIMBAL_ID, HOST_ID
from teleop.sim.gimbal.captured_gimbal import CapturedGimbal, Heard, learn


def replayed(file: Path, options: GimbalSim, dynamics: DynamicsSim) -> CapturedGimbal:
    """The gimbal of the capture `file`. Raises CaptureError, UsageError for options that a replay cannot have."""
    own = {name for name in vars(options) if getattr(options, name) != getattr(GIMBAL_DEFAULTS, name)}
    moved = {name for name in vars(dynamics) if getattr(dynamics, name) != getattr(DYNAMICS_DEFAULTS, name)}
    if refused := sorted((own | moved) - {"foreign_traffic"}):
        option = refused[0].replace("_", "-")
        raise UsageError(f"--{option}: not with --replay, which answers as the captured gimbal did")
    learned = learn(_heard(file))
    if learned is None:
        raise CaptureError(f"{file}: no gimbal traffic: no frame of a gimbal on CAN id {GIMBAL_ID:#x}")
    return learned


def facts(file: Path, captured: CapturedGimbal) -> dict[str, Any]:
    """What was learned, for programs."""
    version = captured.last_reply(gimbal.VersionReply)
    limits = captured.last_reply(gimbal.LimitsReply)
    period, named = captured.push_period, captured.names_commands
    return {
        "replay": str(file),
        "seconds": round(captured.end - captured.start, 3),
        "requests": len(captured.exchanges),
        "replies": sum(len(exchange.replies) for exchange in captured.exchanges),
        "version": version.fields()["version"] if version else None,
        "limits": {key: value for key, value in limits.fields().items() if key != "return_code"} if limits else None,
        "bare_replies": None if named is None else not named,
        "push_rate": round(1 / period, 1) if period else None,
    }


def summary(file: Path, captured: CapturedGimbal) -> str:
    """The same for people, in a line."""
    known = facts(file, captured)
    parts = [f"{known['requests']} requests", f"{known['replies']} replies"]
    parts.append(f"version {known['version'] or 'not captured'}")
    if known["bare_replies"]:
        parts.append("replies without set and id")
    if known["push_rate"]:
        parts.append(f"pushes at {known['push_rate']:g} Hz")
    return f"replaying {file}: {known['seconds']:.1f} s, {', '.join(parts)}; angles are those captured"


def _heard(file: Path) -> Iterator[Heard]:
    """The frames of host and gimbal on the first bus that has a gimbal."""
    from_gimbal = (source for source, frame in read(file) if _is_of(source, frame, GIMBAL_ID))
    bus = next(from_gimbal, None)
    if bus is None:
        return
    readers = {can_id: FrameReader(in_pieces=True) for can_id in (HOST_ID, GIMBAL_ID)}
    last = 0.0
    for source, frame in read(file):
        if source == bus and any(_is_of(source, frame, can_id) for can_id in readers):
            last = frame.time
            yield from _frames(frame.id, last, readers[frame.id].feed(frame.data, last))
    for can_id, reader in readers.items():
        yield from _frames(can_id, last, reader.flush(math.inf))


def _is_of(source: Source, frame: Captured, can_id: int) -> bool:
    is_ordinary = not (frame.extended or frame.remote or frame.error)
    return source.kind == "can" and is_ordinary and frame.id == can_id


def _frames(can_id: int, time: float, found: list[Frame | Damage]) -> Iterator[Heard]:
    for each in found:
        if isinstance(each, Frame):
            yield Heard(time, can_id == GIMBAL_ID, each)
