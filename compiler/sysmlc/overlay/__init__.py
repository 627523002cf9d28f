"""Overlays: what an author adds to a model that its own language cannot say (thesis 3.4).

The parts are imported by those who have an overlay: ``model`` its values, ``reading`` its YAML.
"""

SUFFIX = ".overlay.yaml"
"""How the overlay beside a model is called: the model's name with this for its suffix."""
