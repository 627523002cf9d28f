"""Makes ``metamodels/library-members.txt``: ``python -m sysmlc.backends.sysml.generate_inherited``.

Who moves on to another release of the standard library runs it; a test says when.
"""

from textwrap import wrap

from sysmlc.backends.sysml.inherited import BASES, FILE
from sysmlc.language.library import find_library
from sysmlc.language.names import Model
from sysmlc.support import resources

_WIDTH = 98


def text() -> str:
    """The names that every kind of member has, as the library that is installed says."""
    model = Model([], find_library())
    lines = []
    for base in sorted({*BASES.values()}):
        named = " ".join(sorted(_names(model, base)))
        lines += [base, *wrap(named, _WIDTH, initial_indent="  ", subsequent_indent="  ")]
    return "\n".join(lines) + "\n"


def _names(model: Model, base: str) -> set[str]:
    """Names and short names of what all can see of a definition. Raises KeyError for none."""
    found = model.find(base)
    if found is None:
        raise KeyError(base)
    seen = [one for one in model.members(found) if one.visibility != "private"]
    return {name for one in seen for name in (one.name, one.short_name) if name}


if __name__ == "__main__":
    resources.path("metamodels", FILE).write_text(text(), encoding="utf-8")
