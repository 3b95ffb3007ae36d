"""Reads files of C++ libraries in a process of its own: what such a library does with bad bytes is not all Python's.

The child has bounded memory and time, and answers in JSON; one that crashes is an error in one line. It is
`python -m teleop.interchange.isolated MODULE FILE`; the module's `extract(path)` gives what it prints.
"""

from __future__ import annotations

import importlib
import json
import subprocess
import sys
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import Any

from teleop.config.documents.document import DocumentError

LONGEST = 60.0  # s
MOST_MEMORY = 4 << 30  # bytes of address space


class ExtractError(Exception):
    """What is wrong with a file, in words that follow its name."""


def read_isolated(module: str, raw: bytes, ending: str, name: str) -> Any:
    """What the module's `extract` finds in a file of these bytes. Raises DocumentError."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"file{ending}"
        file.write_bytes(raw)
        command = [sys.executable, "-m", "teleop.interchange.isolated", module, str(file)]
        try:
            done = subprocess.run(command, capture_output=True, timeout=LONGEST, check=False, cwd=folder)
        except subprocess.TimeoutExpired:
            raise DocumentError([f"{name}: took longer than {LONGEST:g} s to read"]) from None
    if done.returncode == 0:
        with suppress(ValueError):
            return json.loads(done.stdout)
    if done.returncode == 3:
        raise DocumentError([f"{name}: {done.stdout.decode(errors='replace').strip()[:300]}"])
    raise DocumentError([f"{name}: cannot be read: the library that reads it gave up (is it damaged?)"])


def answer(module: str, file: Path) -> tuple[int, str]:
    """The exit code and the answer of a child."""
    try:
        found = importlib.import_module(f"teleop.interchange.{module}_extract").extract(file)
        return 0, json.dumps(found, allow_nan=False)
    except ExtractError as error:
        return 3, " ".join(str(error).split())
    except Exception:  # noqa: BLE001 - whatever the library raises: the file is not what it says
        return 4, ""


def _limit() -> None:
    with suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
        resource.setrlimit(resource.RLIMIT_CPU, (int(LONGEST), int(LONGEST)))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


if __name__ == "__main__":
    _limit()
    code, text = answer(sys.argv[1], Path(sys.argv[2]))
    sys.stdout.write(text)
    sys.stdout.flush()
    sys.exit(code)
