"""`teleop devices record`: what an input device is and sends, in a file to attach to a bug report."""

from __future__ import annotations

import re
import sys
import threading
from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from teleop.cli.devices import devices
from teleop.cli.examples import examples
from teleop.config.inputs_section import DeviceSection
from teleop.core.clock import SystemClock
from teleop.core.errors import DeviceError, UsageError
from teleop.inputs.evdev.backend import AllDevices
from teleop.inputs.hid.backend import DeviceInfo, HidBackend, MissingPackageError, described, identified
from teleop.inputs.hid.pads import is_named
from teleop.inputs.hid.recorder import Recorder
from teleop.inputs.hid.selection import wanted

_IDS = re.compile(r"([0-9a-fA-F]{1,4}):([0-9a-fA-F]{1,4})")

app = App(name="devices", help="List CAN interfaces, serial ports and HID devices.", help_epilogue=examples("devices"))
app.default(devices)


@app.command(help_epilogue=examples("devices record"))
def record(
    device: Annotated[
        str, Parameter(help="vendor:product, path or name of the device; without it, the first joystick.")
    ] = "",
    *,
    output: Annotated[Path, Parameter(name=("--output", "-o"), metavar="FILE", help="The recording to write.")],
    seconds: Annotated[float | None, Parameter(metavar="N", help="Stop after N s; else Ctrl-C stops.")] = None,
    serial: Annotated[bool, Parameter(help="Record the serial number too.", negative="", show_default=False)] = False,
) -> None:
    """Record what an input device is and reports, for a bug report or `teleop live --input-recording`."""
    if seconds is not None and not 0 < seconds < float("inf"):
        raise UsageError(f"--seconds: must be more than 0, not {seconds:g}")
    backend = AllDevices()
    infos = chosen(backend, device)
    try:
        stream = output.open("x", encoding="utf-8")
    except FileExistsError:
        raise UsageError(f"{output}: is there already: give another name") from None
    except OSError as error:
        raise UsageError(f"{output}: cannot be written: {error.strerror or error}") from None
    with stream:
        try:
            recorder = Recorder(backend, infos, stream, SystemClock().now, serial)
        except OSError as error:
            output.unlink()
            if isinstance(error, MissingPackageError):
                raise DeviceError(f"{described(infos[0])} {error}") from None
            raise DeviceError(
                f"{described(infos[0])}: cannot be opened ({error}): check its udev rule: teleop doctor"
            ) from None
        end = "Ctrl-C ends it" if seconds is None else f"for {seconds:g} s"
        _tell(f"recording {identified(infos[0])}, {end}: move each control, one after the other")
        try:
            while seconds is None or recorder.seconds < seconds:
                recorder.step(threading.Event().wait)
        except KeyboardInterrupt:
            pass
        finally:
            recorder.close()
    held = "its serial number" if serial else "no serial number (--serial adds it)"
    reports = "1 report with its time" if recorder.reports == 1 else f"{recorder.reports} reports with their times"
    _tell(f"{output}: name, ids and port of the device, {held}, its descriptor, and {reports}")


def chosen(backend: HidBackend, device: str) -> list[DeviceInfo]:
    """The device that is meant, once for each of its usages. Raises UsageError when there is none."""
    found = backend.enumerate()
    if ids := _IDS.fullmatch(device):
        wants = (int(ids[1], 16), int(ids[2], 16))
        fitting = [info for info in found if (info.vendor_id, info.product_id) == wants]
        fitting = list(wanted(DeviceSection(vendor=wants[0], product=wants[1]), fitting, None))
    elif device:
        fitting = [info for info in found if info.path == device.encode()]
        fitting = fitting or [info for info in found if is_named(info, device)]
    else:
        fitting = list(wanted(DeviceSection(), found, None))
    if not fitting:
        what = f"no device {device}" if device else "no joystick found: plug one in"
        raise UsageError(f"{what}; `teleop devices` lists the devices")
    first = fitting[0]
    others = [info for info in found if info.path == first.path and info != first]
    return [first, *others]


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
