"""YAML text to nodes, refused as soon as they are too deep or too many: before that has cost time or the stack.

PyYAML composes nodes out of events; its composer is kept, and counts here, while the events come from libyaml where
that is installed, which is ten times as fast.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import yaml
from yaml.composer import Composer
from yaml.constructor import BaseConstructor
from yaml.parser import Parser
from yaml.reader import Reader
from yaml.resolver import BaseResolver
from yaml.scanner import Scanner

TOO_DEEP = "is nested too deeply"


class _Python(Reader, Scanner, Parser):
    """Events without libyaml."""

    def __init__(self, text: str) -> None:
        Reader.__init__(self, text)
        Scanner.__init__(self)
        Parser.__init__(self)


if TYPE_CHECKING or not yaml.__with_libyaml__:
    _Events = _Python
else:
    from yaml.cyaml import CParser as _Events


class TooMuchError(yaml.MarkedYAMLError):
    """More than was allowed; `problem` says of what, `problem_mark` where."""


def compose(text: str, deepest: int, most: int) -> yaml.Node | None:
    """The one node of a text, None for an empty one; at most `most` nodes, keys counted, in each other `deepest` deep.

    Raises yaml.YAMLError.
    """
    try:
        return _Loader(text, deepest, most).get_single_node()
    except yaml.MarkedYAMLError as error:
        if "nesting" in str(error.problem):  # libyaml, looking ahead, found it first
            raise TooMuchError(problem=TOO_DEEP, problem_mark=error.problem_mark or error.context_mark) from None
        raise


class _Loader(Composer, _Events, BaseConstructor, BaseResolver):
    def __init__(self, text: str, deepest: int, most: int) -> None:
        _Events.__init__(self, text)
        Composer.__init__(self)
        BaseConstructor.__init__(self)
        BaseResolver.__init__(self)
        self._deepest, self._most = deepest, most
        self._depth = self._count = 0

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        self._count += 1
        self._depth += 1
        if self._depth > self._deepest or self._count > self._most:
            what = TOO_DEEP if self._depth > self._deepest else "holds too many values"
            raise TooMuchError(problem=what, problem_mark=self.peek_event().start_mark)
        node = Composer.compose_node(self, parent, index)
        self._depth -= 1
        return node
