"""The child process of `isolated`: bounded, reads one file, and prints what is in it as JSON."""

from __future__ import annotations

import importlib
import json
import sys
from contextlib import suppress
from pathlib import Path

from teleop.interchange.isolated import DONE, FAILED, REFUSED, ExtractError

MOST_PROCESSOR = 20  # s: 10 000 frames take two
MOST_MEMORY = 2 << 30  # bytes of address space


def answer(module: str, file: Path) -> tuple[int, str]:
    """The exit code and the answer of a child."""
    try:
        found = importlib.import_module(f"teleop.interchange.{module}_extract").extract(file)
        return DONE, json.dumps(found, allow_nan=False)
    except ExtractError as error:
        return REFUSED, " ".join(str(error).split())
    except Exception:  # noqa: BLE001 - whatever the library raises: the file is not what it says
        return FAILED, ""


def limit() -> None:
    """Bounds this process, where the system can: for a child alone."""
    with suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
        resource.setrlimit(resource.RLIMIT_CPU, (MOST_PROCESSOR, MOST_PROCESSOR))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


if __name__ == "__main__":
    limit()
    code, text = answer(sys.argv[1], Path(sys.argv[2]))
    sys.stdout.write(text)
    sys.stdout.flush()
    sys.exit(code)
