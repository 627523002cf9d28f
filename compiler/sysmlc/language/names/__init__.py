"""Name resolution: the elements that names denote, and the generals of elements."""

from sysmlc.language.names.model import Model
from sysmlc.language.names.resolution import resolve, resolve_all

__all__ = ["Model", "resolve", "resolve_all"]
