"""How much the rules for models in SysML v1 matter for text of SysML v2."""

from collections.abc import Sequence

from sysmlc.diagnostics import Severity, Sink
from sysmlc.language.tree import Document

_JUDGED = """
    SM201 SM202 SM203 SM204 SM211 SM212 SM213 SM214 SM301 SM314 SM318 SM401 SM404 SM469
"""
"""Names, specialisation, types and relations are judged by the checks of the language itself, by
its own rules. Requirements, ports and flows need no short name, type or payload there, an action
without steps is complete, and a usage has the parameters that it does not repeat: SM248 and SM249
tell the arguments and parameters that are too many. Types of a redefinition are all of them."""
_POSSIBLE = "SM412 SM413 SM414 SM415 SM421"
"""Valid SysML v2 of which a contract holds less: names and types of expressions are resolved by
the language, values need not be finite, a state with substates needs no entry transition."""

SEVERITIES: dict[str, Severity | None] = {
    **dict.fromkeys(_JUDGED.split(), None),
    **dict.fromkeys(_POSSIBLE.split(), Severity.WARNING),
}


def settle(documents: Sequence[Document], sink: Sink) -> None:
    """Let findings about elements of these documents matter as SysML v2 has it."""
    sink.settle((one.path for one in documents), SEVERITIES)
