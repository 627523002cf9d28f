"""Overlays: what an author adds to a model that its own language cannot say (thesis 3.4)."""

from sysmlc.overlay.model import Refinement
from sysmlc.overlay.reading import list_files, read_overlay

__all__ = ["SUFFIX", "Refinement", "list_files", "read_overlay"]

SUFFIX = ".overlay.yaml"
"""How the overlay beside a model is called: the model's name with this for its suffix."""
