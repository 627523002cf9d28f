"""Names: what every name of a model leads to, and what its elements specialise."""

from sysmlc.language.names.model import Model
from sysmlc.language.names.resolution import resolve, resolve_all

__all__ = ["Model", "resolve", "resolve_all"]
