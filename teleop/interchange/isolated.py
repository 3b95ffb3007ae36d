"""Reads files of C++ libraries in a process of its own: what such a library does with bad bytes is not all Python's.

The child has bounded memory and time, and answers in JSON; one that crashes is an error in one line. It is
`python -m teleop.interchange.child MODULE FILE`.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import Any

from teleop.config.documents.document import DocumentError

LONGEST = 60.0  # s
DONE, REFUSED, FAILED = 0, 3, 4  # exit codes of the child


class ExtractError(Exception):
    """What is wrong with a file, in words that follow its name."""


def read_isolated(module: str, raw: bytes, ending: str, name: str) -> Any:
    """What the module's `extract` finds in a file of these bytes. Raises DocumentError."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"file{ending}"
        file.write_bytes(raw)
        command = [sys.executable, "-P", "-m", "teleop.interchange.child", module, str(file)]
        try:
            done = subprocess.run(
                command,
                capture_output=True,
                timeout=LONGEST,
                check=False,
                cwd=folder,
                env={**os.environ, "TMPDIR": folder},  # where USD leaves its report of a crash
            )
        except subprocess.TimeoutExpired:
            raise DocumentError([f"{name}: took longer than {LONGEST:g} s to read"]) from None
    if done.returncode == DONE:
        with suppress(ValueError):
            return json.loads(done.stdout)
    if done.returncode == REFUSED:
        raise DocumentError([f"{name}: {done.stdout.decode(errors='replace').strip()[:300]}"])
    raise DocumentError([f"{name}: cannot be read: the library that reads it gave up (is it damaged?)"])
