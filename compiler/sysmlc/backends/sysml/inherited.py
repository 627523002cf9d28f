"""Names that every member of a kind has from the standard library (SysML 2.0, 9.2).

They hide what has such a name further out: a block called ``shape`` has to be named with its
package in a part, which has a shape of its own.
"""

from functools import cache

from sysmlc.support import resources

FILE = "library-members.txt"
"""Names by base; ``generate_inherited`` makes it of the library."""
BASES = {
    "action": "Actions::Action",
    "allocation": "Allocations::Allocation",
    "attribute": "Base::Anything",
    "connection": "Connections::Connection",
    "constraint": "Constraints::ConstraintCheck",
    "enum": "Base::Anything",
    "flow": "Flows::Message",
    "interface": "Interfaces::Interface",
    "item": "Items::Item",
    "metadata": "Metadata::MetadataItem",
    "occurrence": "Occurrences::Occurrence",
    "part": "Parts::Part",
    "port": "Ports::Port",
    "ref": "Base::Anything",
    "requirement": "Requirements::RequirementCheck",
    "state": "States::StateAction",
    "use case": "UseCases::UseCase",
    "verification": "VerificationCases::VerificationCase",
    "view": "Views::View",
    "viewpoint": "Views::ViewpointCheck",
}
"""What usages of each keyword specialise, whatever else they do; control nodes are actions."""
_CONTROLS = ("decide", "merge", "fork", "join")


@cache
def inherited(keyword: str) -> frozenset[str]:
    """The names that a definition or usage of this keyword has from the library."""
    plain = keyword.removesuffix(" def")
    base = BASES.get("action" if plain in _CONTROLS else plain)
    return _names().get(base or "", frozenset())


@cache
def _names() -> dict[str, frozenset[str]]:
    """By base; its names follow in lines that are indented."""
    found: dict[str, list[str]] = {}
    for line in resources.read_text("metamodels", FILE).splitlines():
        if not line.startswith(" "):
            names = found[line] = []
        else:
            names += line.split()
    return {base: frozenset(names) for base, names in found.items()}
