"""Writes ``metamodels/library-members.txt``: the names that members inherit from the library.

Run it after a change to another release of the standard library, which a test reports:

    python tests/backends/sysml/library_names.py
"""

from textwrap import wrap

from sysmlc.backends.sysml.library import BASES, MEMBER_NAMES_FILE
from sysmlc.language.library import find_library
from sysmlc.language.names import Model
from sysmlc.support import resources

WIDTH = 98


def format_member_names():
    """Return the names that each base has in the installed library, as the file lists them."""
    model = Model([], find_library())
    lines = []
    for base in sorted({*BASES.values()}):
        names = " ".join(sorted(find_member_names(model, base)))
        lines += [base, *wrap(names, WIDTH, initial_indent="  ", subsequent_indent="  ")]
    return "\n".join(lines) + "\n"


def find_member_names(model, base):
    """Return the effective names and the short names of all members that are not private."""
    definition = model.find(base)
    if definition is None:
        raise KeyError(base)
    members = [member for member in model.members(definition) if member.visibility != "private"]
    return {name for member in members for name in (model.name(member), member.short_name) if name}


if __name__ == "__main__":
    path = resources.path("metamodels", MEMBER_NAMES_FILE)
    path.write_text(format_member_names(), encoding="utf-8")
