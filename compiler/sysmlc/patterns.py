"""Regular expressions that are compiled when something is looked for with them.

To compile one takes a process 0.1 ms and more, and most inputs need few of those of a run.
"""

import re
from typing import Any, AnyStr, cast

_METHODS = ("match", "fullmatch", "search", "finditer", "findall", "split", "sub", "subn")
_WORDS = (*_METHODS, "groups", "groupindex")


def pattern(text: AnyStr, flags: int = 0) -> re.Pattern[AnyStr]:
    """What ``re.compile`` gives, for who calls its methods; a wrong text is told at the first call.

    ``re.compile`` is for expressions that nearly every run needs.
    """
    return cast("re.Pattern[AnyStr]", _Late(text, flags))


class _Late:
    def __init__(self, text: str | bytes, flags: int) -> None:
        self.pattern = text
        self.flags = flags

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 - any method of a pattern
        compiled: re.Pattern[Any] = re.compile(self.pattern, self.flags)
        self.__dict__.update({word: getattr(compiled, word) for word in _WORDS})
        self.__class__ = _Compiled  # type: ignore[assignment]
        return getattr(compiled, name)


class _Compiled:
    """With the methods of its pattern as attributes: to ask for one costs no call any more."""
