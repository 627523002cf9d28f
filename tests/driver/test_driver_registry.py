"""Which passes and back ends run, the options of passes, and plug-ins of other distributions."""

import json
import sys
import tomllib
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

import pytest
import watchfiles
from click.testing import CliRunner
from msgspec import Struct

import sysmlc
from sysmlc import Request, config
from sysmlc.cli import watch
from sysmlc.cli.group import sysmlc as sysmlc_command
from sysmlc.config import ConfigError, read_config
from sysmlc.driver import (
    BackendError,
    PlugInWarning,
    compile_model,
    list_backend_names,
    load_backends,
    registry,
    select_backends,
)
from sysmlc.logic.contract import Contract, IntegerDomain
from sysmlc.passes import pipeline

_PROJECT = Path(__file__).parents[2] / "pyproject.toml"
_RECIPE = _PROJECT.parent / "examples" / "lego-recipe" / "lego-recipe.uml"
_GATE = _PROJECT.parent / "examples" / "baygate-behaviour" / "baygate-behaviour.uml"


def test_the_default_back_ends_run_if_none_is_named():
    backends = load_backends(list_backend_names())
    assert select_backends([]) == [backend for backend in backends if backend.is_default]


def test_an_added_back_end_keeps_the_order_of_names():
    names = [backend.name for backend in select_backends(["+graph"])]
    assert names == sorted(["graph", *(backend.name for backend in select_backends([]))])


def test_the_entry_points_of_the_project_are_the_back_ends_of_the_registry():
    project = tomllib.loads(_PROJECT.read_text(encoding="utf-8"))["project"]
    entry_points = project["entry-points"][registry.BACKEND_GROUP]
    assert entry_points == registry._BACKENDS


# -- options of passes ----------------------------------------------------------------------------


def load_passes_by_name(folder, text):
    """Return the passes with the options of a configuration, by name."""
    (folder / "sysmlc.toml").write_text(text)
    options = config.read_config(folder / "sysmlc.toml").passes
    return {loaded.name: loaded for loaded in registry.load_passes(options)}


def load_analysis(folder, text, name):
    (folder / "sysmlc.toml").write_text(text)
    return registry.load_analysis(name, read_config(folder / "sysmlc.toml").passes)


def test_options_are_fields_of_the_analysis(tmp_path):
    text = "[passes.activities]\nmax_markings = 7\n"
    assert load_analysis(tmp_path, text, "activities").max_markings == 7


class StructPass(Struct, frozen=True):
    name: str = "counting"
    after: tuple[str, ...] = ()
    limit: int = 1

    def run(self, graph, sink):
        """Change nothing."""


@dataclass(frozen=True)
class DataclassPass:
    name: str = "counting"
    after: tuple[str, ...] = ()
    limit: int = 1

    def run(self, graph, sink):
        """Change nothing."""


@pytest.mark.parametrize("original", [StructPass(), DataclassPass()])
def test_passes_are_structs_or_dataclasses(monkeypatch, original):
    monkeypatch.setattr(pipeline, "NAMES", ("counting",))
    monkeypatch.setattr(pipeline, "load", lambda name: original)
    (loaded,) = registry.load_passes({"counting": {"limit": 7}})
    assert (type(loaded), loaded.limit, original.limit) == (type(original), 7, 1)
    with pytest.raises(ConfigError, match="did you mean 'limit'"):
        registry.load_passes({"counting": {"limits": 7}})


def test_an_integer_is_accepted_as_a_number(tmp_path):
    assert load_analysis(tmp_path, "[passes.recipe]\ntolerance = 1\n", "recipe").tolerance == 1


MODEL_WITHOUT_RANGES = """
package Plant {
    private import ScalarValues::*;
    part def Gate {
        attribute level : Integer default = 0;
        perform action act {
            attribute count : Integer default = 0;
            constraint limit { language "LTL" /* G (count * count <= 16) */ }
            first start;
            then decide;
                if level * level > 9 then a;
                else b;
            action a;
            action b;
        }
    }
}
"""


def test_the_assumed_range_of_contracts_applies_to_activities(tmp_path):
    (tmp_path / "sysmlc.toml").write_text("[passes.contracts]\nassumed_high = 7\n")
    (tmp_path / "gate.sysml").write_text(MODEL_WITHOUT_RANGES)
    compilation = sysmlc.compile_model(tmp_path / "gate.sysml")
    (contract,) = compilation.graph.derived(Contract)
    domains = {variable.name: variable.domain for variable in contract.variables}
    assert domains["level"] == domains["count"] == IntegerDomain(0, 7)


def test_recipe_levels_are_an_option_of_the_analysis_recipe(tmp_path):
    recipe = load_analysis(tmp_path, '[recipe.levels]\n"Plant::Assemble" = "task"\n', "recipe")
    assert recipe.levels == {"Plant::Assemble": "task"}


def test_token_graphs_use_the_assumed_range_of_contracts(tmp_path):
    text = "[passes.contracts]\nassumed_high = 7\n"
    assert load_analysis(tmp_path, text, "activities").assumed_range == (0, 7)


@pytest.mark.parametrize("emit", [["recipe"], ["contracts"], ["platform"], ["plantuml"], ["ir"]])
def test_a_back_end_names_all_analyses_that_it_reads(emit):
    backends = tuple(registry.select_backends(emit))
    request = Request((_RECIPE,), backends=backends)
    compilation = compile_model(request, analyses=registry.list_needs(backends))
    assert compilation.artefacts == compile_model(request).artefacts


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[passes.activity]\nx = 1\n", "passes.activity: .* did you mean 'activities'?"),
        ("[passes.activities]\nmax_marking = 1\n", "did you mean 'max_markings'?"),
        ("[passes.activities]\nmax_markings = true\n", "True is no int"),
        ('[passes.activities]\nmax_markings = "7"\n', "'7' is no int"),
        ('[recipe.levels]\nA = "taks"\n', "unknown value 'taks'; did you mean 'task'"),
    ],
)
def test_a_wrong_option_is_refused_with_a_suggestion(tmp_path, text, sentence):
    with pytest.raises(ConfigError, match=sentence):
        load_passes_by_name(tmp_path, text)


def test_passes_run_in_the_order_that_they_declare():
    order = [loaded.name for loaded in registry.load_passes({})]
    assert order[:5] == ["resolve", "kept", "overlay", "inherit", "classify"]
    assert order.index("guards") < order.index("views")


# -- plug-ins -------------------------------------------------------------------------------------


PASS_MODULE = """\
from typing import ClassVar

from msgspec import Struct


class Census(Struct, frozen=True):
    name: ClassVar[str] = "census"
    after: ClassVar[tuple[str, ...]] = ("views",)
    limit: int = 10

    def run(self, graph, sink):
        pass


PASS = Census()
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder from which Python imports modules."""
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path


def install_distribution(folder: Path, name: str, group: str, *entries: str) -> None:
    info = folder / f"{name}-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("\n".join([f"[{group}]", *entries, ""]))


def test_back_ends_of_other_distributions_are_found_and_not_loaded(folder):
    install_distribution(folder, "shouting", "sysmlc.backends", "shout = shouting:BACKEND")
    assert list(registry.find_plug_ins(registry.BACKEND_GROUP)) == ["shout"]
    assert "shout" in list_backend_names()


def test_back_ends_of_sysmlc_are_no_plug_ins(folder):
    install_distribution(folder, "sysmlc", "sysmlc.backends", "uml = sysmlc.backends.uml:BACKEND")
    assert registry.find_plug_ins(registry.BACKEND_GROUP) == {}


def test_a_plug_in_cannot_take_the_name_of_a_back_end(folder):
    install_distribution(folder, "shouting", "sysmlc.backends", "uml = shouting:BACKEND")
    with pytest.warns(PlugInWarning, match="shouting:BACKEND takes the name of back end 'uml'"):
        names = list_backend_names()
    assert names.count("uml") == 1


def test_a_back_end_that_cannot_be_loaded_is_an_error_only_if_it_is_named(folder):
    install_distribution(folder, "shouting", "sysmlc.backends", "shout = no_such_module:BACKEND")
    with pytest.warns(PlugInWarning, match="back end 'shout' cannot be loaded"):
        backends = select_backends(["+ir"])
    names = ["contracts", "ir", "plantuml", "platform", "recipe"]
    assert [backend.name for backend in backends] == names
    with pytest.raises(BackendError, match="back end 'shout' cannot be loaded"):
        select_backends(["shout"])


def test_a_shipped_back_end_that_cannot_be_loaded_is_an_error_only_if_it_is_named(monkeypatch):
    monkeypatch.setitem(registry._BACKENDS, "recipe", "no_such_module:BACKEND")
    reason = "back end 'recipe' cannot be loaded: ModuleNotFoundError: No module named "
    with pytest.warns(PlugInWarning, match=f"^{reason}'no_such_module'; its outputs are missing$"):
        backends = select_backends(["+ir"])
    assert [backend.name for backend in backends] == ["contracts", "ir", "plantuml", "platform"]
    for names in (["recipe"], ["+recipe"]):
        with pytest.raises(BackendError, match=reason):
            select_backends(names)
    with pytest.warns(PlugInWarning, match=reason):
        result = CliRunner().invoke(sysmlc_command, ["backends"])
    assert (result.exit_code, " recipe " in result.stdout) == (0, False)
    assert "* platform " in result.stdout


def test_a_build_keeps_the_earlier_files_of_a_back_end_that_cannot_be_loaded(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("gate.sysml").write_text("package Plant { part def Gate { port inlet; } }")
    build = ["gate.sysml", "-o", "out", "--no-cache"]
    CliRunner().invoke(sysmlc_command, build)
    diagrams = sorted(Path("out").rglob("*.puml"))
    monkeypatch.setitem(registry._BACKENDS, "plantuml", "no_such_module:BACKEND")
    result = CliRunner().invoke(sysmlc_command, build)
    assert "SM914" in result.output
    assert sorted(Path("out").rglob("*.puml")) == diagrams != []


def test_a_package_that_an_analysis_needs_is_named_if_it_is_missing(monkeypatch):
    """SM917: the verdicts on contracts need the package 'dd'."""
    monkeypatch.setitem(sys.modules, "dd", None)
    monkeypatch.setitem(sys.modules, "dd.cudd", None)
    monkeypatch.setitem(sys.modules, "dd.autoref", None)
    compilation = compile_model(Request((_GATE,)), analyses=["verdicts"])
    (diagnostic,) = (d for d in compilation.diagnostics if d.rule.code == "SM917")
    assert diagnostic.message.startswith("analysis verdicts cannot load the package 'dd': ")
    assert compilation.exit_code() == 2


def test_a_pass_of_another_distribution_runs_after_its_predecessors(folder):
    (folder / "counting_elements.py").write_text(PASS_MODULE)
    install_distribution(folder, "counting", "sysmlc.passes", "census = counting_elements:PASS")
    census = registry.load_passes({"census": {"limit": 3}})[-1]
    assert (census.name, census.limit) == ("census", 3)


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("inherit = counting:PASS", "counting:PASS takes the name of pass 'inherit'"),
        ("census = no_such_module:PASS", "pass 'census' cannot be loaded: ModuleNotFoundError"),
    ],
)
def test_a_pass_that_cannot_be_used_is_ignored_with_a_warning(folder, entry, message):
    install_distribution(folder, "counting", "sysmlc.passes", entry)
    with pytest.warns(PlugInWarning, match=message):
        passes = registry.load_passes({})
    assert {step.name for step in passes} == set(pipeline.NAMES)


SPACE = "from types import SimpleNamespace as S\nTHING = S(after=(), summary='', is_default=True"
METHODS = "detect=print, links=print, read=print, run=print, emit=print"
PLUG_IN_FAULTS = {
    "import lost": "cannot be loaded: ModuleNotFoundError: No module named 'lost' (SOURCE, 1)",
    "LIMIT = 3\nraise ValueError('boom')": "cannot be loaded: ValueError: boom (SOURCE, 2)",
    "import sys\nsys.exit(3)": "cannot be loaded: SystemExit: 3 (SOURCE, 2)",
    "THING = 3": "has no member 'name' of type str (SOURCE)",
    "class THING: name = 'thing'": "is a class: name an instance of it (SOURCE)",
    f"{SPACE}, name='thing')": "has no method 'METHOD' (SOURCE)",
    "class Thing:\n name = property(lambda self: 1 / 0)\nTHING = Thing()": "cannot be loaded: "
    "ZeroDivisionError: division by zero (SOURCE, 2)",
    f"{SPACE}, name='x', {METHODS})": "is called 'x': "
    "the names of the KIND and of its entry point must be equal (SOURCE)",
}
"""What the module of a plug-in contains, and the warning; a number is a line of the module."""


@pytest.mark.parametrize("content", PLUG_IN_FAULTS)
@pytest.mark.parametrize(
    ("kind", "method"), [("front end", "detect"), ("pass", "run"), ("back end", "emit")]
)
def test_a_plug_in_that_cannot_be_used_is_a_warning_with_its_place(folder, content, kind, method):
    sys.modules.pop("acme_plug", None)
    (folder / "acme_plug.py").write_text(content + "\n")
    group, load = {
        "front end": ("sysmlc.frontends", registry.load_frontends),
        "pass": ("sysmlc.passes", lambda: registry.load_passes({})),
        "back end": ("sysmlc.backends", lambda: select_backends([])),
    }[kind]
    install_distribution(folder, "acme", group, "thing = acme_plug:THING")
    with pytest.warns(PlugInWarning) as warnings:
        plug_ins = load()
    assert "thing" not in {plug_in.name for plug_in in plug_ins}
    fault = PLUG_IN_FAULTS[content].replace("KIND", kind).replace("METHOD", method)
    fault = fault.replace("SOURCE, ", f"SOURCE, {folder / 'acme_plug.py'}:")
    fault = fault.replace("SOURCE", "acme_plug:THING of acme")
    messages = [str(warning.message) for warning in warnings]
    assert messages == [f"{kind} 'thing' {fault}; the plug-in is ignored"]


@pytest.mark.parametrize(
    ("member", "load", "fault"),
    [
        ("after=(1,)", registry.load_passes, "has a member 'after' with other items than texts"),
        ("suffixes=None", registry.load_frontends, "has no member 'suffixes' of type tuple"),
        ("is_last='no'", select_backends, "has no member 'is_last' of type bool"),
        ("needs='recipe'", select_backends, "has no member 'needs' of type tuple"),
        ("needs=('recip',)", select_backends, "needs the unknown analysis 'recip'; did you mean"),
    ],
)
def test_a_plug_in_with_a_wrong_member_is_ignored(folder, member, load, fault):
    sys.modules.pop("acme_plug", None)
    members = f"name='thing', summary='', is_default=True, {METHODS}"
    other = "" if member.startswith("after") else ", after=()"
    (folder / "acme_plug.py").write_text(f"{SPACE.partition('(')[0]}({members}{other}, {member})")
    for kind in ("frontends", "passes", "backends"):
        install_distribution(folder, kind, f"sysmlc.{kind}", "thing = acme_plug:THING")
    with pytest.warns(PlugInWarning, match=fault):
        plug_ins = load({} if load is registry.load_passes else ())
    assert "thing" not in {plug_in.name for plug_in in plug_ins}


TABLE_MODULE = """\
from sysmlc import Element, Kind


class TableFrontend:
    name = "table"
    suffixes = (".table",)

    def detect(self, source):
        return float(source.name.endswith(".table"))

    def links(self, source):
        return ()

    def read(self, sources, graph, sink, coverage):
        for source in sources:
            for name in source.data.decode().split():
                graph.add(Element(name, Kind.CLASS, name, source=source.name))


class Broken:
    name, summary, is_default, needs = "broken", "", True, ()

    def emit(self, graph, output, sink, options):
        raise ValueError("boom")


FRONTEND, BACKEND = TableFrontend(), Broken()
"""


def test_a_front_end_of_another_distribution_reads_its_files_in_folders(folder):
    sys.modules.pop("acme_table", None)
    (folder / "acme_table.py").write_text(TABLE_MODULE)
    install_distribution(folder, "acme", "sysmlc.frontends", "table = acme_table:FRONTEND")
    (folder / "models").mkdir()
    (folder / "models/plant.table").write_text("Gate Lamp\n")
    compilation = sysmlc.compile_model(folder / "models")
    assert [diagnostic.message for diagnostic in compilation.diagnostics] == []
    assert [element.name for element in compilation.graph] == ["Gate", "Lamp"]
    assert [file.language for file in compilation.inputs] == ["table"]


def test_the_commands_know_the_suffixes_of_front_ends_of_other_distributions(folder, monkeypatch):
    sys.modules.pop("acme_table", None)
    (folder / "acme_table.py").write_text(TABLE_MODULE)
    install_distribution(folder, "acme", "sysmlc.frontends", "table = acme_table:FRONTEND")
    path = folder / "plant.table"
    path.write_text("Gate Lamp\n")
    result = CliRunner().invoke(sysmlc_command, ["contracts", "check", str(path)])
    assert "has no behaviour and no requirement that gives a contract" in result.stderr

    def save_files(*folders, watch_filter, **_):
        paths = ("/models/plant.table", "/models/plant.html")
        yield {(1, saved) for saved in paths if watch_filter(1, saved)}

    monkeypatch.setattr(watchfiles, "watch", save_files)
    assert list(watch._iter_saves([folder])) == [[Path("/models/plant.table")]]


def test_a_project_with_models_for_a_plug_in_is_whole_only_with_them(folder):
    """Findings about the configuration hold only if all models of the project are read."""
    sys.modules.pop("acme_table", None)
    (folder / "acme_table.py").write_text(TABLE_MODULE)
    install_distribution(folder, "acme", "sysmlc.frontends", "table = acme_table:FRONTEND")
    project = folder / "project"
    project.mkdir()
    (project / "sysmlc.toml").write_text(
        '[[suppress]]\nrule = "untyped-port"\nelement = "*"\nreason = "later"\n'
    )
    (project / "plant.table").write_text("Gate Lamp\n")
    (project / "plant.ir").write_text('Class gate "Gate"\n')
    results = [
        CliRunner().invoke(sysmlc_command, ["check", str(path), "--format", "concise"])
        for path in (project / "plant.ir", project)
    ]
    assert ["untyped-port" in result.stderr for result in results] == [False, True]


def test_faults_of_plug_ins_are_findings_and_the_other_outputs_are_written(folder):
    sys.modules.pop("acme_table", None)
    (folder / "acme_table.py").write_text(TABLE_MODULE)
    install_distribution(folder, "acme", "sysmlc.backends", "broken = acme_table:BACKEND")
    install_distribution(folder, "lost", "sysmlc.frontends", "lost = lost:FRONTEND")
    (folder / "plant.ir").write_text('Class gate "Gate"\n')
    result = CliRunner().invoke(
        sysmlc_command, [str(folder / "plant.ir"), "-o", str(folder / "out"), "--format", "json"]
    )
    findings = [
        (item["code"], item["severity"], item["message"])
        for item in json.loads(result.stdout)["diagnostics"]
    ]
    module = folder / "acme_table.py"
    line = TABLE_MODULE[: TABLE_MODULE.index("raise")].count("\n") + 1
    assert findings == [
        (
            "SM914",
            "warning",
            "front end 'lost' cannot be loaded: ModuleNotFoundError: No module named 'lost' "
            "(lost:FRONTEND of lost); the plug-in is ignored",
        ),
        (
            "SM915",
            "error",
            f"back end broken failed: ValueError: boom (acme_table of acme, {module}:{line})",
        ),
    ]
    assert result.exit_code == 1
    assert (folder / "out/diagrams/model.bdd.puml").exists()


FRONTEND_METHODS = """
class Failing(TableFrontend):
    is_folder_unit = False

    def list_attachments(self, source):
        return ()

    def read_names(self, source):
        return FileNames()

    def METHOD(self, source):
        ACTION


class SilentError(Exception):
    def __str__(self):
        raise ValueError("no text")


from sysmlc.frontends.base import FileNames
FRONTEND = Failing()
"""


@pytest.mark.parametrize(
    ("method", "action", "problem"),
    [
        ("detect", "raise ValueError('boom')", "ValueError: boom"),
        ("detect", "raise SilentError", "SilentError without a readable text"),
        ("detect", "return 'certainly'", "ValueError: could not convert string to float"),
        ("links", "raise ValueError('boom')", "ValueError: boom"),
        ("links", "return None", "TypeError: 'NoneType' object is not iterable"),
        ("list_attachments", "raise SilentError", "SilentError without a readable text"),
        ("read_names", "raise ValueError('boom')", "ValueError: boom"),
    ],
)
def test_a_front_end_of_a_plug_in_that_fails_before_reading_is_named(
    folder, method, action, problem
):
    sys.modules.pop("acme_table", None)
    methods = FRONTEND_METHODS.replace("METHOD", method).replace("ACTION", action)
    (folder / "acme_table.py").write_text(TABLE_MODULE + methods)
    install_distribution(folder, "acme", "sysmlc.frontends", "table = acme_table:FRONTEND")
    (folder / "models").mkdir()
    for name in ("plant.table", "other.table"):
        (folder / "models" / name).write_text("Gate Lamp\n")
    arguments = [str(folder / "models"), "-o", str(folder / "out"), "--format", "concise"]
    result = CliRunner().invoke(sysmlc_command, arguments)
    message = f"front end table failed, so that nothing is written: {problem}"
    assert f"plant.table: error[SM916 plug-in-stop]: {message}" in result.stderr
    assert "(acme_table of acme" in result.stderr
    assert (result.exit_code, list(folder.rglob("*.puml"))) == (2, [])


def test_passes_of_plug_ins_that_wait_for_one_another_are_ignored(folder):
    sys.modules.pop("counting_elements", None)
    module = PASS_MODULE.replace('("views",)', '("census",)')
    (folder / "counting_elements.py").write_text(module)
    install_distribution(folder, "counting", "sysmlc.passes", "census = counting_elements:PASS")
    with pytest.warns(PlugInWarning, match="passes wait for one another: census"):
        passes = registry.load_passes({})
    assert {step.name for step in passes} == set(pipeline.NAMES)


@pytest.fixture
def restore_catalogue():
    """Remove the rule of the plug-in after the test."""
    yield
    catalogue = import_module("sysmlc.diagnostics.rule")
    catalogue._rules.pop("ACME4", None)
    catalogue._names.discard("long-name")


def test_rules_of_a_pass_are_in_the_catalogue(folder, restore_catalogue):
    (folder / "strict_names.py").write_text(
        "from sysmlc.diagnostics import Severity, rule\n"
        'LONG = rule("ACME4", "long-name", Severity.INFO, "a long name")\n' + PASS_MODULE
    )
    install_distribution(folder, "strictness", "sysmlc.passes", "census = strict_names:PASS")
    assert registry.load_full_catalogue()["ACME4"].name == "long-name"
