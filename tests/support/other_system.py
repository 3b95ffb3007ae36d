"""Runs `teleop` as on another system: what only Linux, or only POSIX, has is hidden from this process.

    python other_system.py win32|darwin ARGUMENTS

Libraries are imported first: they look at the system for themselves, and theirs are other files there.
"""

import importlib
import os
import signal
import sys

LIBRARIES = (
    "asyncio", "ctypes.util", "multiprocessing", "pty", "subprocess", "tempfile", "uuid", "zipfile",
    "can", "clarabel", "cyclopts", "hidraw", "mcap.reader", "mcap.writer", "msgpack", "numpy", "platform",
    "platformdirs", "pydantic",
    "rich.console", "rich.live", "rich.progress", "rich.table", "ruckig", "scipy.sparse", "serial",
    "serial.tools.list_ports", "yaml",
)  # fmt: skip
LINUX_ONLY = {os: ("O_TMPFILE", "sched_setscheduler", "sched_getscheduler", "sched_param", "sched_setaffinity")}
POSIX_ONLY = {
    os: (
        "tcgetpgrp", "getpgrp", "getpgid", "setsid", "fork", "killpg", "openpty", "ttyname", "nice", "fpathconf",
        "set_blocking", "fchmod", "fchown", "O_CLOEXEC", "O_NONBLOCK", "O_NOCTTY", "getuid", "geteuid", "uname",
        "mkfifo",
    ),
    signal: ("SIGHUP", "SIGQUIT", "SIGTSTP", "SIGCONT", "SIGTTOU", "SIGWINCH", "pthread_kill", "pthread_sigmask"),
}  # fmt: skip
POSIX_MODULES = ("termios", "tty", "pty", "fcntl", "pwd", "grp", "resource", "curses", "readline")


def hide(places: dict) -> None:
    for place, names in places.items():
        for name in names:
            if hasattr(place, name):
                delattr(place, name)


def main(system: str, arguments: list[str]) -> None:
    for library in LIBRARIES:
        importlib.import_module(library)
    sys.modules["evdev"] = None  # type: ignore[assignment]  # its import fails
    unblocking = os.set_blocking, signal.set_wakeup_fd
    hide(LINUX_ONLY)
    if system == "win32":
        hide(POSIX_ONLY)
        for name in POSIX_MODULES:
            sys.modules[name] = None  # type: ignore[assignment]
        for name in POSIX_ONLY[signal]:
            signal.Signals._member_map_.pop(name, None)
        # Windows takes any file here; this system takes it only where it does not block.
        set_blocking, set_wakeup_fd = unblocking
        signal.set_wakeup_fd = lambda fd, **more: (fd >= 0 and set_blocking(fd, False), set_wakeup_fd(fd, **more))[1]
    sys.platform = system
    from teleop.cli import main as teleop

    teleop(arguments)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
