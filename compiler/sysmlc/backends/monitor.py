"""Back end ``monitor``: a runtime monitor for each contract, in C99 and in Python.

Both need no library and constant memory. They are printed from ``controllers.monitor``, and name
the broken conjunct and its element.
"""

from collections.abc import Iterator, Mapping

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.contracts import list_traced_elements
from sysmlc.backends.templates import Templates
from sysmlc.controllers.languages import PYTHON, Language, make_c_language, print_expression
from sysmlc.controllers.monitor import Check, Monitor, build_monitor
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Graph
from sysmlc.logic.contract import BooleanDomain, Class, Contract, EnumerationDomain, Owner, Variable
from sysmlc.logic.domains import describe
from sysmlc.logic.formula import Apply, Formula, Op, has_primes
from sysmlc.logic.identifiers import identifier, make_unique
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.contract_reduction import as_ltl
from sysmlc.support.output import Output
from sysmlc.support.program_text import format_comment, is_c_word, quote_c, quote_python

NOTHING_TO_MONITOR = rule(
    "SM579",
    "contract-without-monitor",
    Severity.INFO,
    "the contract of '{component}' has no monitor: no finite run breaks it",
    help="state what must hold in each step, or within a number of steps",
)
_MAX_COMMENT = 90
"""Characters of a name or range in a comment."""


class MonitorBackend(Struct, frozen=True):
    """Writes a monitor in C99 (a header and a source) and a monitor in Python."""

    name: str = "monitor"
    summary: str = "runtime monitors of contracts in C99 and Python"
    is_default: bool = False
    needs: tuple[str, ...] = ("contracts",)

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add three files for each contract with something that a finite run can break."""
        contracts = graph.derived(Contract)
        names = [contract.component.rpartition("::")[2].lower() for contract in contracts]
        # A suffix follows each prefix, so that it may be a keyword.
        prefixes = make_unique(names, "component")
        # Templates of users are not read: the generated code must be the code that is tested.
        with Templates(self.name, None) as templates:
            for contract, prefix in zip(contracts, prefixes, strict=True):
                monitor = build_monitor(contract)
                if not monitor.checks:
                    subject = graph.subject(graph[contract.origin])
                    sink.report(NOTHING_TO_MONITOR, subject, component=contract.component)
                    continue
                trace = tuple(list_traced_elements(graph, contract))
                page = _build_page(graph, monitor, prefix)
                for suffix in (".h", ".c", ".py"):
                    text = templates.render(f"monitor{suffix}.j2", page=page)
                    path = f"monitors/{prefix}_monitor{suffix}"
                    output.add(path, text, trace, self.name, name=contract.component)


class _Variable(Struct, frozen=True):
    """A variable of the contract, with its name as C spells it."""

    field: str
    c_type: str
    comment: str
    key: str
    """The name as a string of Python."""


class _Bit(Struct, frozen=True):
    """A history bit, whose rule is an expression in both languages."""

    key: str
    field: str
    is_true_first: bool
    c_rule: str
    python_rule: str


class _Check(Struct, frozen=True):
    """A check; ``condition`` says when it applies: ``first``, ``each`` or ``later`` steps."""

    condition: str
    c_test: str
    python_test: str
    c_description: str
    python_description: str


class _Page(Struct, frozen=True):
    """The content of the three files of one monitor."""

    component: str
    prefix: str
    """First part of the file names and of all names in C."""
    variables: tuple[_Variable, ...]
    literals: tuple[str, ...]
    """Names of the constants in C, one for each literal of all enumerations."""
    bits: tuple[_Bit, ...]
    checks: tuple[_Check, ...]
    unmonitored: tuple[str, ...]
    uses_division: bool


def _build_page(graph: Graph, monitor: Monitor, prefix: str) -> _Page:
    contract = monitor.contract
    names = [variable.name for variable in contract.variables] + [b.name for b in monitor.bits]
    fields = dict(zip(names, _name_in_c(names, "value"), strict=True))
    constants = _name_literals(contract, prefix)
    c_language = make_c_language(fields, constants)
    rules = [bit.rule for bit in monitor.bits]
    formulas = [*rules, *(check.conjunct.formula for check in monitor.checks)]
    return _Page(
        component=format_comment(contract.component, _MAX_COMMENT),
        prefix=prefix,
        variables=tuple(_list_variables(contract, fields)),
        literals=tuple(constants.values()),
        bits=tuple(
            _Bit(
                key=quote_python(bit.name),
                field=fields[bit.name],
                is_true_first=bit.start,
                c_rule=print_expression(bit.rule, c_language, is_about_two_steps=True),
                python_rule=print_expression(bit.rule, PYTHON, is_about_two_steps=True),
            )
            for bit in monitor.bits
        ),
        checks=tuple(_build_check(graph, check, c_language) for check in monitor.checks),
        unmonitored=tuple(
            format_comment(conjunct.text or print_formula(as_ltl(conjunct)), _MAX_COMMENT)
            for conjunct in monitor.unmonitored
        ),
        uses_division=any(map(_has_division, formulas)),
    )


def _name_literals(contract: Contract, prefix: str) -> dict[str, str]:
    """Return a constant of C for each literal; equal literals of two enumerations share one."""
    literals = list(
        dict.fromkeys(
            literal
            for variable in contract.variables
            if isinstance(variable.domain, EnumerationDomain)
            for literal in variable.domain.literals
        )
    )
    names = [f"{prefix}_{literal}".upper() for literal in literals]
    constants = _name_in_c(names, "literal", f"{prefix}_monitor_h")
    return dict(zip(literals, constants, strict=True))


def _name_in_c(names: list[str], fallback: str, *taken: str) -> tuple[str, ...]:
    """Return unique identifiers that C and C++ read as names."""
    return make_unique(names, fallback, *taken, *filter(is_c_word, map(identifier, names)))


def _list_variables(contract: Contract, fields: Mapping[str, str]) -> Iterator[_Variable]:
    for variable in contract.variables:
        yield _Variable(
            field=fields[variable.name],
            c_type="bool" if isinstance(variable.domain, BooleanDomain) else "long",
            comment=format_comment(_describe_variable(variable), _MAX_COMMENT),
            key=quote_python(variable.name),
        )


def _describe_variable(variable: Variable) -> str:
    """Return name and values of a variable, and its name in formulas of the author."""
    wording = f", {variable.wording} in formulas" if variable.wording else ""
    return f"{variable.name}: {describe(variable.domain)}{wording}"


def _build_check(graph: Graph, check: Check, c_language: "Language") -> _Check:
    conjunct = check.conjunct
    is_about_two_steps = has_primes(conjunct.formula)
    condition = "first" if conjunct.class_ is Class.INIT else "each"
    side = "assumption" if check.owner is Owner.ENVIRONMENT else "guarantee"
    formula = print_formula(as_ltl(conjunct))
    element = graph.qualified_name(graph[conjunct.origin]) if conjunct.origin in graph else ""
    description = (side, conjunct.text or formula, formula, element)
    return _Check(
        condition="later" if is_about_two_steps else condition,
        c_test=print_expression(conjunct.formula, c_language, is_about_two_steps),
        python_test=print_expression(conjunct.formula, PYTHON, is_about_two_steps),
        c_description=", ".join(map(quote_c, description)),
        python_description=", ".join(map(quote_python, description)),
    )


def _has_division(formula: Formula) -> bool:
    if not isinstance(formula, Apply):
        return False
    return formula.op in (Op.DIV, Op.MOD) or any(map(_has_division, formula.args))


BACKEND = MonitorBackend()
