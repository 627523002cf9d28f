"""The registry of front ends, passes, analyses, back ends and rules, imported when they are used.

Other distributions add passes and back ends by entry points. A pass of a plug-in runs after those
of sysmlc. The rules of a plug-in are those that its modules define when they are imported.
"""

import dataclasses
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from pkgutil import walk_packages
from traceback import extract_tb
from typing import Any, TypeVar, cast

from msgspec import Struct, structs

from sysmlc.analyses import analysis
from sysmlc.analyses.analysis import Analysis
from sysmlc.backends.base import Backend
from sysmlc.config import ConfigError
from sysmlc.diagnostics import Rule, catalogue
from sysmlc.frontends.base import Frontend, LibraryFrontend
from sysmlc.passes import pipeline
from sysmlc.passes.pipeline import Pass
from sysmlc.support.suggestions import did_you_mean

BACKEND_GROUP = "sysmlc.backends"
"""Entry point group of back ends; an entry names an object with the protocol ``Backend``."""
PASS_GROUP = "sysmlc.passes"
"""Entry point group of passes; an entry names an object with the protocol ``Pass``."""

_INTERFACES: Mapping[str, tuple[str, Mapping[str, type]]] = {
    "pass": ("run", {"name": str, "after": tuple}),
    "back end": ("emit", {"name": str, "summary": str, "is_default": bool}),
}
"""The method and the other members of plug-ins."""

_FRONTENDS = tuple(f"sysmlc.frontends.{name}" for name in ("xmi", "huds", "caex", "sysml", "ir"))
_BACKENDS = {
    "contracts": "sysmlc.backends.contracts:BACKEND",
    "recipe": "sysmlc.backends.recipe:BACKEND",
    "platform": "sysmlc.backends.platform:BACKEND",
    "plantuml": "sysmlc.backends.plantuml:BACKEND",
    "graph": "sysmlc.backends.graph:JSON",
    "ecore": "sysmlc.backends.ecore:BACKEND",
    "ir": "sysmlc.backends.graph:TEXT",
    "reqtable": "sysmlc.backends.reqtable:BACKEND",
    "monitor": "sysmlc.backends.monitor:BACKEND",
    "uml": "sysmlc.backends.uml:BACKEND",
    "sysml": "sysmlc.backends.sysml:BACKEND",
    "aml": "sysmlc.backends.aml:BACKEND",
    "sysmlx": "sysmlc.backends.sysmlx:BACKEND",
    "gr1c": "sysmlc.backends.contract_formats:GR1C",
    "slugs": "sysmlc.backends.contract_formats:SLUGS",
    "tlsf": "sysmlc.backends.contract_formats:TLSF",
    "smv": "sysmlc.backends.contract_formats:SMV",
    "chase": "sysmlc.backends.contract_formats:CHASE",
    "spot": "sysmlc.backends.contract_formats:SPOT",
    "promela": "sysmlc.backends.contract_formats:PROMELA",
}
"""Module and variable of each shipped back end, by name."""
_DEFAULT = frozenset({"contracts", "recipe", "platform", "plantuml"})
"""Shipped back ends with ``is_default``. The others are imported only if ``--emit`` names them."""
_RULE_PACKAGES = (
    "frontends",
    "language",
    "logic",
    "recipe",
    "overlay",
    "simulation",
    "synthesis",
    "robots",
    "analyses",
    "passes",
    "backends",
    "driver",
)


_Step = TypeVar("_Step", Pass, Analysis)


class BackendError(Exception):
    """A back end is unknown or cannot be loaded."""


class PlugInError(Exception):
    """A plug-in cannot be loaded, or is no pass or back end."""


class PlugInWarning(UserWarning):
    """A plug-in that no option names is ignored, because it cannot be used."""


def load_frontends(library: str = "") -> list[Frontend]:
    """Return the front ends in the order of detection.

    *library* is the path of the SysML v2 standard library; empty for the installed one.
    """
    frontends = [cast("Frontend", import_module(name).FRONTEND) for name in _FRONTENDS]
    if not library:
        return frontends
    return [f.with_library(library) if isinstance(f, LibraryFrontend) else f for f in frontends]


def load_passes(options: Mapping[str, Mapping[str, object]]) -> list[Pass]:
    """Return the passes in order; *options* maps the name of a pass or analysis to its options.

    A plug-in that cannot be used is ignored with a PlugInWarning. Raises ConfigError for a pass, an
    analysis or an option that does not exist.
    """
    plug_ins = find_plug_ins(PASS_GROUP)
    names = [*pipeline.NAMES, *analysis.CHECKED, *plug_ins]
    for name in options:
        if name not in names:
            advice = did_you_mean(name, names)
            raise ConfigError(f"passes.{name}: unknown pass; {advice}", ("passes", name))
    for name in analysis.CHECKED:
        if name in options:
            load_analysis(name, options)
    loaded = [pipeline.load(name) for name in pipeline.NAMES]
    loaded += [step for entry in plug_ins.values() if (step := _load_pass(entry)) is not None]
    configured = [_set_options(step, options.get(step.name, {})) for step in loaded]
    try:
        return pipeline.sort_passes(configured)
    except ValueError as problem:
        _ignore_plug_in(str(problem))
        return pipeline.sort_passes(step for step in configured if step.name in pipeline.NAMES)


def load_analysis(name: str, options: Mapping[str, Mapping[str, object]]) -> Analysis:
    """Return an analysis with its options. Raises ConfigError for a wrong option."""
    loaded = _set_options(analysis.load(name), options.get(name, {}))
    contracts = options.get("contracts", {})
    if name == "activities" and contracts:
        # Token graphs have the domains of their variables before contracts are derived.
        low, high = cast("Any", loaded).assumed_range
        assumed_range = contracts.get("assumed_low", low), contracts.get("assumed_high", high)
        loaded = structs.replace(cast("Any", loaded), assumed_range=assumed_range)
    return loaded


def _load_pass(entry: EntryPoint) -> Pass | None:
    """Return the pass of a plug-in, or None with a PlugInWarning if it cannot be used."""
    if entry.name in (*pipeline.NAMES, *analysis.NAMES):
        _ignore_plug_in(f"the plug-in {entry.value} takes the name of pass '{entry.name}'")
        return None
    try:
        return cast("Pass", _load_plug_in(entry, "pass"))
    except PlugInError as problem:
        _ignore_plug_in(str(problem))
        return None


def _load_plug_in(entry: EntryPoint, kind: str) -> object:
    """Return the pass or back end that an entry point names. Raises PlugInError."""
    distribution = f" of {entry.dist.name}" if entry.dist else ""
    source = f"{entry.value}{distribution}"
    try:
        plug_in = entry.load()
    # A module may call sys.exit() when it is imported.
    except (Exception, SystemExit) as problem:
        place = _find_fault(problem, entry.module)
        text = f"{kind} '{entry.name}' cannot be loaded: {type(problem).__name__}: {problem}"
        raise PlugInError(f"{text} ({source}{place})") from problem
    method, members = _INTERFACES[kind]
    if isinstance(plug_in, type):
        raise PlugInError(f"{kind} '{entry.name}' is a class: name an instance of it ({source})")
    for member, type_ in members.items():
        if not isinstance(getattr(plug_in, member, None), type_):
            needed = f"'{member}' of type {type_.__name__}"
            raise PlugInError(f"{kind} '{entry.name}' has no member {needed} ({source})")
    if not callable(getattr(plug_in, method, None)):
        raise PlugInError(f"{kind} '{entry.name}' has no method '{method}' ({source})")
    name = cast("Any", plug_in).name
    if name != entry.name:
        advice = f"the names of the {kind} and of its entry point must be equal"
        raise PlugInError(f"{kind} '{entry.name}' is called '{name}': {advice} ({source})")
    return cast("object", plug_in)


def _find_fault(problem: BaseException, module: str) -> str:
    """Return file and line of the last call in the package of a plug-in, after a comma."""
    package = module.partition(".")[0]
    places = [
        f", {frame.filename}:{frame.lineno}"
        for frame in extract_tb(problem.__traceback__)
        if package in Path(frame.filename).with_suffix("").parts
    ]
    return places[-1] if places else ""


def _ignore_plug_in(reason: str) -> None:
    warnings.warn(f"{reason}; the plug-in is ignored", PlugInWarning, stacklevel=3)


def _set_options(step: _Step, options: Mapping[str, object]) -> _Step:
    """Return the pass or analysis with these options. Raises ConfigError."""
    if not options:
        return step
    names = _list_option_names(step)
    for name, value in options.items():
        path = ("passes", step.name, name)
        where = ".".join(path)
        if name not in names:
            raise ConfigError(f"{where}: unknown option; {did_you_mean(name, names)}", path)
        default = getattr(step, name)
        if not _has_type_of(value, default):
            raise ConfigError(f"{where}: {value!r} is no {type(default).__name__}", path)
    replace = structs.replace if isinstance(step, Struct) else dataclasses.replace
    try:
        return cast("_Step", replace(cast("Any", step), **options))
    except ValueError as error:
        raise ConfigError(f"passes.{step.name}: {error}", ("passes", step.name)) from error


def _list_option_names(step: Pass | Analysis) -> list[str]:
    """Return the options of a step, which is a struct or, in a plug-in, maybe a dataclass."""
    if isinstance(step, Struct):
        return list(step.__struct_fields__)
    if not dataclasses.is_dataclass(step):
        return []
    return [field.name for field in dataclasses.fields(step)]


def _has_type_of(value: object, default: object) -> bool:
    """Whether an option has the type of its default; an integer is a valid float."""
    if isinstance(value, bool) or isinstance(default, bool):
        return isinstance(value, bool) and isinstance(default, bool)
    return isinstance(value, type(default)) or (
        isinstance(default, float) and isinstance(value, int)
    )


def list_backend_names() -> list[str]:
    """Return the names of all back ends, including plug-ins, without loading them."""
    return sorted({*_BACKENDS, *_find_foreign_backends()})


def load_backends(names: Iterable[str]) -> list[Backend]:
    """Load the back ends with these names, each once. Raises BackendError."""
    return _load_each(names, _find_foreign_backends())


def load_all_backends() -> list[Backend]:
    """Load all back ends; plug-ins that cannot be used are ignored with a PlugInWarning."""
    foreign = _find_foreign_backends()
    return _load_usable(sorted({*_BACKENDS, *foreign}), foreign)


def _load_each(names: Iterable[str], foreign: dict[str, EntryPoint]) -> list[Backend]:
    return [_load(name, foreign) for name in dict.fromkeys(names)]


def _load_usable(names: Iterable[str], foreign: dict[str, EntryPoint]) -> list[Backend]:
    """Load back ends that no option names; one that cannot be loaded is ignored."""
    backends = []
    for name in names:
        try:
            backends.append(_load(name, foreign))
        except BackendError as problem:
            _ignore_plug_in(str(problem))
    return backends


def _find_foreign_backends() -> dict[str, EntryPoint]:
    """Return the back ends of other distributions by name, without those that take our names."""
    plug_ins = find_plug_ins(BACKEND_GROUP)
    for name in sorted(plug_ins.keys() & _BACKENDS.keys()):
        entry = plug_ins.pop(name)
        _ignore_plug_in(f"the plug-in {entry.value} takes the name of back end '{name}'")
    return plug_ins


def find_plug_ins(group: str) -> dict[str, EntryPoint]:
    """Return the entry points of other distributions by name, sorted by name; load none."""
    entries = [entry for entry in entry_points(group=group) if not _is_ours(entry)]
    return {entry.name: entry for entry in sorted(entries, key=lambda entry: entry.name)}


def select_backends(wanted: Sequence[str]) -> list[Backend]:
    """Load the back ends for ``--emit``: names replace the default set, ``+name`` adds to it.

    Raises BackendError, whose message suggests names.
    """
    plain = [name for name in wanted if not name.startswith("+")]
    added = [name[1:] for name in wanted if name.startswith("+")]
    foreign = _find_foreign_backends()
    if plain:
        return _load_each([*plain, *added], foreign)
    selected = _check_names(added, foreign)
    skipped = _BACKENDS.keys() - _DEFAULT - selected
    by_default = sorted({*_BACKENDS, *foreign} - skipped - selected)
    defaults = [b for b in _load_usable(by_default, foreign) if b.is_default]
    backends = [*defaults, *_load_each(selected, foreign)]
    return sorted(backends, key=lambda backend: backend.name)


def list_needs(backends: Iterable[Backend]) -> tuple[str, ...]:
    """Return the analyses that back ends need; those of ``check`` for a plug-in that names none.

    Raises BackendError for an unknown analysis.
    """
    names: dict[str, None] = {}
    for backend in backends:
        for name in getattr(backend, "needs", analysis.CHECKED):
            if name not in analysis.NAMES:
                advice = did_you_mean(name, analysis.NAMES)
                text = f"back end '{backend.name}' needs the unknown analysis '{name}'; {advice}"
                raise BackendError(text)
            names[name] = None
    return tuple(names)


def load_full_catalogue(note: Callable[[str], None] = lambda _: None) -> dict[str, Rule]:
    """Import every module that may define rules, and the plug-ins; return all rules by code.

    *note* is called with a message for each module that cannot be imported.
    """
    for package in _RULE_PACKAGES:
        for module in _iter_modules(f"sysmlc.{package}"):
            try:
                import_module(module)
            except Exception as problem:
                note(f"the rules of {module} are missing: {problem!r}")
    foreign = _find_foreign_backends()
    _load_usable(foreign, foreign)
    for entry in find_plug_ins(PASS_GROUP).values():
        _load_pass(entry)
    return catalogue()


def _check_names(names: Iterable[str], foreign: dict[str, EntryPoint]) -> frozenset[str]:
    """Return the names as a set. Raises BackendError for an unknown one."""
    all_names = sorted({*_BACKENDS, *foreign})
    for name in names:
        if name not in all_names:
            raise BackendError(f"unknown back end '{name}'; {did_you_mean(name, all_names)}")
    return frozenset(names)


def _is_ours(entry: EntryPoint) -> bool:
    return entry.value.startswith("sysmlc.")


def _load(name: str, foreign: dict[str, EntryPoint]) -> Backend:
    _check_names([name], foreign)
    try:
        if name in _BACKENDS:
            module, _, variable = _BACKENDS[name].partition(":")
            return cast("Backend", getattr(import_module(module), variable))
        backend = cast("Backend", _load_plug_in(foreign[name], "back end"))
    except PlugInError as problem:
        raise BackendError(str(problem)) from problem
    except Exception as problem:
        raise BackendError(f"back end '{name}' cannot be loaded: {problem!r}") from problem
    list_needs([backend])
    return backend


def _iter_modules(package: str) -> Iterator[str]:
    """Yield the modules of a package; those that cannot be imported included."""
    try:
        folder = import_module(package)
    except ModuleNotFoundError as problem:
        if problem.name != package:
            raise
        return
    yield package

    paths, ignore = getattr(folder, "__path__", ()), lambda _: None
    for module in walk_packages(paths, f"{package}.", onerror=ignore):
        if not module.name.endswith("__main__"):
            yield module.name
