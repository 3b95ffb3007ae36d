"""How long `teleop check` of five keys takes beside loading its libraries: `python tests/benchmarks/check_start.py`.

Real processes, in turns so that a busy machine slows both, and the best of each.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter

TURNS = 10
KEYS = "keyframes:\n" + "".join(f"  - {{at: {3 * i}, pan: {(7 * i) % 11}, tilt: {i}}}\n" for i in range(5))
LIBRARIES = "import numpy, scipy.sparse, clarabel, pydantic, yaml"


def seconds(command: list[str]) -> float:
    begin = perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return perf_counter() - begin


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "five.yaml"
        file.write_text(KEYS)
        check = [sys.executable, "-c", f"from teleop.cli import main; main(['check', {str(file)!r}])"]
        turns = [(seconds([sys.executable, "-c", LIBRARIES]), seconds(check)) for _ in range(TURNS)]
    libraries, whole = (min(each) for each in zip(*turns, strict=True))
    sys.stdout.write(f"check {whole:.2f} s / libraries {libraries:.2f} s = {whole / libraries:.2f} x (at most 1.5 x)\n")


if __name__ == "__main__":
    main()
