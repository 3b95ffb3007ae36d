"""What the drone's broadcast can hold, for people: every part with its flag in both layouts, and every field."""

from __future__ import annotations

from teleop.cli.codec.broadcast_fields import WIDTH, parts
from teleop.dji.drone.broadcast import PARTS, A3Broadcast, Broadcast, Several

LINES = list(parts())
HEADS = [line for line in LINES if line and not line.startswith(" ")]


def test_every_part_of_either_layout_is_there_once_with_its_flags():
    assert [head.partition(":")[0] for head in HEADS] == list(A3Broadcast.order)
    for head in HEADS:
        name = head.partition(":")[0]
        m100 = f"m100 bit {Broadcast.order.index(name)}," if name in Broadcast.order else "m100 none,"
        assert m100 in head
        assert f"a3 bit {A3Broadcast.order.index(name)}," in head
        assert head.endswith(f"{PARTS[name].size} bytes")


def test_every_field_but_what_is_reserved_is_listed_below_its_part():
    for name, part in PARTS.items():
        if isinstance(part, Several) and name in A3Broadcast.order:
            begin = next(index for index, line in enumerate(LINES) if line.startswith(f"{name}:"))
            block = LINES[begin : LINES.index("", begin)]
            listed = [line.split()[0] for line in block if line.startswith("    ") and line[4] != " "]
            assert listed == [field.name for field in part.cls.layout.fields if field.name != "reserved"]


def test_no_line_is_wider_than_a_page():
    assert max(map(len, LINES)) <= WIDTH
