"""Overlays: what an author adds to a model that its own language cannot say (thesis 3.4).

What reads YAML is imported by who asks for it: most runs have no overlay.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sysmlc.overlay.model import Refinement
    from sysmlc.overlay.reading import files_of, read

__all__ = ["SUFFIX", "Refinement", "files_of", "read"]

SUFFIX = ".overlay.yaml"
"""How the overlay beside a model is called: the model's name with this for its suffix."""

_MODULES = {"Refinement": "model", "files_of": "reading", "read": "reading"}


def __getattr__(name: str) -> object:
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}", name=name)
    return getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)
