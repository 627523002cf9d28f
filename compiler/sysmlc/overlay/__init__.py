"""Overlays: YAML files that add to a model what its language cannot express (thesis 3.4)."""

from sysmlc.overlay.model import Change, Refinement
from sysmlc.overlay.reading import list_files, read_overlay

__all__ = ["SUFFIX", "Change", "Refinement", "list_files", "read_overlay"]

SUFFIX = ".overlay.yaml"
"""Suffix of an overlay beside a model; it replaces the suffix of the model's name."""
