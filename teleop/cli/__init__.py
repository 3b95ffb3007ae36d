"""The command line: what was typed becomes a call, what goes wrong becomes a line and an exit code.

Commands are named here and imported when they are used, so that `teleop check` does not pay for what `teleop live`
needs. Exit codes: 0 done, 1 the run or the check failed, 2 bad usage or a bad file, 130 interrupted.
"""

from __future__ import annotations

import gc
import io
import logging
import os
import sys
from collections.abc import Mapping, Sequence
from importlib.metadata import version

from cyclopts import App, CycloptsError, Group

import teleop
from teleop.cli.console_options import with_console
from teleop.cli.examples import examples
from teleop.cli.screens.folded import spelled, tell
from teleop.cli.signals import process
from teleop.cli.typed_triggers import joined
from teleop.config.documents.document import DocumentError, UnplayableError
from teleop.core.errors import LeaveAtOnce, TeleopError, UsageError

MOST_SAID = 50  # problems of a file: more are not mended at a time
LOADING = 50_000  # objects until the collector looks: nothing that is loaded is garbage, and looking takes a tenth
DONE, FAILED, BAD_USAGE, INTERRUPTED = 0, 1, 2, 130

COMMANDS: Mapping[str, tuple[str, str]] = {
    "play": ("teleop.cli.play:play", "Play a move on a rig."),
    "live": ("teleop.cli.live:live", "Move a rig by joystick, dial and keys."),
    "console": ("teleop.cli.console:console", "Move a rig from a browser."),
    "check": ("teleop.cli.check:check", "Check a sequence against a rig."),
    "preview": ("teleop.cli.preview:preview", "Draw a sequence as a page, a picture or a table."),
    "list": ("teleop.cli.shipped_files:list_shipped", "List the shipped moves, rigs and pads."),
    "copy": ("teleop.cli.shipped_files:copy", "Copy a shipped move, rig or pad to a file of yours."),
    "export": ("teleop.cli.export:export", "Write a move or a take for another program."),
    "import": ("teleop.cli.import_:import_", "Make a sequence of another program's file."),
    "fleet": ("teleop.cli.fleet.commands:app", "Watch and command several rigs."),
    "take": ("teleop.cli.take.commands:app", "List, report, export and repair recorded runs."),
    "commission": ("teleop.cli.commission:commission", "Find out what a gimbal does, and write its profile."),
    "calibrate": ("teleop.cli.calibration.delay:app", "Measure how the axes of a gimbal answer, or its signs."),
    "devices": ("teleop.cli.record_device:app", "List CAN interfaces, serial ports and HID devices."),
    "doctor": ("teleop.cli.doctor.command:doctor", "Check what this machine can do, and what it lacks."),
    "forget": ("teleop.cli.forget:forget", "Clear what is kept of how the axes of a rig answer."),
    "send": ("teleop.cli.send.gimbal:send", "Send one command to a gimbal, camera, focus motor or drone."),
    "monitor": ("teleop.cli.monitor:monitor", "Show the traffic between host and device on a link."),
    "sim": ("teleop.cli.sim:sim", "Simulate a rig's devices on a real bus."),
    "schema": ("teleop.cli.schema:schema", "Print the JSON Schema of a kind of file, for editors."),
    "decode": ("teleop.cli.codec.decode:app", "Decode bytes of a protocol to JSON lines."),
    "encode": ("teleop.cli.codec.encode:app", "Encode JSON lines to bytes of a protocol."),
}
"""Where each command is, imported when it is used, and its line of help; in the order in which people need them."""

# These have examples of their own, and so has send, whose help is made in send_help.
_GROUPS = (
    "teleop.cli.take.commands:app",
    "teleop.cli.calibration.delay:app",
    "teleop.cli.record_device:app",
    "teleop.cli.fleet.commands:app",
    "teleop.cli.codec.decode:app",
    "teleop.cli.codec.encode:app",
)
_ABOUT = (teleop.__doc__ or "").partition("\n")[0]  # its first line: the rest is for programs
app = App(
    name="teleop",
    help=_ABOUT,
    help_epilogue=examples(""),
    help_format="plaintext",
    version=lambda: version("rs-teleop"),
    suppress_keyboard_interrupt=False,
)
for _order, (_name, (_place, _help)) in enumerate(COMMANDS.items()):
    _own = {} if _place in _GROUPS else {"help_epilogue": "" if _name == "send" else examples(_name)}
    app.command(_place, name=_name, help=_help, sort_key=_order, **_own)
_OPTIONS = Group("Options", sort_key=1)
app.register_install_completion_command(
    help="Install tab completion for your shell.", group=_OPTIONS, help_epilogue="", version_flags=[]
)
for _flag in ("--help", "--version"):
    app[_flag].group = _OPTIONS


def main(arguments: Sequence[str] | None = None) -> None:
    """The `teleop` command; exits with one of the codes above."""
    gc.set_threshold(LOADING)
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")  # it has none here, and looking for them takes time
    process.own()
    printable()
    try:
        code = run(sys.argv[1:] if arguments is None else arguments)
    finally:
        process.owned = False
    process.finish(code)
    sys.exit(code)


def printable() -> None:
    """No character that the terminal or a pipe cannot have ends in a traceback."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            can_all = stream.encoding.lower().startswith("utf")  # but what is no character: a byte of a file's name
            stream.reconfigure(errors="backslashreplace" if can_all else "replace")


def run(arguments: Sequence[str]) -> int:
    """Do what was typed; its exit code."""
    debug = "--debug" in arguments  # of every command, those that have no options of their own included
    arguments = with_console(joined([argument for argument in arguments if argument != "--debug"]))
    logging.basicConfig(level=logging.DEBUG if debug else logging.WARNING, format="teleop: %(message)s")
    try:
        return app(arguments, print_error=False, exit_on_error=False, result_action="return_int_as_exit_code_else_zero")
    except (CycloptsError, TeleopError) as error:
        if debug and not isinstance(error, CycloptsError):
            logging.getLogger(__name__).debug("here is where it came from", exc_info=error)
        _notify(error)
        bad_usage = isinstance(error, CycloptsError | UsageError) and not isinstance(error, UnplayableError)
        return BAD_USAGE if bad_usage else FAILED
    except LeaveAtOnce as signal:
        print(
            f"teleop: {signal} received for the third time: left at once; each device was asked once to release",
            file=sys.stderr,
        )
        return INTERRUPTED
    except KeyboardInterrupt:
        print("teleop: interrupted", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:  # the reader of our output has left
        sys.stderr.close()
        return FAILED


def _notify(error: Exception) -> None:
    if isinstance(error, DocumentError):
        print(spelled("\n".join(error.problems[:MOST_SAID])), file=sys.stderr)
        if more := len(error.problems[MOST_SAID:]) + error.more:
            print(f"teleop: and {more} more", file=sys.stderr)
        for verdict in getattr(error, "__notes__", ()):
            tell(verdict)
    else:
        print(spelled(f"teleop: {error}"), file=sys.stderr)
