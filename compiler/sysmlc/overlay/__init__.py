"""Overlays: what an author adds to a model that its own language cannot say (thesis 3.4)."""

from sysmlc.overlay.model import Refinement
from sysmlc.overlay.reading import files_of, read

__all__ = ["SUFFIX", "Refinement", "files_of", "read"]

SUFFIX = ".overlay.yaml"
"""How the overlay beside a model is called: the model's name with this for its suffix."""
