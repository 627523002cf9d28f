"""The registry of front ends, passes, analyses, back ends and rules, imported when they are used.

Other distributions add front ends, passes and back ends by entry points. A pass of a plug-in runs
after those of sysmlc. The rules of a plug-in are those that its modules define when they are
imported.

A plug-in or a back end that cannot be used, and that no option names, is ignored. Functions that
load them call their parameter *note* with the reason; by default it issues a PlugInWarning.
"""

import dataclasses
import warnings
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
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
from sysmlc.support.interpreter import describe_error
from sysmlc.support.suggestions import did_you_mean, find_similar

FRONTEND_GROUP = "sysmlc.frontends"
"""Entry point group of front ends; an entry names an object with the protocol ``Frontend``."""
BACKEND_GROUP = "sysmlc.backends"
"""Entry point group of back ends; an entry names an object with the protocol ``Backend``."""
PASS_GROUP = "sysmlc.passes"
"""Entry point group of passes; an entry names an object with the protocol ``Pass``."""

_KINDS = {FRONTEND_GROUP: "front end", PASS_GROUP: "pass", BACKEND_GROUP: "back end"}
"""What the plug-ins of each group are, as messages say."""
_INTERFACES: Mapping[str, tuple[Sequence[str], Mapping[str, type]]] = {
    "front end": (("detect", "links", "read"), {"name": str}),
    "pass": (("run",), {"name": str, "after": tuple}),
    "back end": (("emit",), {"name": str, "summary": str, "is_default": bool}),
}
"""The methods and the other members of plug-ins."""
_OPTIONAL: Mapping[str, Mapping[str, type]] = {
    "front end": {"suffixes": tuple},
    "back end": {"needs": tuple, "is_last": bool},
}
"""Members that plug-ins may lack. The items of a tuple are texts."""

_FRONTENDS = ("xmi", "huds", "caex", "sysml", "ir")
"""Names of the shipped front ends, which are those of their packages."""
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
    """A plug-in cannot be loaded, or is no front end, pass or back end."""


class PlugInWarning(UserWarning):
    """A plug-in that no option names is ignored, because it cannot be used."""


Note = Callable[[str], None]
_IGNORED = "the plug-in is ignored"


def warn(reason: str) -> None:
    """Issue a PlugInWarning; the default of the functions that take a note."""
    warnings.warn(reason, PlugInWarning, stacklevel=4)


def load_frontends(library: str = "", note: Note = warn) -> list[Frontend]:
    """Return the front ends in the order of detection: that of a plug-in wins a tie with ours.

    *library* is the path of the SysML v2 standard library; empty for the installed one.
    """
    frontends = [
        cast("Frontend", import_module(f"sysmlc.frontends.{name}").FRONTEND) for name in _FRONTENDS
    ]
    if library:
        frontends = [
            f.with_library(library) if isinstance(f, LibraryFrontend) else f for f in frontends
        ]
    return [*load_foreign_frontends(note), *frontends]


def load_foreign_frontends(note: Note = warn) -> list[Frontend]:
    """Return the front ends of plug-ins."""
    foreign = _find_foreign(FRONTEND_GROUP, _FRONTENDS, note)
    return list(_load_usable(foreign, "front end", note))


def load_passes(options: Mapping[str, Mapping[str, object]], note: Note = warn) -> list[Pass]:
    """Return the passes in order; *options* maps the name of a pass or analysis to its options.

    Raises ConfigError for a pass, an analysis or an option that does not exist.
    """
    foreign = _find_foreign(PASS_GROUP, [*pipeline.NAMES, *analysis.NAMES], note)
    names = [*pipeline.NAMES, *analysis.CHECKED, *foreign]
    for name in options:
        if name not in names:
            advice = did_you_mean(name, names)
            raise ConfigError(f"passes.{name}: unknown pass; {advice}", ("passes", name))
    for name in analysis.CHECKED:
        if name in options:
            load_analysis(name, options)
    loaded = [pipeline.load(name) for name in pipeline.NAMES]
    loaded += _load_usable(foreign, "pass", note)
    configured = [_set_options(step, options.get(step.name, {})) for step in loaded]
    try:
        return pipeline.sort_passes(configured)
    except ValueError as problem:
        note(f"{problem}; {_IGNORED}")
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


def find_plug_ins(group: str) -> dict[str, EntryPoint]:
    """Return the entry points of other distributions by name, sorted by name; load none."""
    entries = [e for e in entry_points(group=group) if not e.value.startswith("sysmlc.")]
    return {entry.name: entry for entry in sorted(entries, key=lambda entry: entry.name)}


def _find_foreign(group: str, names: Collection[str], note: Note) -> dict[str, EntryPoint]:
    """Return the plug-ins of a group by name, without those that take one of our *names*."""
    plug_ins = find_plug_ins(group)
    for name in [name for name in plug_ins if name in names]:
        entry, kind = plug_ins.pop(name), _KINDS[group]
        note(f"the plug-in {entry.value} takes the name of {kind} '{name}'; {_IGNORED}")
    return plug_ins


def _load_usable(entries: Mapping[str, EntryPoint], kind: str, note: Note) -> Iterator[Any]:
    """Yield the plug-ins that can be loaded."""
    for entry in entries.values():
        try:
            plug_in = cast("Any", _load_plug_in(entry, kind))
            list_needs([plug_in] if kind == "back end" else [])
        except (PlugInError, BackendError) as problem:
            note(f"{problem}; {_IGNORED}")
        else:
            yield plug_in


def _load_plug_in(entry: EntryPoint, kind: str) -> object:
    """Return the object of a *kind* that an entry point names. Raises PlugInError."""
    distribution = f" of {entry.dist.name}" if entry.dist else ""
    source = f"{entry.value}{distribution}"
    try:
        plug_in = entry.load()
        fault = _find_interface_fault(plug_in, kind)
    # A module may call sys.exit() when it is imported, and members may be computed.
    except (Exception, SystemExit) as problem:
        place = _find_fault(problem, entry.module)
        text = f"{kind} '{entry.name}' cannot be loaded: {describe_error(problem)}"
        raise PlugInError(f"{text} ({source}{place})") from problem
    if fault:
        raise PlugInError(f"{kind} '{entry.name}' {fault} ({source})")
    name = cast("Any", plug_in).name
    if name != entry.name:
        advice = f"the names of the {kind} and of its entry point must be equal"
        raise PlugInError(f"{kind} '{entry.name}' is called '{name}': {advice} ({source})")
    return cast("object", plug_in)


def check_interfaces(steps: Iterable[object], kind: str) -> None:
    """Raise TypeError for an object that is none of a *kind*, such as "back end"."""
    for step in steps:
        fault = _find_interface_fault(step, kind)
        if fault:
            raise TypeError(f"expected a {kind}, but {step!r} {fault}")


def _find_interface_fault(step: object, kind: str) -> str:
    methods, members = _INTERFACES[kind]
    optional = _OPTIONAL.get(kind, {})
    members = {**members, **{name: optional[name] for name in optional if hasattr(step, name)}}
    if isinstance(step, type):
        return "is a class: name an instance of it"
    for member, type_ in members.items():
        value = getattr(step, member, None)
        if not isinstance(value, type_):
            return f"has no member '{member}' of type {type_.__name__}"
        if isinstance(value, tuple) and not all(isinstance(item, str) for item in value):
            return f"has a member '{member}' with other items than texts"
    missing = [method for method in methods if not callable(getattr(step, method, None))]
    return f"has no method '{missing[0]}'" if missing else ""


def describe_source(step: object, problem: Exception) -> str:
    """Return the module and distribution of a step of a plug-in, and where a *problem* arose.

    The result is empty for a step of sysmlc.
    """
    module = type(step).__module__
    package = module.partition(".")[0]
    if package in ("sysmlc", "builtins"):
        return ""
    entries = (entry for group in _KINDS for entry in find_plug_ins(group).values())
    owners = (e.dist.name for e in entries if e.dist and e.module.partition(".")[0] == package)
    distribution = next((f" of {name}" for name in owners), "")
    return f"{module}{distribution}{_find_fault(problem, module)}"


def _find_fault(problem: BaseException, module: str) -> str:
    """Return file and line of the last call in the package of a plug-in, after a comma."""
    package = module.partition(".")[0]
    places = [
        f", {frame.filename}:{frame.lineno}"
        for frame in extract_tb(problem.__traceback__)
        if package in Path(frame.filename).with_suffix("").parts
    ]
    return places[-1] if places else ""


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
    return sorted({*_BACKENDS, *_find_foreign(BACKEND_GROUP, _BACKENDS, warn)})


def load_backends(names: Iterable[str]) -> list[Backend]:
    """Load the back ends with these names, each once. Raises BackendError."""
    foreign = _find_foreign(BACKEND_GROUP, _BACKENDS, warn)
    return [_load(name, foreign) for name in dict.fromkeys(names)]


def load_all_backends() -> list[Backend]:
    """Load all back ends, sorted by name, without those that cannot be used."""
    foreign = _find_foreign(BACKEND_GROUP, _BACKENDS, warn)
    backends = [*_load_shipped(_BACKENDS, warn), *_load_usable(foreign, "back end", warn)]
    return sorted(backends, key=lambda backend: backend.name)


def select_backends(wanted: Sequence[str], note: Note = warn) -> list[Backend]:
    """Load the back ends for ``--emit``: names replace the default set, ``+name`` adds to it.

    One of the default set that cannot be loaded is left out. Raises BackendError for a name that is
    unknown, with a suggestion, or cannot be loaded.
    """
    plain = [name for name in wanted if not name.startswith("+")]
    added = [name[1:] for name in wanted if name.startswith("+")]
    foreign = _find_foreign(BACKEND_GROUP, _BACKENDS, note)
    if plain:
        return [_load(name, foreign) for name in dict.fromkeys([*plain, *added])]
    # Only the object says whether a plug-in runs by default.
    unnamed = {name: entry for name, entry in foreign.items() if name not in added}
    plug_ins = _load_usable(unnamed, "back end", note)
    backends = [_load(name, foreign) for name in dict.fromkeys(added)]
    backends += _load_shipped(sorted(_DEFAULT.difference(added)), note)
    backends += [backend for backend in plug_ins if backend.is_default]
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
                note(f"the rules of {module} are missing: {describe_error(problem)}")
    for group, kind in _KINDS.items():
        taken = _BACKENDS if group == BACKEND_GROUP else (*pipeline.NAMES, *analysis.NAMES)
        list(_load_usable(_find_foreign(group, taken, warn), kind, warn))
    return catalogue()


def check_rule_names(names: Iterable[str]) -> None:
    """Raise ConfigError for a name that is neither the name nor the code of a rule."""
    # The full catalogue imports every module that defines rules.
    for rules in (catalogue, load_full_catalogue) if (names := set(names)) else ():
        names -= {name for rule in rules().values() for name in (rule.code, rule.name)}
    for name in sorted(names):
        raise ConfigError(describe_unknown_rule(name, catalogue().values()))


def describe_unknown_rule(name: str, rules: Iterable[Rule]) -> str:
    """Return the message about a name that no rule has."""
    similar = find_similar(name, [rule.name for rule in rules])
    advice = f"did you mean '{similar}'?" if similar else "'sysmlc explain' lists the rules"
    return f"unknown rule '{name}'; {advice}"


def _load_shipped(names: Iterable[str], note: Note) -> Iterator[Backend]:
    """Yield the shipped back ends with these names that can be loaded."""
    for name in names:
        try:
            yield _load(name, {})
        except BackendError as problem:
            note(f"{problem}; its outputs are missing")


def _load(name: str, foreign: Mapping[str, EntryPoint]) -> Backend:
    """Return the back end with this name. Raises BackendError."""
    names = {*_BACKENDS, *foreign}
    if name not in names:
        raise BackendError(f"unknown back end '{name}'; {did_you_mean(name, names)}")
    try:
        if name in _BACKENDS:
            module, _, variable = _BACKENDS[name].partition(":")
            return cast("Backend", getattr(import_module(module), variable))
        backend = cast("Backend", _load_plug_in(foreign[name], "back end"))
    except PlugInError as problem:
        raise BackendError(str(problem)) from problem
    except Exception as problem:
        reason = f"back end '{name}' cannot be loaded: {describe_error(problem)}"
        raise BackendError(reason) from problem
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
