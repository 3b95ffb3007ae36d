"""Which input of a profile may take which device, where several could take the same."""

from __future__ import annotations

import threading
from collections.abc import Sequence

from teleop.config.inputs_section import InputSection
from teleop.inputs.hid.backend import DeviceInfo, same_unit
from teleop.inputs.hid.pads import fits


class Claims:
    """Devices that are taken, by their paths, and whose each is: shared by the readers of these `sections`."""

    def __init__(self, sections: Sequence[InputSection] = ()) -> None:
        self._lock = threading.Lock()
        self._sections = sections
        self._taken: set[bytes] = set()
        self._last: dict[int, DeviceInfo] = {}  # the device of each section, by its identity

    def take(self, path: bytes) -> bool:
        with self._lock:
            free = path not in self._taken
            self._taken.add(path)
            return free

    def release(self, path: bytes) -> None:
        with self._lock:
            self._taken.discard(path)

    def remember(self, section: InputSection, info: DeviceInfo) -> None:
        """This device is that section's, also while it is unplugged."""
        with self._lock:
            self._last[id(section)] = info

    def is_for_another(self, section: InputSection, info: DeviceInfo) -> bool:
        """Whether another section has had this device, or names it more exactly."""
        with self._lock:
            others = [last for key, last in self._last.items() if key != id(section)]
        if any(same_unit(info, last) for last in others):
            return True
        exactly = section.device.keys_given
        return any(
            other is not section and other.device.keys_given > exactly and fits(other.device, info)
            for other in self._sections
        )
