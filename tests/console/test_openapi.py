"""The description at `/api`: sound by an independent judge, and of just what there is."""

from __future__ import annotations

import jsonschema
import pytest
from console_bench import ConsoleBench
from openapi_spec_validator import OpenAPIV31SpecValidator
from starlette.routing import Route

from teleop.console.command_schemas import COMMANDS, COMMON
from teleop.door.messages import INTERNAL, SHAPES


@pytest.fixture(scope="module")
def described():
    with ConsoleBench() as bench:
        answer = bench.get("/api")
        routes = [route for route in bench.console._routes if isinstance(route, Route)]
        return answer.json(), routes, bench.get("/api/state").json()


def test_it_is_sound(described):
    OpenAPIV31SpecValidator(described[0]).validate()


def test_it_has_every_path_and_method_under_api(described):
    told = {
        (path, method.upper())
        for path, item in described[0]["paths"].items()
        for method in item
        if method != "parameters"
    }
    served = {
        (route.path, method)
        for route in described[1]
        for method in route.methods or ()
        if route.path.startswith("/api") and method != "HEAD"
    }
    assert told == served


def test_it_has_every_command_of_the_door_with_its_fields():
    assert set(COMMANDS) - {"plan"} == set(SHAPES) - set(INTERNAL)
    for name, shape in SHAPES.items():
        if name not in INTERNAL:
            assert set(COMMANDS[name].required) == set(shape.required)
            assert set(COMMANDS[name].optional) == set(shape.optional)
            assert not set(COMMON) & {*shape.required, *shape.optional}


def test_a_state_and_a_command_are_as_described(described):
    description, _, state = described
    whole = {"components": description["components"]}
    jsonschema.validate(state, {"$ref": "#/components/schemas/State", **whole})
    command = {"do": "goto", "axes": {"pan": 10}, "seconds": 2, "wait": True}
    jsonschema.validate(command, {"$ref": "#/components/schemas/Command", **whole})
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({"do": "goto"}, {"$ref": "#/components/schemas/Command", **whole})
