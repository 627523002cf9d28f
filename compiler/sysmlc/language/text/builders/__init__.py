"""Build actions by the names that the grammars give them: they build the tree during the parse."""

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
from sysmlc.language.text.lalr import Action

# KerML reuses the builders of SysML where both notations agree.
_COMMON = (nodes, declarations, namespaces, operators, expressions, connections)
_SYSML = (definitions, usages, actions, referring_usages)


def _collect_actions(modules: tuple[ModuleType, ...]) -> Mapping[str, Action]:
    return {name: action for module in modules for name, action in module.ACTIONS.items()}


ACTIONS: Mapping[str, Mapping[str, Action]] = {
    "kerml": _collect_actions((*_COMMON, relationships, kerml)),
    "sysml": _collect_actions(_COMMON + _SYSML),
}
