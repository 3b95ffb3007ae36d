"""Computes for the console in a process of its own: `python -m teleop.console.worker`, lines of JSON in and out.

A plan takes a tenth of a second and the report of a long take several: in the gateway's own process a STOP would wait
for it. A job that takes too long is ended with its process. The process ends with its input, whatever ended that.
"""

from __future__ import annotations

import asyncio
import json
import os
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any, Protocol

LONGEST = 60.0  # s for a job
LARGEST = 32_000_000  # bytes of an answer
NICE = 5  # below the control loop, where there are few cores
TOO_LONG = "took longer than 60 s: too much for the console"
FAILED = "the console's worker failed"


class Worker(Protocol):
    """Does one job at a time."""

    async def do(self, job: str, *arguments: Any) -> Any:
        """The result of a job of `jobs`, as JSON holds it."""
        ...

    async def close(self) -> None:
        """End."""
        ...


class WorkerProcess:
    """A worker that is started with its first job, and again after one that it did not survive."""

    def __init__(self) -> None:
        self._process: asyncio.subprocess.Process | None = None
        self._killed: set[asyncio.Task[int]] = set()
        self._turn = asyncio.Lock()

    async def do(self, job: str, *arguments: Any) -> Any:
        """The result, or `{"error": ...}`."""
        async with self._turn:
            try:
                async with asyncio.timeout(LONGEST):
                    return await self._done(json.dumps([job, *arguments]).encode() + b"\n")
            except TimeoutError:
                self._kill()
                return {"error": TOO_LONG}
            except (OSError, ValueError, asyncio.IncompleteReadError):
                self._kill()
                return {"error": FAILED}
            except asyncio.CancelledError:
                self._kill()  # its answer would be taken for that of the next job
                raise

    async def close(self) -> None:
        """End it."""
        self._kill()
        if self._killed:
            await asyncio.wait(self._killed)

    async def _done(self, line: bytes) -> Any:
        process = await self._running()
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(line)
        await process.stdin.drain()
        return json.loads(await process.stdout.readuntil(b"\n"))

    async def _running(self) -> asyncio.subprocess.Process:
        if self._process is None or self._process.returncode is not None:
            self._process = await asyncio.create_subprocess_exec(
                *(sys.executable, "-m", "teleop.console.worker"),
                stdin=asyncio.subprocess.PIPE,
                stdout=asyncio.subprocess.PIPE,
                stderr=asyncio.subprocess.DEVNULL,
                env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
                limit=LARGEST,
            )
        return self._process

    def _kill(self) -> None:
        if self._process is not None and self._process.returncode is None:
            with suppress(ProcessLookupError):
                self._process.kill()
            task = asyncio.create_task(self._process.wait())
            self._killed.add(task)
            task.add_done_callback(self._killed.discard)
        self._process = None


def jobs() -> Mapping[str, Callable[..., Any]]:
    """What a worker can do, by name; imports it."""
    from teleop.console import move_text, planning, take_work

    return {
        "plan": planning.plan_text,
        "parse": move_text.parse,
        "edit": move_text.edit,
        "describe": move_text.describe,
        "take": take_work.take_entry,
        "take_report": take_work.take_report,
        "take_page": take_work.take_page,
        "take_keys": take_work.take_keys,
    }


def work(line: bytes, known: Mapping[str, Callable[..., Any]]) -> Any:
    """The result of a job."""
    job, *arguments = json.loads(line)
    return known[job](*arguments)


def main() -> None:
    """Serve jobs until the input ends."""
    with suppress(OSError, AttributeError):
        os.nice(NICE)
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints goes elsewhere
    known = jobs()
    for line in sys.stdin.buffer:
        answers.write(json.dumps(work(line, known), allow_nan=False, separators=(",", ":")).encode() + b"\n")
        answers.flush()


if __name__ == "__main__":
    with suppress(BrokenPipeError, KeyboardInterrupt):
        main()
