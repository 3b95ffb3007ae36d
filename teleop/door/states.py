"""The state of a rig as bytes for the ring: what changes each tick, and beside it what seldom does, already packed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import msgpack


class StatePacker:
    """Packs what seldom changes only when it does."""

    def __init__(self) -> None:
        self._packer = msgpack.Packer()
        self._seldom: Mapping[str, Any] | None = None
        self._packed = b""

    def pack(self, often: Mapping[str, Any], seldom: Mapping[str, Any], beside: object = None) -> bytes:
        """`seldom` is looked at by identity: a changed one has to be another object. `beside` is not in the state."""
        if seldom is not self._seldom:
            self._seldom, self._packed = seldom, msgpack.packb(seldom)
        return self._packer.pack([often, self._packed, beside])


class StateUnpacker:
    def __init__(self) -> None:
        self._packed = b""
        self._seldom: dict[str, Any] = {}

    def unpack(self, data: bytes) -> dict[str, Any]:
        """Raises ValueError for what no StatePacker has made."""
        return self.both(data)[0]

    def both(self, data: bytes) -> tuple[dict[str, Any], Any]:
        """The state, and what was packed beside it."""
        often, packed, beside = msgpack.unpackb(data)
        if packed != self._packed:
            self._packed, self._seldom = packed, msgpack.unpackb(packed)
        return {**self._seldom, **often}, beside
