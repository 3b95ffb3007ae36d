"""How long `teleop check` of five keys takes beside loading its libraries: `python tests/benchmarks/check_start.py`.

Real processes, in turns, and the least processor time of each: a busy machine makes a process wait, not work. With the
modules compiled, as they are once they have been used.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter

TURNS = 10
BUDGET = 20.0  # s, after which no further turn begins
KEYS = "keyframes:\n" + "".join(f"  - {{at: {3 * i}, pan: {(7 * i) % 11}, tilt: {i}}}\n" for i in range(5))
LIBRARIES = "import numpy, scipy.sparse, clarabel, pydantic, yaml"


def processor_seconds(code: str, environment: dict[str, str]) -> float:
    """Of a process of its own."""
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.DEVNULL, env=environment)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, code)
    return used.ru_utime + used.ru_stime


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "five.yaml"
        file.write_text(KEYS)
        check = f"from teleop.cli import main; main(['check', {str(file)!r}])"
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
        environment["PYTHONPYCACHEPREFIX"] = f"{folder}/compiled"
        found: dict[str, list[float]] = {LIBRARIES: [], check: []}
        for code in found:
            processor_seconds(code, environment)
        begin = perf_counter()
        for turn in range(TURNS):
            if turn and perf_counter() - begin > BUDGET:
                break
            for code, times in found.items():
                times.append(processor_seconds(code, environment))
    libraries, whole = (min(times) for times in found.values())
    sys.stdout.write(f"check {whole:.2f} s / libraries {libraries:.2f} s = {whole / libraries:.2f} x (at most 1.5 x)\n")


if __name__ == "__main__":
    main()
