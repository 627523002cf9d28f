"""Back end ``monitor``: a runtime monitor for each contract, in C99 and in Python.

Both need no library and constant memory. They are printed from ``logic.monitors``, and name the
broken conjunct and its element.
"""

from collections.abc import Callable, Iterator, Mapping

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.contracts import list_traced_elements
from sysmlc.backends.templates import Templates
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Graph
from sysmlc.logic.contract import BooleanDomain, Class, Contract, EnumerationDomain, Owner, Variable
from sysmlc.logic.domains import describe
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var, has_primes
from sysmlc.logic.identifiers import identifier, make_unique
from sysmlc.logic.monitors import Check, Monitor, build_monitor
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
    c_language = _make_c_language(fields, constants)
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
                python_rule=print_expression(bit.rule, _PYTHON, is_about_two_steps=True),
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


def _build_check(graph: Graph, check: Check, c_language: "_Language") -> _Check:
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
        python_test=print_expression(conjunct.formula, _PYTHON, is_about_two_steps),
        c_description=", ".join(map(quote_c, description)),
        python_description=", ".join(map(quote_python, description)),
    )


def _has_division(formula: Formula) -> bool:
    if not isinstance(formula, Apply):
        return False
    return formula.op in (Op.DIV, Op.MOD) or any(map(_has_division, formula.args))


# -- expressions -----------------------------------------------------------------------------------


class _Language(Struct, frozen=True):
    """How a programming language spells the parts of an expression."""

    negation: str
    conjunction: str
    disjunction: str
    print_constant: Callable[[Literal], str]
    print_variable: Callable[[str, str], str]
    """Prints a step, ``before`` or ``now``, and the name of a variable."""


_OPERATORS = {
    Op.IFF: "({0} == {1})",
    Op.EQ: "({0} == {1})",
    Op.NE: "({0} != {1})",
    # The model divides towards zero, x / 0 is 0, and x mod 0 is x (logic.evaluate).
    Op.DIV: "divide({0}, {1})",
    Op.MOD: "({0} - {1} * divide({0}, {1}))",
}
"""Operators that C and Python spell differently from formulas, but in the same way."""


def _make_c_language(fields: Mapping[str, str], constants: Mapping[str, str]) -> _Language:
    def print_constant(value: Literal) -> str:
        if isinstance(value, str):
            return constants[value]
        return str(value).lower() if isinstance(value, bool) else f"{value}L"

    return _Language(
        "!", " && ", " || ", print_constant, lambda step, name: f"{step}->{fields[name]}"
    )


def _print_python_constant(value: Literal) -> str:
    return quote_python(value) if isinstance(value, str) else str(value)


_PYTHON = _Language(
    "not ",
    " and ",
    " or ",
    _print_python_constant,
    lambda step, name: f"{step}[{quote_python(name)}]",
)


def print_expression(formula: Formula, language: _Language, is_about_two_steps: bool) -> str:
    """Return a formula without temporal operators as an expression in parentheses.

    If it *is_about_two_steps*, variables without primes have the values of the step before.
    """

    def print_part(part: Formula) -> str:
        match part:
            case Const(value):
                return language.print_constant(value)
            case Var(name, primed):
                is_past = is_about_two_steps and not primed
                return language.print_variable("before" if is_past else "now", name)
            case Apply(op, args):
                return _join_operands(op, [print_part(arg) for arg in args], language)

    return print_part(formula)


def _join_operands(op: Op, operands: list[str], language: _Language) -> str:
    match op:
        case Op.NOT:
            return f"({language.negation}{operands[0]})"
        case Op.AND:
            return f"({language.conjunction.join(operands)})"
        case Op.OR:
            return f"({language.disjunction.join(operands)})"
        case Op.IMPLIES:
            return f"(({language.negation}{operands[0]}){language.disjunction}{operands[1]})"
        case _:
            return _OPERATORS.get(op, f"({{0}} {op} {{1}})").format(*operands)


BACKEND = MonitorBackend()
