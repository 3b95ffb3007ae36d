"""The keys of FreeD and OpenTrackIO in a profile: each goes with sending or with following."""

from __future__ import annotations

import pytest

from teleop.app.json_schema import schema
from teleop.config.documents.document import DocumentError
from teleop.config.exchange.freed import RECEIVERS, FreeDSection
from teleop.config.profile import checked_profile
from teleop.config.resources import find
from teleop.exchange.attitude import Attitude
from teleop.exchange.freed.codec import D1, encode
from teleop.exchange.freed.sending import LensCounts


def exchange(entry: str):
    text = find("sim", "profiles", "rig")[0].read_text(encoding="utf-8")
    return checked_profile(f"{text}\nexchange:\n  - {{{entry}}}\n", "test.yaml").exchange[0]


@pytest.mark.parametrize(
    ("entry", "why"),
    [
        ("type: freed", "needs either to, to send, or listen, to follow"),
        ("type: freed, to: 'a:1', listen: 'b:1'", "needs either to"),
        ("type: freed, to: 'a:1', as: target", "as only goes with listen"),
        ("type: freed, listen: 'a:1', as: target, rate: 30", "rate only goes with to"),
        ("type: freed, listen: 'a:1', as: target, lens: {zoom: 1}", "lens only goes with to"),
        ("type: opentrackio, listen: 'a:1', as: target, encoding: cbor", "encoding only goes with to"),
        ("type: freed, listen: 'a:1'", "write as: target or as: base"),
        ("type: freed, listen: 'a:1', as: base", "needs the point"),
        ("type: freed, listen: 'a:1', as: target, target: [1, 2, 3]", "does not go with as: target"),
        ("type: freed, listen: 'a:1', as: base, target: [1, 2, 3], position: [0, 0, 0]", "does not go with as: base"),
        ("type: freed, to: 'serial:'", "must be serial:DEVICE"),
        ("type: freed, to: 'serial:/dev/ttyS0@fast'", "must be serial:DEVICE"),
        ("type: freed, to: 'a:0'", "must have the receiver's port"),
        ("type: freed, to: 'a:1', position: [0, 0, 132]", "131"),
        ("type: freed, to: 'a:1', lens: {focus: [0, 16777216]}", "must be at most"),
        ("type: freed, to: 'a:1', receiver: vizrt", "receiver"),
        ("type: opentrackio, to: '239.135.1.1:55555', interface: eth0", "this computer's address"),
        ("type: opentrackio, to: '239.135.1.1:55555', encoding: xml", "encoding"),
    ],
)
def test_what_is_wrong_is_named(entry, why):
    with pytest.raises(DocumentError, match=why):
        exchange(entry)


def test_the_entries_of_the_contract_are_taken():
    assert (
        exchange(
            "type: freed, to: '10.0.0.9:40000', camera: 1, rate: 50, position: [0, 0, 1.6], "
            "lens: {zoom: [0, 65535], focus: [0, 65535]}"
        ).type
        == "freed"
    )
    assert exchange("type: opentrackio, to: '239.135.1.1:55555', source: 1, encoding: json").type == "opentrackio"


def test_editors_know_the_keys():
    sections = schema("profile")["$defs"]
    assert {"to", "listen", "camera", "rate", "latency", "position", "lens", "receiver", "as", "target"} <= set(
        sections["FreeDSection"]["properties"]
    )
    for name in ("FreeDSection", "OpenTrackIOSection", "LensSection", "LookBesideSection"):
        assert all("description" in each for each in sections[name]["properties"].values()), name


BODIES = {
    None: ("000000", "008000"),
    "unreal": ("000000", "008000"),
    "panasonic": ("000555", "000aaa"),
    "sony": ("000000", "008000"),
    "mosys": ("000000", "008000"),
    "stype": ("000000", "800000"),
    "ncam": ("000000", "800000"),
}


@pytest.mark.parametrize(("receiver", "counts"), BODIES.items())
def test_each_receiver_gets_zoom_and_focus_in_its_own_counts(receiver, counts):
    section = FreeDSection.model_validate(
        {"type": "freed", "to": "a:1", **({"receiver": receiver} if receiver else {})}
    )
    zoom, focus = LensCounts(section).counts(Attitude(0, 0, 0, 0.5))
    body = encode(D1(1, 0, 0, 0, 0, 0, 0, zoom, focus))
    assert (body[20:23].hex(), body[23:26].hex()) == counts
    assert BODIES.keys() - {None} == RECEIVERS.keys()


@pytest.mark.parametrize(
    ("lens", "counts"),
    [
        ({"zoom": 7}, (7, 32768)),
        ({"zoom": [9, 100], "focus": [1000, 0]}, (9, 500)),
        ({"focus": 12}, (0, 12)),
    ],
)
def test_a_lens_of_ones_own_overrules(lens, counts):
    section = FreeDSection.model_validate({"type": "freed", "to": "a:1", "lens": lens})
    assert LensCounts(section).counts(Attitude(0, 0, 0, 0.5)) == counts


def test_without_a_focus_its_near_end_is_sent():
    section = FreeDSection.model_validate({"type": "freed", "to": "a:1", "receiver": "sony"})
    assert LensCounts(section).counts(Attitude(0, 0, 0, None)) == (0, 0x1000)
