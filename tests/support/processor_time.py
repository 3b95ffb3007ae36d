"""What a process has used of the processor so far, as Linux counts it."""

from __future__ import annotations

import os
from pathlib import Path


def processor_time(process: int) -> float:
    """In s, of the process without its children."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
