"""Who may do what at a rig, as Zenoh's access control: nobody anything, but for what a role allows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from teleop.studio.wire import ALIVES, EVENTS, STATES

BOTH = ["ingress", "egress"]
SEEN = [STATES, EVENTS]
ASKED_BY_ALL = ["teleop/*/command/stop", "teleop/*/command/clock"]
ALIVE = [ALIVES]
OPERATED = ["teleop/*/command/**", "teleop/*/stick", "teleop/*/alive/*"]
EVERYTHING = [
    "put",
    "delete",
    "declare_subscriber",
    "query",
    "declare_queryable",
    "reply",
    "liveliness_token",
    "liveliness_query",
    "declare_liveliness_subscriber",
]


def _rule(name: str, flows: list[str], messages: list[str], keys: list[str]) -> dict[str, Any]:
    return {"id": name, "permission": "allow", "flows": flows, "messages": messages, "key_exprs": keys}


RULES = [
    _rule("see-in", ["ingress"], ["declare_subscriber"], SEEN),
    _rule("see-out", ["egress"], ["put"], SEEN),
    _rule("ask-in", ["ingress"], ["query"], ASKED_BY_ALL),
    _rule("ask-out", ["egress"], ["reply", "declare_queryable"], ASKED_BY_ALL),
    _rule("alive-in", ["ingress"], ["liveliness_query", "declare_liveliness_subscriber"], ALIVE),
    _rule("alive-out", ["egress"], ["liveliness_token", "reply"], ALIVE),
    _rule("operate-in", ["ingress"], ["put", "query", "liveliness_token"], OPERATED),
    _rule("operate-out", ["egress"], ["declare_subscriber", "declare_queryable", "reply"], OPERATED),
    _rule("operate-alive", ["egress"], ["declare_liveliness_subscriber", "liveliness_query"], OPERATED),
    _rule(
        "reach", ["egress"], ["declare_subscriber", "liveliness_query", "declare_liveliness_subscriber"], SEEN + ALIVE
    ),
    _rule("route", BOTH, EVERYTHING, ["teleop/**"]),
]
WATCHING = [rule["id"] for rule in RULES if not rule["id"].startswith(("operate", "reach", "route"))]
ROLES: Mapping[str, list[str]] = {
    "watch": WATCHING,
    "rig": [*WATCHING, "reach"],
    "operate": [rule["id"] for rule in RULES if rule["id"] not in ("reach", "route")],
    "router": ["route"],
}
"""The rules of each role. A rig watches the others, is reached by who watches all, and beside that has its own keys."""


def access_control(members: Mapping[str, str]) -> dict[str, Any]:
    """Zenoh's `access_control`: a subject for each role, and one for each rig with the keys that are its own."""
    named = {role: sorted(name for name, of in members.items() if of == role) for role in ROLES}
    subjects = [{"id": role, "cert_common_names": names} for role, names in named.items() if names]
    policies = [{"rules": ROLES[each["id"]], "subjects": [each["id"]]} for each in subjects]
    own = [_rule(f"own-{rig}", BOTH, EVERYTHING, [f"teleop/{rig}/**"]) for rig in named["rig"]]
    subjects += [{"id": f"rig-{rig}", "cert_common_names": [rig]} for rig in named["rig"]]
    policies += [{"rules": [f"own-{rig}"], "subjects": [f"rig-{rig}"]} for rig in named["rig"]]
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": [*RULES, *own],
        "subjects": subjects,
        "policies": policies,
    }
