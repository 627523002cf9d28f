"""Rules of reading the snapshots of used projects."""

from sysmlc.diagnostics import Severity, rule

BROKEN_SNAPSHOT = rule(
    "SM115",
    "broken-snapshot",
    Severity.WARNING,
    "the snapshot '{file}' of a used project cannot be read: {problem}",
    why="A project archive holds what its model takes from other projects in snapshots. Without "
    "one of them the model is read, but what it takes from there is known by name only.",
    help="open the project in the modelling tool with its used projects at hand, and save it",
    wrong='<xmi:XMI xmlns:uml="http://www.nomagic.com/magicdraw/UML/2.5.1"><uml:Package></xmi:XMI>',
    right='<xmi:XMI xmlns:uml="http://www.nomagic.com/magicdraw/UML/2.5.1"><uml:Package/></xmi:XMI>',
)

UNKNOWN_IN_LIBRARY = rule(
    "SM155",
    "unknown-library-attribute",
    Severity.WARNING,
    "attribute '{attribute}' of '{element}'{others}, taken from '{library}', is known neither to "
    "UML nor to MagicDraw",
    why="What a model takes from a used project is read like the model itself, and no metaclass "
    "of UML 2 has such a feature: most likely the snapshot was changed by a script or by hand.",
    help="open the project in the modelling tool with its used projects at hand, and save it",
    wrong='<packagedElement xsi:type="uml:Class" ID="r" name="Robot" isAbstrct="true"/>',
    right='<packagedElement xsi:type="uml:Class" ID="r" name="Robot" isAbstract="true"/>',
)
