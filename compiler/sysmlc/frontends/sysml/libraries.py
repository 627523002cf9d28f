"""Packages of ours that models refer to, and where their text is."""

OUR_LIBRARY = "SysMLC"
"""Metadata and units that the back end ``sysml`` refers to."""
RECIPES = "RecipeLevels"
"""The levels of a recipe, to be specialised by models."""
PROFILE = "urn:sysmlc:profile:1"
"""Namespace of the profile that has the same levels for SysML v1."""
ACTIONS = "DIN8580"
"""Elementary actions of machines with their contracts."""
MACHINES = "LineMachines"
"""Other machines of a production line with their contracts."""
FLOORS = "Floors"
"""Robots on a floor, and a mission for them."""
FILES = {
    OUR_LIBRARY: "SysMLC.sysml",
    RECIPES: "RecipeLevels.sysml",
    ACTIONS: "DIN8580.sysml",
    MACHINES: "LineMachines.sysml",
    FLOORS: "Floors.sysml",
}
"""Their files in ``metamodels``."""
READ = frozenset({ACTIONS, MACHINES, FLOORS})
"""Those whose elements are in the graph, as external ones: what they demand counts."""
