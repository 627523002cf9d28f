"""Packages of ours that models refer to, and where their text is."""

OUR_LIBRARY = "SysMLC"
"""Metadata and units that the back end ``sysml`` refers to."""
RECIPES = "RecipeLevels"
"""The levels of a recipe, to be specialised by models."""
PROFILE = "urn:sysmlc:profile:1"
"""Namespace of the profile that has the same levels for SysML v1."""
FILES = {OUR_LIBRARY: "SysMLC.sysml", RECIPES: "RecipeLevels.sysml"}
"""Their files in ``metamodels``."""
