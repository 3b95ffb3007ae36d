"""Foxglove: the topics of a take, live, with the same names, schemas and contents; parameters that cannot be set.

The door has every tick as it was, so that the messages of a tick are those that a recording has. It has neither the
drone's telemetry, nor the versions of firmware, nor the plan beneath a learned correction: those topics are there and
stay empty. Nothing is sent before the first reading.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict
from typing import Any

from teleop.config.exchange.address import address
from teleop.config.exchange.foxglove import FoxgloveSection
from teleop.core.errors import TeleopError
from teleop.exchange.served import Rig, Served
from teleop.recording.played import Played
from teleop.recording.topics import SCHEMAS, TopicWriter, as_json

STATUS = ("inputs", "ranges", "stopped", "recording", "follow", "messages")  # of a state, as in a take's /status
ON_CHANGE = ("/demand", "/sticks", "/status")  # topics that a new client waits for
SAME_PLACE = 2e-3  # s: the state has thousandths
BACKLOG = 256  # messages for a client that is slow; the oldest goes


async def serve(section: FoxgloveSection, served: Served) -> None:
    """Serve until cancelled. Raises TeleopError where it cannot listen."""
    with _Topics(served.rig).open(section) as topics:
        if address(section.listen).port == 0:
            served.notify(f"foxglove: listens at port {topics.port}")
        async for state, tick, deflections in served.door.ticks():
            if topics.origin is None and tick.reported:
                topics.origin = state["clock"] - state["time"]
            if topics.origin is not None and topics.watched:
                topics.writer.tick(tick)
                topics.writer.status(tick.time, {**_status(state), "deflections": deflections})
                topics.place(tick.time, state["move"])


class _Topics:
    """The channels. `origin` is when the loop's clock was 0, in s since 1970; None before the first reading."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self.writer = TopicWriter(self._write)
        self.origin: float | None = None
        self.port = 0
        self._channels: Mapping[str, Any] = {}
        self._at: tuple[int, float, float] | None = None  # of the move: its pass, its time then, and when

    @contextmanager
    def open(self, section: FoxgloveSection) -> Iterator[_Topics]:
        try:
            import foxglove
            from foxglove.websocket import Capability
        except ImportError:
            raise TeleopError("needs foxglove-sdk: pip install 'rs-teleop[foxglove]'") from None
        logging.getLogger("foxglove").setLevel(logging.CRITICAL)  # clients that break off are no matter of the operator
        context = foxglove.Context()
        self._channels = {
            topic: foxglove.Channel(topic, schema=_schema(schema), message_encoding="json", context=context)
            for topic, schema in SCHEMAS.items()
        }
        host, port = address(section.listen)
        listener = _Listener(parameters(self._rig), self.writer)
        options = {"capabilities": [Capability.Parameters], "server_listener": listener, "context": context}
        try:
            server = foxglove.start_server(
                name=f"teleop {self._rig.name}", host=host, port=port, message_backlog_size=BACKLOG, **options
            )
        except (OSError, RuntimeError) as error:
            raise TeleopError(f"cannot listen at {section.listen}: {error}") from None
        listener.server, self.port = server, server.port
        try:
            yield self
        finally:
            server.stop()

    @property
    def watched(self) -> bool:
        """Whether anybody has asked for anything."""
        return any(channel.base.has_sinks() for channel in self._channels.values())

    def place(self, now: float, move: Mapping[str, Any] | None) -> None:
        """Where in a move it is, when that is not where it would be if it played on."""
        here = _place(move)
        if here is None and self._at is None:
            return
        if here is not None and self._at is not None:
            number, place, at = self._at
            if here[0] == number and abs(place + now - at - here[1]) <= SAME_PLACE:
                return
        self._at = None if here is None else (*here, now)
        self.writer.played(now, Played(here))

    def _write(self, topic: str, time: float, data: bytes) -> None:
        assert self.origin is not None
        self._channels[topic].log(data, log_time=round((time + self.origin) * 1e9))


class _Listener:
    """Answers of parameters, which are the rig's limits: whoever sets one is given what it was."""

    def __init__(self, values: Mapping[str, Any], writer: TopicWriter) -> None:
        self._values, self._writer = values, writer
        self.server: Any = None

    def on_get_parameters(self, client: Any, param_names: list[str], request_id: str | None = None) -> list[Any]:  # noqa: ARG002
        from foxglove import Parameter

        names = param_names or list(self._values)
        return [Parameter(name, value=self._values[name]) for name in names if name in self._values]

    def on_set_parameters(self, client: Any, parameters: list[Any], request_id: str | None = None) -> list[Any]:
        from foxglove import StatusLevel

        if self.server is not None:
            self.server.publish_status("the parameters of a rig are read only: change its profile", StatusLevel.Warning)
        return self.on_get_parameters(client, [each.name for each in parameters], request_id)

    def on_subscribe(self, client: Any, channel: Any) -> None:  # noqa: ARG002
        if channel.topic in ON_CHANGE:
            self._writer.again(channel.topic)

    def on_unsubscribe(self, client: Any, channel: Any) -> None: ...

    def on_client_advertise(self, client: Any, channel: Any) -> None: ...

    def on_client_unadvertise(self, client: Any, client_channel_id: int) -> None: ...

    def on_message_data(self, client: Any, client_channel_id: int, data: bytes) -> None: ...

    def on_parameters_subscribe(self, param_names: list[str]) -> None: ...

    def on_parameters_unsubscribe(self, param_names: list[str]) -> None: ...

    def on_connection_graph_subscribe(self) -> None: ...

    def on_connection_graph_unsubscribe(self) -> None: ...


def parameters(rig: Rig) -> dict[str, str | float]:
    """The rig's name and limits, in units (deg; focus 0..1), /s, /s2 and /s3; a limit that there is not is left out."""
    limits = {
        f"axes.{axis.value}.{name}": value
        for axis, of in rig.limits.items()
        for name, value in asdict(of).items()
        if not isinstance(value, bool) and math.isfinite(value)
    }
    return {"rig": rig.name, **limits}


def _place(move: Mapping[str, Any] | None) -> tuple[int, float] | None:
    """The pass of a move that plays, and its own time in s."""
    if move is None or move["phase"] not in ("playing", "paused") or move["at"] is None:
        return None
    return int(move["pass"]), float(move["at"])


def _schema(schema: Mapping[str, Any]) -> Any:
    from foxglove import Schema

    return Schema(name=f"teleop.{schema['title']}", encoding="jsonschema", data=as_json(schema))


def _status(state: Mapping[str, Any]) -> dict[str, Any]:
    """What a take's status has, as far as the state has it; the range counts from 0 there."""
    inputs = [{("moves" if key == "drives" else key): value for key, value in each.items()} for each in state["inputs"]]
    presets = {number: preset.get("name", "") for number, preset in state["presets"].items()}
    return {**{key: state[key] for key in STATUS}, "inputs": inputs, "range": state["range"] - 1, "presets": presets}
