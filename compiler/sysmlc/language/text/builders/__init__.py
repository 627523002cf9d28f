"""Build actions: the parser calls them to build the tree while it parses.

Each module has a table ``ACTIONS`` of functions by the names that the rules of the grammars have
(``grammars/kerml-common.lark``, ``kerml.lark``, ``sysml.lark``). The parser calls the action of a
rule when it reduces the rule, with the tokens, whose ``begin`` and ``stop`` are the span of the
rule, and the values of its symbols. The value of a terminal is the index of its token, and the
value of an absent optional symbol is None.
"""

from collections.abc import Mapping
from types import ModuleType

from sysmlc.language.text.builders import (
    actions,
    connections,
    declarations,
    definitions,
    expressions,
    kerml,
    namespaces,
    nodes,
    operators,
    referring_usages,
    relationships,
    usages,
)
from sysmlc.language.text.lexer import Action

# KerML reuses the builders of SysML where both notations agree.
_COMMON = (nodes, declarations, namespaces, operators, expressions, connections)
_SYSML = (definitions, usages, actions, referring_usages)


def _collect_actions(modules: tuple[ModuleType, ...]) -> Mapping[str, Action]:
    return {name: action for module in modules for name, action in module.ACTIONS.items()}


ACTIONS: Mapping[str, Mapping[str, Action]] = {
    "kerml": _collect_actions((*_COMMON, relationships, kerml)),
    "sysml": _collect_actions(_COMMON + _SYSML),
}
