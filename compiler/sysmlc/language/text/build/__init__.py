"""The functions that build the tree, by the names that the grammars give them."""

from collections.abc import Mapping
from types import ModuleType

from sysmlc.language.text.build import (
    actions,
    connections,
    definitions,
    ends,
    expressions,
    features,
    kerml,
    kernel_members,
    lists,
    names,
    namespaces,
    operators,
    references,
    relationships,
    transitions,
    usages,
)
from sysmlc.language.text.machine import Action

_COMMON = (lists, names, namespaces, features, operators, expressions, ends, connections)
_SYSML = (definitions, usages, actions, references, transitions)


def _actions(modules: tuple[ModuleType, ...]) -> Mapping[str, Action]:
    return {name: action for module in modules for name, action in module.ACTIONS.items()}


ACTIONS: Mapping[str, Mapping[str, Action]] = {
    "kerml": _actions((*_COMMON, relationships, kerml, kernel_members)),
    "sysml": _actions(_COMMON + _SYSML),
}
