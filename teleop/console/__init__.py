"""The web console: a page for operators, and HTTP for scripts, served from the gateway process.

Nothing here moves a rig. Every command goes through the door to the control process, and every state comes from it. So
the server may hang, crash or be flooded without an effect on a move. `server.serve` runs it; `settings` and
`invitation` are light, for the process that starts it.
"""

DEFAULT_BIND = "127.0.0.1:8470"
