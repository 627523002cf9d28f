"""Words of names in CamelCase."""

import re

_WORD_BOUNDARY = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")


def separate_words(name: str) -> str:
    """Return a name in lower case with blanks (``final state``); an acronym is unchanged."""
    return name if name.isupper() else _WORD_BOUNDARY.sub(" ", name).lower()
