"""Back end ``monitor``: a runtime monitor for each contract, in C99 and in Python.

Both need no library and constant memory. They are printed from ``controllers.monitor``, and name
the broken conjunct and its element.
"""

from collections.abc import Iterable, Iterator, Mapping
from functools import partial

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.contracts import list_traced_elements
from sysmlc.backends.templates import Templates
from sysmlc.controllers.languages import (
    PYTHON,
    Language,
    make_c_language,
    print_c_number,
    print_expression,
    print_python_number,
    print_sum,
    round_to_double,
)
from sysmlc.controllers.monitor import Check, InputSum, Monitor, build_monitor
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Graph
from sysmlc.logic import domains
from sysmlc.logic.contract import BooleanDomain, Class, Contract, EnumerationDomain, Owner, Variable
from sysmlc.logic.formula import TRUE, Apply, Formula, Op, has_primes
from sysmlc.logic.identifiers import identifier, make_unique
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.contract_reduction import as_ltl
from sysmlc.logic.region_formulas import describe_literals, print_worded, word_regions
from sysmlc.support.output import Output
from sysmlc.support.program_text import format_comment, is_c_word, quote_c, quote_python

NOTHING_TO_MONITOR = rule(
    "SM579",
    "contract-without-monitor",
    Severity.INFO,
    "the contract of '{component}' has no monitor: no finite run breaks it",
    help="state what must hold in each step, or within a number of steps",
)
_NO_REGION = "NO_REGION"
"""The constant in C for the region of a number that has none."""
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
    """A variable of the contract or a number, with its name as C spells it."""

    field: str
    c_type: str
    comment: str
    key: str
    """The name as a string of Python."""
    unit: str = ""
    """The unit of a number as a string of C, which a macro stands for."""
    unit_macro: str = ""


class _Region(Struct, frozen=True):
    """A variable of the contract that is the region of a sum of inputs."""

    field: str
    c_type: str
    c_sum: str
    cases: tuple[tuple[str, str], ...]
    """Tests in C, each with the region if no earlier one succeeds; the last test is empty."""
    key: str
    python_sum: str
    floors: tuple[str, ...]
    """The lower ends of regions in Python with the regions, and the lowest region."""


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
    inputs: tuple[_Variable, ...]
    variables: tuple[_Variable, ...]
    """The inputs that are variables of the contract."""
    regions: tuple[_Region, ...]
    """The other variables of the contract."""
    literals: tuple[str, ...]
    """Names of the constants in C, one for each literal of all enumerations."""
    bits: tuple[_Bit, ...]
    checks: tuple[_Check, ...]
    unmonitored: tuple[str, ...]
    uses_division: bool


def _build_page(graph: Graph, monitor: Monitor, prefix: str) -> _Page:
    contract = monitor.contract
    names = [variable.name for variable in contract.variables] + [b.name for b in monitor.bits]
    names = list(dict.fromkeys((*names, *monitor.numbers)))
    fields = dict(zip(names, _name_in_c(names, "value"), strict=True))
    constants = _name_literals(contract, prefix)
    sums = monitor.sums
    c_language = make_c_language(fields, constants)
    rules = [bit.rule for bit in monitor.bits]
    formulas = [*rules, *(check.conjunct.formula for check in monitor.checks)]
    return _Page(
        component=format_comment(contract.component, _MAX_COMMENT),
        prefix=prefix,
        inputs=tuple(_list_inputs(monitor, fields, prefix, tuple(constants.values()))),
        variables=tuple(
            _make_variable(item, fields) for item in contract.variables if item.name not in sums
        ),
        regions=tuple(
            _build_region(item, sums[item.name], fields[item.name], c_language)
            for item in contract.variables
            if item.name in sums
        ),
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
        checks=tuple(
            _build_check(graph, check, c_language, contract.variables) for check in monitor.checks
        ),
        unmonitored=tuple(
            format_comment(
                conjunct.text or print_worded(as_ltl(conjunct), contract.variables), _MAX_COMMENT
            )
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
    constants = _name_in_c(names, "literal", f"{prefix}_monitor_h", _NO_REGION)
    return dict(zip(literals, constants, strict=True))


def _name_in_c(names: list[str], fallback: str, *taken: str) -> tuple[str, ...]:
    """Return unique identifiers that C and C++ read as names."""
    return make_unique(names, fallback, *taken, *filter(is_c_word, map(identifier, names)))


def _list_inputs(
    monitor: Monitor, fields: Mapping[str, str], prefix: str, taken: Iterable[str]
) -> Iterator[_Variable]:
    """Yield the values that a run gives: numbers in the place of the regions that they are in."""
    sums, numbers = monitor.sums, monitor.numbers
    variables = {variable.name: variable for variable in monitor.contract.variables}
    terms = (sums[name].term if name in sums else ((name, 1),) for name in variables)
    macros = [f"{prefix}_{fields[name]}_unit".upper() for name in numbers]
    unit_macros = dict(zip(numbers, _name_in_c(macros, "unit", *taken), strict=True))
    for name in dict.fromkeys(name for term in terms for name, _ in term):
        if name not in numbers:
            yield _make_variable(variables[name], fields)
            continue
        number = numbers[name]
        uses = {key: item for key, item in sums.items() if name in dict(item.term)}
        if name in uses:
            text = ", ".join(condition for _, condition in describe_literals(variables[name]))
        else:
            text = f"for {', '.join(variables[key].wording or key for key in uses)}"
        unit = f" in {number.unit}" if number.unit else ""
        yield _Variable(
            field=fields[name],
            c_type="long" if number.is_integral else "double",
            comment=format_comment(f"{name}{unit}: {text}", _MAX_COMMENT),
            key=quote_python(name),
            unit=quote_c(number.unit) if number.unit else "",
            unit_macro=unit_macros[name],
        )


def _make_variable(variable: Variable, fields: Mapping[str, str]) -> _Variable:
    return _Variable(
        field=fields[variable.name],
        c_type="bool" if isinstance(variable.domain, BooleanDomain) else "long",
        comment=format_comment(_describe_variable(variable), _MAX_COMMENT),
        key=quote_python(variable.name),
    )


def _build_region(variable: Variable, sum_: InputSum, field: str, language: Language) -> _Region:
    """Return the comparisons of a sum in both languages."""
    is_integral = sum_.regions.is_integral
    print_number = partial(print_c_number, is_integral=is_integral)
    literals = domains.values(variable.domain)
    cases = [] if is_integral else [("number != number", _NO_REGION)]
    floors = []
    for cut, index in sum_.regions.list_floors():
        literal = None if index is None else literals[index]
        c_region = _NO_REGION if literal is None else language.print_constant(literal)
        if cut is None:
            cases.append(("", c_region))
            floors.append(ascii(literal))
        else:
            sign, number = ">" if cut.is_above else ">=", print_number(cut.number)
            cases.append((f"number {sign} {number}", c_region))
            exact, nearest = print_python_number(cut.number), round_to_double(cut.number)
            floors.append(f"({exact}, {nearest!r}, {cut.is_above}, {literal!a})")
    return _Region(
        field=field,
        c_type="long" if is_integral else "double",
        c_sum=print_sum(sum_.term, language, print_number),
        cases=tuple(cases),
        key=quote_python(variable.name),
        python_sum=print_sum(sum_.term, PYTHON, print_python_number),
        floors=tuple(floors),
    )


def _describe_variable(variable: Variable) -> str:
    """Return name and values of a variable, and its name in formulas of the author."""
    wording = f", {variable.wording} in formulas" if variable.wording else ""
    return f"{variable.name}: {domains.describe(variable.domain)}{wording}"


def _build_check(
    graph: Graph, check: Check, c_language: Language, variables: tuple[Variable, ...]
) -> _Check:
    conjunct = check.conjunct
    is_about_two_steps = has_primes(conjunct.formula)
    condition = "first" if conjunct.class_ is Class.INIT else "each"
    side = "assumption" if check.owner is Owner.ENVIRONMENT else "guarantee"
    worded = word_regions(conjunct.formula, variables)
    # That a number has a value is true for each number.
    shown = conjunct if worded == TRUE else replace(conjunct, formula=worded)
    formula = print_formula(as_ltl(shown))
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
