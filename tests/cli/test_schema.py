"""The schemas that editors are given."""

from __future__ import annotations

import json

import pytest

from teleop.cli.schema import schema


@pytest.mark.parametrize("kind", ["sequence", "profile", "pad"])
def test_a_schema_is_printed_as_json(capsys, kind):
    assert schema(kind) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["$schema"].startswith("https://json-schema.org/")
    assert found["properties"]
