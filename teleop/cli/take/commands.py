"""`teleop take`: what can be done with recorded runs. Each command is imported when it is used, as in `teleop.cli`."""

from __future__ import annotations

from collections.abc import Mapping

from cyclopts import App

from teleop.cli.examples import examples

COMMANDS: Mapping[str, tuple[str, str]] = {
    "list": ("teleop.cli.take.list:take_list", "List the takes of a folder."),
    "info": ("teleop.cli.take.list:take_info", "Show what is in a take."),
    "export": ("teleop.cli.take.files:take_export", "Write a take as a table."),
    "keyframes": ("teleop.cli.take.keyframes:take_keyframes", "Fit sparse, editable keyframes to a take."),
    "report": ("teleop.cli.take.report:take_report", "Report how well a run went, axis by axis."),
    "certificate": ("teleop.cli.take.certificate:take_certificate", "Certify how exactly passes were repeated."),
    "recover": ("teleop.cli.take.files:take_recover", "Save the whole part of a take that was cut off."),
}

app = App(name="take", help="List, report, export and repair recorded runs.", help_epilogue=examples("take"))
for _order, (_name, (_place, _help)) in enumerate(COMMANDS.items()):
    app.command(_place, name=_name, help=_help, sort_key=_order, help_epilogue=examples(f"take {_name}"))
