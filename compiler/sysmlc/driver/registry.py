"""Front ends, passes, back ends and rules: where they are found, imported when they are used.

Other distributions add passes and back ends by entry points. A pass of a plug-in runs after those
of sysmlc. The rules of a plug-in are those that its modules define when they are imported.
"""

import dataclasses
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from typing import TYPE_CHECKING, Any, cast

from msgspec import Struct, structs

from sysmlc.backends.base import Backend
from sysmlc.config import ConfigError
from sysmlc.diagnostics import Rule, catalogue
from sysmlc.frontends.base import Frontend, Libraried
from sysmlc.passes import pipeline
from sysmlc.passes.base import Pass
from sysmlc.support.suggestions import did_you_mean

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

BACKEND_GROUP = "sysmlc.backends"
"""Entry point group of back ends; an entry names an object with the protocol ``Backend``."""
PASS_GROUP = "sysmlc.passes"
"""Entry point group of passes; an entry names an object with the protocol ``Pass``."""

_FRONTENDS = tuple(f"sysmlc.frontends.{name}" for name in ("xmi", "huds", "caex", "sysml", "ir"))
_BACKENDS = {
    name: f"sysmlc.backends.{name}"
    for name in (
        "contracts",
        "recipe",
        "platform",
        "plantuml",
        "graph",
        "ecore",
        "ir",
        "reqtable",
        "uml",
        "sysml",
        "aml",
        "sysmlx",
        "gr1c",
        "slugs",
        "tlsf",
        "smv",
        "chase",
        "spot",
    )
}
_DEFAULT = frozenset({"contracts", "recipe", "platform", "plantuml"})
"""Ours with ``is_default``: the others are not even imported unless they are asked for."""
_RULE_PACKAGES = (
    "frontends",
    "language",
    "logic",
    "recipe",
    "overlay",
    "simulation",
    "synthesis",
    "robots",
    "passes",
    "backends",
    "driver",
)


class BackendError(Exception):
    """A back end is unknown, twice there, or cannot be loaded."""


def frontends(library: str = "") -> list[Frontend]:
    """Return the front ends in the order in which they are asked.

    ``library`` is where the model library of SysML v2 is; empty where it is usually found.
    """
    found = [cast("Frontend", import_module(name).FRONTEND) for name in _FRONTENDS]
    if not library:
        return found
    return [one.with_library(library) if isinstance(one, Libraried) else one for one in found]


def passes(options: Mapping[str, Mapping[str, object]]) -> list[Pass]:
    """Return the passes in order, with *options* by the name of the pass.

    Raise ConfigError for a pass or an option that does not exist, and for a plug-in that cannot be
    loaded.
    """
    plug_ins = find_plug_ins(PASS_GROUP)
    names = [*pipeline.NAMES, *plug_ins]
    for name in options:
        if name not in names:
            advice = did_you_mean(name, names)
            raise ConfigError(f"passes.{name}: there is no such pass; {advice}")
    loaded = [pipeline.load(name) for name in pipeline.NAMES]
    loaded += [_load_pass(entry) for entry in plug_ins.values()]
    return pipeline.ordered(_with_options(one, options.get(one.name, {})) for one in loaded)


def _load_pass(entry: EntryPoint) -> Pass:
    if entry.name in pipeline.NAMES:
        raise ConfigError(f"the plug-in {entry.value} takes the name of pass '{entry.name}'")
    try:
        return cast("Pass", entry.load())
    except Exception as problem:
        raise ConfigError(f"pass '{entry.name}' cannot be loaded: {problem!r}") from problem


def _with_options(one: Pass, options: Mapping[str, object]) -> Pass:
    if not options:
        return one
    known = _option_names(one)
    for name, value in options.items():
        where = f"passes.{one.name}.{name}"
        if name not in known:
            raise ConfigError(f"{where}: there is no such option; {did_you_mean(name, known)}")
        if not _fits(value, getattr(one, name)):
            wanted = type(getattr(one, name)).__name__
            raise ConfigError(f"{where}: {value!r} is no {wanted}")
    replace = structs.replace if isinstance(one, Struct) else dataclasses.replace
    return cast("Pass", replace(cast("Any", one), **options))


def _option_names(step: Pass) -> list[str]:
    """Return the names of the options of a pass: the fields of a struct or a dataclass."""
    if isinstance(step, Struct):
        return list(step.__struct_fields__)
    return [field.name for field in dataclasses.fields(cast("DataclassInstance", step))]


def _fits(value: object, default: object) -> bool:
    """Whether an option has the type of its default; TOML's integers serve as numbers."""
    if isinstance(value, bool) or isinstance(default, bool):
        return isinstance(value, bool) and isinstance(default, bool)
    return isinstance(value, type(default)) or (
        isinstance(default, float) and isinstance(value, int)
    )


def backend_names() -> list[str]:
    """Names of all back ends, those of plug-ins included; loads none."""
    return sorted({*_BACKENDS, *_others()})


def load_backends(names: Iterable[str]) -> list[Backend]:
    """The back ends with these names, each once. Raises BackendError."""
    return _loaded(names, _others())


def _loaded(names: Iterable[str], others: dict[str, EntryPoint]) -> list[Backend]:
    return [_load(name, others) for name in dict.fromkeys(names)]


def _others() -> dict[str, EntryPoint]:
    """Return the back ends of other distributions by name. Raise BackendError."""
    plug_ins = find_plug_ins(BACKEND_GROUP)
    for name, entry in plug_ins.items():
        if name in _BACKENDS:
            raise BackendError(f"the plug-in {entry.value} takes the name of back end '{name}'")
    return plug_ins


def find_plug_ins(group: str) -> dict[str, EntryPoint]:
    """Return the entry points of other distributions by name, sorted by name; load none."""
    entries = [entry for entry in entry_points(group=group) if not _is_ours(entry)]
    return {entry.name: entry for entry in sorted(entries, key=lambda entry: entry.name)}


def select_backends(wanted: Sequence[str]) -> list[Backend]:
    """Back ends for ``--emit``: plain names replace the default set, ``+name`` adds to it.

    Raises BackendError; an unknown name is answered with the known ones.
    """
    plain = [name for name in wanted if not name.startswith("+")]
    added = [name[1:] for name in wanted if name.startswith("+")]
    others = _others()
    if plain:
        return _loaded([*plain, *added], others)
    chosen = _known(added, others)
    unasked = _BACKENDS.keys() - _DEFAULT - chosen
    every = _loaded(sorted({*_BACKENDS, *others} - unasked), others)
    return [backend for backend in every if backend.is_default or backend.name in chosen]


def full_catalogue(note: Callable[[str], None] = lambda _: None) -> dict[str, Rule]:
    """Every rule there is: imports every module that may hold one, and the plug-ins that load.

    ``note`` is told of each module that cannot be imported: its rules are missing.
    """
    for package in _RULE_PACKAGES:
        for module in _modules(f"sysmlc.{package}"):
            try:
                import_module(module)
            except Exception as problem:
                note(f"the rules of {module} are missing: {problem!r}")
    others = _others()
    for name in others:
        with suppress(BackendError):
            _load(name, others)
    for entry in find_plug_ins(PASS_GROUP).values():
        with suppress(ConfigError):
            _load_pass(entry)
    return catalogue()


def _known(names: Iterable[str], others: dict[str, EntryPoint]) -> frozenset[str]:
    known = sorted({*_BACKENDS, *others})
    for name in names:
        if name not in known:
            raise BackendError(f"unknown back end '{name}'; {did_you_mean(name, known)}")
    return frozenset(names)


def _is_ours(entry: EntryPoint) -> bool:
    return entry.value.startswith("sysmlc.")


def _load(name: str, others: dict[str, EntryPoint]) -> Backend:
    _known([name], others)
    try:
        if name in _BACKENDS:
            return cast("Backend", import_module(_BACKENDS[name]).BACKEND)
        return cast("Backend", others[name].load())
    except Exception as problem:
        raise BackendError(f"back end '{name}' cannot be loaded: {problem!r}") from problem


def _modules(package: str) -> Iterator[str]:
    try:
        folder = import_module(package)
    except ModuleNotFoundError as problem:
        if problem.name != package:
            raise
        return
    yield package
    from pkgutil import walk_packages

    # What cannot be imported is given all the same: who imports it finds out.
    paths, ignore = getattr(folder, "__path__", ()), lambda _: None
    for found in walk_packages(paths, f"{package}.", onerror=ignore):
        if not found.name.endswith("__main__"):
            yield found.name
