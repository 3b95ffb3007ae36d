"""Signals during a run: the first asks it to stop, the second asks again, the third leaves at once.

Python runs a signal's handler in the main thread, between two of its own instructions, so a driver that hangs in C code
would keep it waiting. The system's part of a signal comes through a pipe at once: a thread reads it, counts, and where
the main thread does not leave within GRACE the thread makes the attempt to release the devices itself. In a process
that is ours (`owned`) the thread then ends the process, whatever still hangs; elsewhere it only raises.
"""

from __future__ import annotations

import atexit
import contextlib
import os
import select
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from types import FrameType

from teleop.core.errors import LeaveAtOnce

STOPPING = ("SIGINT", "SIGTERM")
LEAVING = ("SIGHUP", "SIGQUIT")  # these stop it too, unless they were ignored when the program started: nohup
PRESSES = 3  # of STOPPING, until it leaves
SOON = 0.05  # s in which the main thread's handler has been called, unless it hangs
GRACE = 0.6  # s for the main thread to release every device
AT_MOST = 2.0  # s from the third signal to the end of the process, whatever hangs
CODE = 130
_HINTS = {1: "twice", 2: "once"}
_SHOWN_AGAIN = b"\x1b[?1049l\x1b[?25h\r\n"  # the terminal's own screen and its cursor


def nothing(_text: str = "") -> None: ...


@contextlib.contextmanager
def signals_to(
    interrupt: Callable[[str], object],
    release: Callable[[], object] = nothing,
    notify: Callable[[str], object] = nothing,
) -> Iterator[None]:
    """Ctrl-C and other signals to end call `interrupt` with their name; the third raises LeaveAtOnce where the main
    thread is. `release` is one attempt to release every device, for another thread to make where that one hangs.

    `notify` tells the operator on a terminal how to leave; it must not wait. Every handler is put back afterwards.
    """
    desk = _Desk(interrupt, release, notify if sys.stderr.isatty() else nothing)
    numbers = [*_known(STOPPING), *(number for number in _known(LEAVING) if signal.getsignal(number) != signal.SIG_IGN)]
    with contextlib.ExitStack() as stack:
        stack.enter_context(desk)
        for number in numbers:
            stack.callback(signal.signal, number, signal.signal(number, desk.handle))
        try:
            yield
        finally:
            desk.leaving = True  # a signal between two of the lines that put the handlers back must not stop that
            process.run_ends()


@contextlib.contextmanager
def unwound_by_signals() -> Iterator[None]:
    """A signal that would end the process at once first leaves the block, so that nothing half written stays behind."""
    ending: list[int] = []

    def unwind(number: int, _frame: FrameType | None) -> None:
        ending.append(number)
        raise _Unwound

    before = {each: signal.getsignal(each) for each in _known((*STOPPING[1:], *LEAVING))}
    numbers = [each for each, handler in before.items() if handler in (signal.SIG_DFL, process.outside)]
    if threading.current_thread() is not threading.main_thread():
        numbers = []  # no other may have handlers
    for number in numbers:
        signal.signal(number, unwind)
    try:
        yield
    except _Unwound:
        if not ending:  # it belongs to a block around this one
            raise
        signal.signal(ending[0], signal.SIG_DFL)
        os.kill(os.getpid(), ending[0])
    finally:
        for number in numbers:
            signal.signal(number, before[number])


class _Unwound(BaseException):
    """A signal has come."""


class _Desk:
    """Where the signals of a run come in."""

    def __init__(
        self, interrupt: Callable[[str], object], release: Callable[[], object], notify: Callable[[str], object]
    ) -> None:
        self._interrupt, self._release, self._notify = interrupt, release, notify
        self.leaving = False  # the main thread was asked to leave, or is past the run
        self._seen = self._counted = 0  # by the main thread, by the pipe: signals that come together are one handler's
        self._owned = process.owned
        self._out, self._never = threading.Event(), threading.Event()  # the main thread is out of the run
        self._main = threading.get_ident()
        self._stopping = {int(number) for number in _known(STOPPING)}

    def __enter__(self) -> None:
        self._reading, self._writing = os.pipe()
        if hasattr(os, "set_blocking"):  # Windows has it from Python 3.12 on; it only asks it of sockets
            os.set_blocking(self._writing, False)
        self._before = signal.set_wakeup_fd(self._writing, warn_on_full_buffer=False)
        self._thread = threading.Thread(target=self._count, name="signals", daemon=True)
        self._thread.start()

    def __exit__(self, kind: type[BaseException] | None, error: object, trace: object) -> None:
        self._out.set()
        signal.set_wakeup_fd(self._before)
        if kind is LeaveAtOnce and self._owned:
            return  # the thread sees to it that the process ends
        with contextlib.suppress(OSError):
            os.write(self._writing, b"\0")
        self._thread.join(AT_MOST)
        for descriptor in (self._reading, self._writing):
            os.close(descriptor)

    def handle(self, number: int, _frame: FrameType | None) -> None:
        """In the main thread, wherever it is."""
        self._seen += number in self._stopping
        self._interrupt(f"{signal.Signals(number).name} received")
        if max(self._seen, self._counted) >= PRESSES and not self.leaving:
            self.leaving = True
            raise LeaveAtOnce(signal.Signals(number).name)

    def _count(self) -> None:
        while (numbers := os.read(self._reading, 64)) and 0 not in numbers:
            for _ in filter(self._stopping.__contains__, numbers):
                self._counted += 1
                if hint := _HINTS.get(self._counted):
                    self._notify(f"stopping; press Ctrl-C {hint} more to leave at once")
            if self._counted >= PRESSES:
                self._leave(numbers[-1])
                return

    def _leave(self, number: int) -> None:
        released = self._out.wait(SOON)
        if not released and not self.leaving and hasattr(signal, "pthread_kill"):
            signal.pthread_kill(self._main, number)  # several that came together were one call of its handler
        released = self._out.wait(GRACE)
        if not self._owned:
            return
        if not released:
            attempt = threading.Thread(target=self._release, name="release", daemon=True)
            attempt.start()
            attempt.join(GRACE)
        self._never.wait(AT_MOST - GRACE if released else 0)
        process.end()


class _Process:
    """This process, as far as it is ours: the command `teleop` owns it, a program that imports teleop keeps its own."""

    def __init__(self) -> None:
        self.owned = False
        self._ran = False
        self._terminal: tuple[int, list] | None = None

    def own(self) -> None:
        """What hangs may be ended; and after a run, when only its report is left, a late signal is no death.

        A hang-up, which may come late or twice, is then ignored, and SIGTERM is a Ctrl-C.
        """
        if threading.current_thread() is not threading.main_thread():
            return
        self.owned = True
        for number in _known((*LEAVING, "SIGTERM")):
            if signal.getsignal(number) == signal.SIG_DFL:
                signal.signal(number, self.outside)
        with contextlib.suppress(ImportError, OSError, ValueError, AttributeError):
            import termios

            descriptor = sys.stdin.fileno()
            with contextlib.suppress(termios.error):
                self._terminal = descriptor, termios.tcgetattr(descriptor)

    def run_ends(self) -> None:
        self._ran = self.owned

    def finish(self, code: int) -> None:
        """All is done, and `code` is the exit code: a late Ctrl-C does not change that, and ends what hangs."""
        with contextlib.suppress(OSError, ValueError):
            sys.stdout.flush()
        if threading.current_thread() is not threading.main_thread():
            return  # no handlers can be set here
        for number in _known(STOPPING):
            signal.signal(number, lambda *_: os._exit(code))
        atexit.register(_ignore)

    def end(self) -> None:
        """Leave without waiting for anything, the terminal as it was found."""
        if self._terminal:
            import termios

            with contextlib.suppress(OSError, termios.error):
                termios.tcsetattr(self._terminal[0], termios.TCSANOW, self._terminal[1])
                if os.isatty(2) and select.select([], [2], [], 0)[1]:
                    os.write(2, _SHOWN_AGAIN)
        os._exit(CODE)

    def outside(self, number: int, _frame: FrameType | None) -> None:
        """Before a run a signal does what it does anywhere."""
        if not self._ran:
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)
        elif number == signal.SIGTERM:
            raise KeyboardInterrupt


def _ignore() -> None:
    for number in _known(STOPPING):
        signal.signal(number, signal.SIG_IGN)


process = _Process()


def _known(names: Sequence[str]) -> Sequence[signal.Signals]:
    """Those of the signals that this system has."""
    return [signal.Signals[name] for name in names if name in signal.Signals.__members__]
