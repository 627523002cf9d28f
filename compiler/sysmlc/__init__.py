"""sysmlc: a model transformation compiler for cyber-physical production systems.

The names below are the Python API (docs/python-api.md). They are imported at their first use, so
that ``sysmlc --version`` and the completion of the shell do not import the compiler.

This module imports nothing at its start: ``python -m sysmlc`` runs it while the working folder,
which may belong to a stranger, still comes first in the search for modules (see ``__main__``).
"""

TYPE_CHECKING = False
"""Type checkers take it as true, like the name in ``typing``."""
if TYPE_CHECKING:
    from sysmlc.api.compiling import *  # noqa: F403 - their ``__all__`` are the only lists
    from sysmlc.api.verification import *  # noqa: F403

__version__ = "0.1.0"


def __getattr__(name: str) -> object:
    """Return a name of the API."""
    from importlib.util import find_spec

    # 'from sysmlc import config' first looks for a name; it must not import the compiler.
    is_special = name.startswith("_") and name != "__all__"
    if not is_special and find_spec(f"{__name__}.{name}") is None:
        from sysmlc.api import compiling

        if name in compiling.__all__:
            return getattr(compiling, name)
        # This import takes as long as that of all other modules together.
        from sysmlc.api import verification

        if name == "__all__":
            return [*compiling.__all__, *verification.__all__]
        if name in verification.__all__:
            return getattr(verification, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__getattr__("__all__")})  # type: ignore[misc]
