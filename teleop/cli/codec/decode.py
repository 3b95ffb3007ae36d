"""`teleop decode`: from bytes to a JSON line for each frame; damage is a line too, nothing ever stops it.

The protocols are rows, `teleop decode r-sdk` the first of them; `teleop decode hid` is in a module of its own.
Hexadecimal input is one stream of bytes however it is cut into lines, so that whole frames, CAN pieces and a capture
with a truncated frame in it can all be pasted. A candump log has a stream for each direction of each bus, whose pieces
must not mix.
"""

from __future__ import annotations

import io
import json
import math
import re
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from teleop.cli.codec.drone_options import KeyFile, Model, cipher_of
from teleop.cli.examples import examples
from teleop.core.errors import UsageError
from teleop.dji.frame import FrameReader
from teleop.dji.json_record import MakeCipher, Transcriber
from teleop.dji.registry import Registry

R_SDK_IDS = ("222", "223")  # from the gimbal, to the gimbal (V2.5 section 3.1); three digits: standard frames

HEX_NOISE = re.compile(r"\b0x|[\s,:;]", re.IGNORECASE)
_CANDUMP = re.compile(r"\((?P<time>\d+\.\d+)\)\s+(?P<bus>\S+)\s+(?P<id>[0-9A-Fa-f]+)#(?P<data>\S*)(\s+[RT])?\s*")

app = App(name="decode", help="Print what bytes mean, a JSON line for each frame.", help_epilogue=examples("decode"))
app.command(
    "teleop.cli.codec.decode_hid:hid",
    name="hid",
    help="Decode input reports of a joystick, a gamepad or a dial.",
    help_epilogue=examples("decode hid"),
)


class InputError(UsageError):
    """A file that cannot be read."""


@app.command(name="r-sdk", help_epilogue=examples("decode r-sdk"))
def r_sdk(
    *text: Annotated[str, Parameter(help="Hexadecimal, or with --candump files; without any, standard input.")],
    candump: Annotated[bool, Parameter(help="Read logs of candump -L or -l.", negative=(), show_default=False)] = False,
) -> None:
    """Decode frames of the handheld gimbal."""
    from teleop.dji.gimbal.r_sdk import R_SDK

    if candump:
        lines = decode_candump(_files(text) if text else standard_input(), R_SDK, R_SDK_IDS)
    else:
        lines = decode_hex(text or standard_input(), R_SDK)
    for line in lines:
        print(line, flush=True)


@app.command(help_epilogue=examples("decode onboard"))
def onboard(
    *text: Annotated[str, Parameter(help="Hexadecimal; without any, standard input.")],
    model: Model = "m100",
    key_file: KeyFile = None,
    parts: Annotated[
        bool,
        Parameter(
            help="List the parts of the broadcast with their units, and decode nothing.",
            negative=(),
            show_default=False,
        ),
    ] = False,
) -> None:
    """Decode frames of the drone's Onboard SDK.

    What an acknowledgement says is known only together with its command: paste both. Encrypted frames need the key. A
    broadcast that stays a value has the layout of the other model.
    """
    from teleop.dji.drone.onboard_sdk import MODELS

    if parts:
        from teleop.cli.codec.broadcast_fields import parts as lines_of_parts

        print(*lines_of_parts(), sep="\n")
        return
    for line in decode_hex(text or standard_input(), MODELS[model], cipher_of(key_file)):
        print(line, flush=True)


def decode_hex(lines: Iterable[str], registry: Registry, cipher: MakeCipher | None = None) -> Iterator[str]:
    """A JSON line for each frame and each run of damage in the bytes that `lines` hold, as soon as it is known."""
    reader, transcriber = FrameReader(), Transcriber(registry, cipher)
    for line in lines:
        try:
            data = bytes.fromhex(HEX_NOISE.sub("", line))
        except ValueError:
            yield not_understood("not hexadecimal", line)
            continue
        for found in reader.feed(data, 0.0):
            yield json.dumps(transcriber.record(found))
    for found in reader.flush(math.inf):
        yield json.dumps(transcriber.record(found))


def decode_candump(lines: Iterable[str], registry: Registry, ids: Iterable[str]) -> Iterator[str]:
    """The same of a candump log, for the CAN frames with these `ids` (as the log writes them)."""
    readers: dict[tuple[str, str], FrameReader] = {}
    transcribers: dict[str, Transcriber] = {}
    wanted = set(ids)
    for line in filter(str.strip, lines):
        parsed = _CANDUMP.fullmatch(line.rstrip("\n"))
        if parsed is None:
            yield not_understood("not a line of candump -L", line)
            continue
        bus, can_id = parsed["bus"], parsed["id"]
        if can_id not in wanted:
            continue
        try:
            data = bytes.fromhex(parsed["data"])
        except ValueError:  # a remote or CAN FD frame, which the protocol does not have
            yield not_understood("not a data frame", line)
            continue
        reader = readers.setdefault((bus, can_id), FrameReader(in_pieces=True))
        transcriber = transcribers.setdefault(bus, Transcriber(registry))
        for found in reader.feed(data, float(parsed["time"])):
            yield json.dumps(transcriber.record(found))
    for (bus, _), reader in readers.items():
        for found in reader.flush(math.inf):
            yield json.dumps(transcribers[bus].record(found))


def standard_input() -> Iterable[str]:
    """Its lines; bytes that are no text are damage like any other, and no exception."""
    if isinstance(sys.stdin, io.TextIOWrapper):
        sys.stdin.reconfigure(errors="replace")
    return sys.stdin


def not_understood(reason: str, line: str) -> str:
    """The JSON line of input that is not even bytes."""
    return json.dumps({"damage": f"{reason}: {line.strip()!r}", "bytes": ""})


def _files(names: Iterable[str]) -> Iterator[str]:
    for name in names:
        try:
            with Path(name).open(encoding="utf-8", errors="replace") as file:
                yield from file
        except OSError as error:
            raise InputError(f"{name}: {error.strerror}") from None
