"""`teleop encode`: from the JSON lines of `teleop decode` back to the bytes, exactly.

A line of damage gives its bytes back too, so that a decoded capture can be edited and turned into bytes again. The
first line that cannot be encoded ends it with an error that names the line: half a capture is worse than none.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Iterator
from typing import Annotated

from cyclopts import App, Parameter

from teleop.cli.codec.drone_options import KeyFile, Model, cipher_of
from teleop.cli.examples import examples
from teleop.core.errors import TeleopError
from teleop.dji.frame import pieces
from teleop.dji.json_record import MakeCipher, RecordError, restore
from teleop.dji.registry import Registry

app = App(name="encode", help="Print the bytes of frames that teleop decode printed.", help_epilogue=examples("encode"))


@app.command(name="r-sdk", help_epilogue=examples("encode r-sdk"))
def r_sdk(
    *text: Annotated[str, Parameter(help="JSON lines; without any, standard input.")],
    can: Annotated[
        bool, Parameter(help="Print the pieces of 8 bytes that go onto a CAN bus.", negative=(), show_default=False)
    ] = False,
) -> None:
    """Encode frames of the handheld gimbal."""
    from teleop.dji.gimbal.r_sdk import R_SDK

    for line in encode_lines(text or sys.stdin, R_SDK, can):
        print(line, flush=True)


@app.command(help_epilogue=examples("encode onboard"))
def onboard(
    *text: Annotated[str, Parameter(help="JSON lines; without any, standard input.")],
    model: Model = "m100",
    key_file: KeyFile = None,
) -> None:
    """Encode frames of the drone's Onboard SDK."""
    from teleop.dji.drone.onboard_sdk import MODELS

    for line in encode_lines(text or sys.stdin, MODELS[model], cipher=cipher_of(key_file)):
        print(line, flush=True)


def encode_lines(
    lines: Iterable[str], registry: Registry, can: bool = False, cipher: MakeCipher | None = None
) -> Iterator[str]:
    """The bytes of each JSON line in hexadecimal; with `can`, a line for each piece.

    Raises RecordError naming the line that cannot be encoded.
    """
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        try:
            data = restore(registry, json.loads(line), cipher)
        except json.JSONDecodeError as error:
            raise RecordError(f"line {number}: not JSON: {error.msg} at column {error.colno}") from None
        except TeleopError as error:
            raise RecordError(f"line {number}: {error}") from None
        if data:
            yield from (piece.hex() for piece in (pieces(data) if can else (data,)))
