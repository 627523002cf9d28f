"""References into other files: the parts of an href, and the files of the standards."""

import re
from urllib.parse import unquote

from sysmlc.ir import Kind

PRIMITIVES = ("Boolean", "Integer", "Real", "String", "UnlimitedNatural")
PRIMITIVE_TYPES = "http://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#"
"""The UML primitives of all dialects share one stub each, under this href."""

_STANDARD = re.compile(
    r"""pathmap://(UML_|SysML|SYSMLC_)\w*(LIBRARIES|METAMODELS|PROFILES)/
    | https?://(www|schema)\.omg\.org/spec/(UML|SysML|MOF|XMI)/
    | https?://www\.eclipse\.org/(uml2|emf)/
    | https?://www\.eclipse\.org/papyrus/(0\.7\.0/SysML|sysml/)
    | https?://www\.sparxsystems\.com/profiles/SysML
    | (.*/)?(UML_Standard_Profile|SysML\ Profile|MD_customization_for_\w+)\.(mdzip|mdxml|xml)$
    | (.*/)?UML_Standard_Profile\.[\w.]*profile\.uml$
    """,
    re.VERBOSE,
)
_PRIMITIVES_ONLY = re.compile(r"(.*/)?(UML)?PrimitiveTypes\.(library\.uml|xmi)")
_ALIASES = {
    "bool": "Boolean",
    "boolean": "Boolean",
    "eboolean": "Boolean",
    "byte": "Integer",
    "short": "Integer",
    "int": "Integer",
    "long": "Integer",
    "eint": "Integer",
    "elong": "Integer",
    "eshort": "Integer",
    "float": "Real",
    "double": "Real",
    "efloat": "Real",
    "edouble": "Real",
    "ebiginteger": "Integer",
    "ebigdecimal": "Real",
    "estring": "String",
    **{name.lower(): name for name in PRIMITIVES},
}
_ROLE_NAME = re.compile(r"(?:.*[._])?[a-zA-Z]+_packagedElement_(?P<name>.+)")
_PACKAGEABLE = re.compile(r"(?:.*-)?(?P<name>[^-]+)_PackageableElement")
_ESCAPE = re.compile(r"_u([0-9a-fA-F]{4})")


def split_href(href: str) -> tuple[str, str]:
    """Return the file and the fragment of an href."""
    library, _, fragment = href.partition("#")
    return library, fragment


def is_href(target: str) -> bool:
    """Whether the target of a reference names a file, not only an id."""
    return "://" in target or target.find("#") > 0


def is_standard(library: str) -> bool:
    """Whether the file belongs to UML, SysML or sysmlc: its content is known unread."""
    return _STANDARD.match(unquote(library)) is not None


def has_primitives_only(library: str) -> bool:
    """Whether the file is UML's library of primitive types, which never gets new elements."""
    return _PRIMITIVES_ONLY.fullmatch(unquote(library)) is not None


def find_primitive(href: str, path: str, kind: Kind) -> str:
    """Return the UML primitive that an href leads to, or the empty string.

    *path* and *kind* are what the source says about the target. The primitive value types of SysML
    count as those of UML, the types of Ecore and Java as the nearest one.
    """
    if kind not in (Kind.CLASS, Kind.DATA_TYPE) or not is_standard(split_href(href)[0]):
        return ""
    return _ALIASES.get(read_name(href, path).lower(), "")


def read_name(href: str, path: str) -> str:
    """Return the name of the target from its path, else from the fragment."""
    if path:
        return path.rpartition("::")[2]
    fragment = unquote(split_href(href)[1])
    for form in (_PACKAGEABLE, _ROLE_NAME):
        match = form.fullmatch(fragment)
        if match:
            return _ESCAPE.sub(lambda code: chr(int(code[1], 16)), match["name"])
    return re.split(r"[./]", fragment)[-1] or fragment


def choose_kind(href: str, kinds: set[Kind]) -> Kind:
    """Return the kind of the target from the kinds that its references expect.

    A kind other than Class is more specific and wins.
    """
    if "stereotype_packagedElement_" in href:
        return Kind.STEREOTYPE
    specific = sorted(kinds - {Kind.CLASS})
    return specific[0] if specific else Kind.CLASS
