"""Namespaces of XMI and UML in all their versions, and which files they make ours."""

import re
from functools import lru_cache

_XMI = re.compile(r"https?://(www|schema)\.omg\.org/spec/XMI(/[\d.]+)?/?$|^omg\.org/XMI/2")
_UML = re.compile(
    r"https?://www\.eclipse\.org/uml2/[\d.]+/UML/?$"
    r"|https?://(www|schema)\.omg\.org/spec/UML/[\d.]+/?$"
)
_SYSML = re.compile(
    r"https?://www\.eclipse\.org/papyrus/(0\.7\.0/SysML|sysml/[\d.]+/SysML)/\w"
    r"|https?://(www|schema)\.omg\.org/spec/SysML/"
    r"|https?://www\.sparxsystems\.com/profiles/SysML"
)
_SETTINGS = re.compile(r"MagicDrawProfile/?$|eclipse\.org/emf/2002/Ecore$|/UMLD[IC]/?$|/spec/MOF/")


@lru_cache(256)
def is_xmi(namespace: str) -> bool:
    """Whether it is a namespace of XMI 2."""
    return _XMI.match(namespace) is not None


@lru_cache(256)
def is_uml(namespace: str) -> bool:
    """Whether it is a namespace of UML 2 (a profile of UML is not)."""
    return _UML.match(namespace) is not None


@lru_cache(256)
def is_settings(namespace: str) -> bool:
    """Whether its elements say how a tool shows or stores the model, and nothing else."""
    return _SETTINGS.search(namespace) is not None


def is_sysml(namespace: str) -> bool:
    """Whether its elements are applications of SysML's own stereotypes."""
    return _SYSML.match(namespace) is not None
