"""MIDI ports of this computer by python-rtmidi, found by a part of their names; messages come in a thread."""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

from teleop.core.errors import DeviceError, UsageError

SEQUENCER = "/dev/snd/seq"
CLIENT = "teleop"
APIS = {"alsa": "LINUX_ALSA", "jack": "UNIX_JACK", "coremidi": "MACOSX_CORE", "winmm": "WINDOWS_MM"}

Listener = Callable[[Sequence[int]], object]


class MidiPort:
    """An open input, and the output beside it where there is one. `listener` gets each message's bytes, in a thread.

    Raises DeviceError where there is no such port, UsageError without python-rtmidi.
    """

    def __init__(
        self, name: str, feedback: str, api: str, virtual: bool, listener: Listener, listens_only: bool = False
    ) -> None:
        rtmidi = _rtmidi()
        kind = _api(rtmidi, api)
        self._input = self._output = None
        try:
            self._input = rtmidi.MidiIn(kind, name=CLIENT)
            self._output = None if listens_only else rtmidi.MidiOut(kind, name=CLIENT)
            self._input.ignore_types(sysex=False, timing=False, active_sense=False)
            self._input.set_callback(lambda event, _data: listener(event[0]))
            if virtual:
                self.name = self._back = name
                self._input.open_virtual_port(name)
                if self._output is not None:
                    self._output.open_virtual_port(feedback or name)
            else:
                self.name = _chosen(self._input.get_ports(), name, "input")
                self._input.open_port(self._input.get_ports().index(self.name), "in")
                self._back = self._open_output(feedback, name)
        except (OSError, RuntimeError, ValueError) as error:
            self.close()
            raise DeviceError(f"no MIDI: {error}") from None
        except DeviceError:
            self.close()
            raise
        self._virtual = virtual

    def _open_output(self, feedback: str, name: str) -> str:
        """The port for feedback; "" for a controller that has none."""
        if self._output is None:
            return ""
        there = self._output.get_ports()
        if not feedback and not [each for each in there if name in each]:
            return ""
        found = _chosen(there, feedback or name, "output")
        self._output.open_port(there.index(found), "out")
        return found

    @property
    def has_feedback(self) -> bool:
        return bool(self._back)

    @property
    def is_there(self) -> bool:
        """Whether the system still has it."""
        if self._virtual:
            return True
        try:
            return self._input is not None and self.name in self._input.get_ports()
        except (RuntimeError, ValueError):
            return False

    def send(self, data: Sequence[int]) -> None:
        """Raises DeviceError for a port that is gone."""
        try:
            if self._output is not None and self._back:
                self._output.send_message(list(data))
        except (RuntimeError, ValueError) as error:
            raise DeviceError(f"MIDI port {self._back}: {error}") from None

    def close(self) -> None:
        for port in (self._input, self._output):
            if port is not None:
                with suppress(RuntimeError):
                    port.close_port()
                port.delete()
        self._input = self._output = None


def _rtmidi() -> Any:
    try:
        import rtmidi
    except ImportError:
        raise UsageError("MIDI needs python-rtmidi: pip install 'rs-teleop[midi]'") from None
    _silence_jack()
    return rtmidi


def _api(rtmidi: Any, api: str) -> int:
    """Its number of the system's MIDI; JACK by `auto` where there is no other, or `MIDO_BACKEND` names it."""
    if api == "auto":
        named = os.environ.get("MIDO_BACKEND", "").rpartition("/")[2]
        jack = named == "UNIX_JACK" or (sys.platform == "linux" and not os.path.exists(SEQUENCER))
        if not jack:
            return rtmidi.API_UNSPECIFIED
        api = "jack"
    number = getattr(rtmidi, f"API_{APIS[api]}", None)
    if number is None or number not in rtmidi.get_compiled_api():
        raise DeviceError(f"no MIDI: this system has no {api}")
    return number


def _chosen(there: Sequence[str], name: str, what: str) -> str:
    found = [each for each in there if each == name] or [each for each in there if name in each]
    if not found:
        ports = f"there are {', '.join(there)}" if there else "there is none"
        raise DeviceError(f"no MIDI {what} has {name} in its name; {ports}")
    return found[0]


_ERRORS = ctypes.CFUNCTYPE(None, ctypes.c_char_p)(lambda _text: None)


def _silence_jack() -> None:
    """JACK's library writes to the terminal each time there is no server."""
    if sys.platform != "linux":
        return
    with suppress(OSError), open("/proc/self/maps", encoding="utf-8", errors="replace") as maps:
        for path in {line.split(maxsplit=5)[-1].strip() for line in maps if "libjack" in line}:
            library = ctypes.CDLL(path)
            for function in ("jack_set_error_function", "jack_set_info_function"):
                getattr(library, function)(_ERRORS)
