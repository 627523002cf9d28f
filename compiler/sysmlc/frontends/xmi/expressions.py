"""Values that a package owns: elements, for constraints and observations refer to them."""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import metaclasses
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.elements import Reader
from sysmlc.frontends.xmi.making import make
from sysmlc.frontends.xmi.value_features import value_in
from sysmlc.ir import Kind


def _packaged_value(type_name: str) -> Reader:
    def read(context: Context, row: int) -> None:
        document = context.document
        if document.features[row] != "packagedElement":
            context.subtree(row, Verdict.UNSUPPORTED)
            return
        subkind = metaclasses.hyphenated(type_name)
        make(context, row, Kind.EXPRESSION, subkind, type_name, "packagedElement")
        element = context.graph[context.gids[row]]
        value = value_in(context, row)
        element.attrs["value"] = value.value
        if value.language:
            element.attrs["value_language"] = value.language

    return read


TYPES: dict[str, Reader] = {name: _packaged_value(name) for name in metaclasses.VALUE_TYPES}
