"""Runs the console with uvicorn, in the event loop of the gateway."""

from __future__ import annotations

import asyncio
import logging
import socket
from typing import TYPE_CHECKING

import uvicorn

from teleop.console.app import Console
from teleop.console.connections import BoundedProtocol
from teleop.console.json_body import MOST_BYTES
from teleop.console.settings import ConsoleSettings

if TYPE_CHECKING:
    from teleop.console.door import Door

PING, NO_PONG = 5.0, 10.0  # s from one ping of a WebSocket to the next, and to the end of one that does not answer
MOST_HEADERS = 16_384  # bytes of a request before its body
MOST_CONNECTIONS = 400
LEAVING = 0.3  # s for answers under way when the gateway ends


class _Server(uvicorn.Server):
    """Leaves signals to the gateway."""

    def capture_signals(self):  # type: ignore[override]
        from contextlib import nullcontext

        return nullcontext()


async def serve(settings: ConsoleSettings, door: Door, listener: socket.socket) -> None:
    """Serve the console at a socket of `settings.listen` until the task is cancelled."""
    console = Console(settings, door)
    server = _Server(_config(settings, console))
    ready = asyncio.create_task(console.start())
    task = asyncio.create_task(server.serve([listener]))
    try:
        await asyncio.shield(task)
    except asyncio.CancelledError:
        server.should_exit = True
        await task
        raise
    finally:
        ready.cancel()
        await asyncio.wait([ready])
        await console.close()


def _config(settings: ConsoleSettings, console: Console) -> uvicorn.Config:
    logging.getLogger("uvicorn").setLevel(logging.CRITICAL)  # the terminal belongs to the control process
    return uvicorn.Config(
        console.app,
        loop="asyncio",
        http=BoundedProtocol,
        ws="websockets-sansio",
        ws_max_size=MOST_BYTES,
        ws_ping_interval=PING,
        ws_ping_timeout=NO_PONG,
        ws_per_message_deflate=False,
        lifespan="off",
        log_config=None,
        access_log=False,
        proxy_headers=False,
        server_header=False,
        limit_concurrency=MOST_CONNECTIONS,
        h11_max_incomplete_event_size=MOST_HEADERS,
        timeout_graceful_shutdown=LEAVING,  # type: ignore[arg-type]
        ssl_certfile=settings.certificate or None,
        ssl_keyfile=settings.key or None,
    )
