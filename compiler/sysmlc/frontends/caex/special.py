"""Interfaces with a meaning of their own: they are told by inheritance, never by name alone."""

from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import BASE_INTERFACE, BASE_ROLE

PPR, ORDER = "ppr", "order"
_Meanings = dict[tuple[str, ...], str]

_INTERFACES: _Meanings = {
    (*BASE_INTERFACE, "PPRConnector"): PPR,
    (*BASE_INTERFACE, "Order"): ORDER,
    (*BASE_INTERFACE, "ExternalDataConnector", "COLLADAInterface"): "collada",
    (*BASE_INTERFACE, "ExternalDataConnector", "PLCopenXMLInterface"): "plcopen",
    (*BASE_INTERFACE, "ExternalDataConnector"): "external-data",
}
DOCUMENTS = frozenset({"collada", "plcopen", "external-data"})
"""Meanings of interfaces that lead out of AutomationML, to a file of another language."""

_ROLES: _Meanings = {
    (*BASE_ROLE, "Product"): "product",
    (*BASE_ROLE, "Process"): "process",
    (*BASE_ROLE, "Resource"): "resource",
}


def meaning(interface: Type | None) -> str:
    """What an interface class is for, or nothing special."""
    return _first(interface, _INTERFACES)


def ppr(role: Type) -> str:
    """Whether a role is that of a product, process or resource."""
    return _first(role, _ROLES)


def _first(type: Type | None, table: _Meanings) -> str:
    for one in type.chain() if type is not None else ():
        if one.path in table:
            return table[one.path]
    return ""
