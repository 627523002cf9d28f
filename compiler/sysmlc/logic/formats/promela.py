"""Promela (SPIN): a component's behaviour as two processes, its requirements as ``ltl`` claims.

In each round the process ``environment`` chooses the next inputs; then the process ``component``
chooses the next outputs. The component *guesses*: it gives each variable any value, and compares it
with the conjuncts of the step relation as soon as all their next values are chosen. After a wrong
guess both processes stop with ``blocked`` set, and no claim counts such a run. So the rounds of the
other runs are exactly the steps of the contract.

SPIN rejects ``X``, and its runs have states in the middle of a round. Claims are therefore sampled
where ``step`` is true, which is once in each round (the clock operator ``@`` of PSL, IEEE 1850):
``G p`` becomes ``[](step -> p)``. At these states the next values are known but not yet taken, so
that ``X (x==1)`` is ``next_x==1``. For ``X X (x==1)`` the model guesses ``later_1``, a Boolean that
has to equal ``next_x==1``, and the formula is ``next_later_1``. Before F, G and U, ``X p`` is
``step U (!step && p)``. Recurring assumptions are one Boolean ``fair``, which is true again and
again if each of them is: ``due`` is the assumption that comes next, as in the degeneralisation
of Büchi automata.
"""

import itertools
from collections.abc import Iterable, Iterator, Sequence

from msgspec.structs import replace

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Source,
    Variable,
)
from sysmlc.logic.formats.encodings import measure_numbers
from sysmlc.logic.formats.lowering import (
    expand_comparison,
    has_partial_division,
    index_domains,
    is_boolean,
    list_literals,
    rename_reserved,
    rewrite_atoms,
    rewrite_conjuncts,
    rewrite_contract_atoms,
    separate_steps,
)
from sysmlc.logic.formats.spin import KEYWORDS, sample_start
from sysmlc.logic.formats.writing import (
    LTL_WORDS,
    Notation,
    NotExpressibleError,
    apply_lowering,
    is_recurring,
    is_step,
)
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var
from sysmlc.logic.identifiers import Names
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.contract_reduction import as_ltl
from sysmlc.support.program_text import format_comment

_OWN_NAMES = "step blocked fair due turn environment component stop FIRST ENVIRONMENT COMPONENT"
_RESERVED = KEYWORDS | frozenset(_OWN_NAMES.split())
_WORDS = {**LTL_WORDS, Op.AND: "&&", Op.OR: "||", Op.EQ: "==", Op.MOD: "%"}
_MAX_LITERALS = 250
"""SPIN numbers the names of an mtype from 1 to 255."""
_MAX_NUMBER = 2**31 - 1


# -- lowering --------------------------------------------------------------------------------------


def lower(contract: Contract, format_name: str) -> Contract:
    """Return the contract with names and operators of Promela. Raises NotExpressibleError."""
    # Macros of the verifier are in capitals.
    capitals = {item.name for item in contract.variables if item.name == item.name.upper()}
    renamed = rename_reserved(contract, {*_RESERVED, *capitals})
    variable_domains = index_domains(renamed)

    def lower_atom(atom: Formula) -> Formula:
        if has_partial_division(atom):
            return expand_comparison(atom, variable_domains)
        match atom:
            case Apply(Op.EQ | Op.NE, (left, _)) if is_boolean(left, variable_domains):
                return separate_steps(atom, variable_domains)
            case _:
                return atom

    lowered = apply_lowering(
        renamed, format_name, lambda whole: rewrite_contract_atoms(whole, lower_atom)
    )
    _check_numbers(lowered, format_name)
    return lowered


def _check_numbers(contract: Contract, format_name: str) -> None:
    """Raise NotExpressibleError for values that do not fit into the types of Promela."""
    variable_domains = index_domains(contract)
    if len(list_literals(contract)) > _MAX_LITERALS:
        raise NotExpressibleError(format_name, "its enumerations have too many literals")
    for conjunct in (*contract.assumptions, *contract.guarantees):
        if measure_numbers(conjunct.formula, variable_domains) > _MAX_NUMBER:
            raise NotExpressibleError(format_name, "its numbers do not fit into 32 bits", conjunct)
    for domain in variable_domains.values():
        if isinstance(domain, IntegerDomain) and max(-domain.low, domain.high) > _MAX_NUMBER:
            raise NotExpressibleError(format_name, "its numbers do not fit into 32 bits")


# -- writing ---------------------------------------------------------------------------------------


def write(contract: Contract, format_name: str) -> str:
    """Return the model. Raises NotExpressibleError if no behaviour is described."""
    if not any(map(is_step, contract.guarantees)):
        raise NotExpressibleError(format_name, "no behaviour of the component is described")
    claims = itertools.filterfalse(is_step, contract.guarantees)
    if any(contract.list_assumptions(item.viewpoint) != contract.assumptions for item in claims):
        raise NotExpressibleError(format_name, "its requirements have different assumptions")
    lowered = _eliminate_next(lower(contract, format_name))
    return "\n".join([*_PromelaWriter(lowered).iter_lines(), ""])


def _eliminate_next(contract: Contract) -> Contract:
    """Return the contract with next values in place of the operator X, except before F, G and U.

    A comparison with next values that follows an X gets a Boolean that equals it in each step.
    """
    names = Names(*index_domains(contract), *list_literals(contract), *_RESERVED)
    predictions: dict[Formula, Variable] = {}

    def predict(atom: Formula) -> Formula:
        if not f.has_primes(atom):
            return atom
        if atom not in predictions:
            name = names.new("later_1")
            predictions[atom] = Variable(name, Owner.SYSTEM, BooleanDomain())
        return f.var(predictions[atom].name)

    def eliminate(formula: Formula) -> Formula:
        match formula:
            case Apply(Op.NEXT, (operand,)) if not f.has_future(inner := eliminate(operand)):
                return f.prime(rewrite_atoms(inner, predict))
            case Apply(op, args):
                return Apply(op, tuple(map(eliminate, args)))
            case _:
                return formula

    lowered = rewrite_conjuncts(contract, eliminate)
    facts = tuple(
        Conjunct(f.iff(f.var(variable.name), atom), Class.SAFETY, "", source=Source.DERIVED)
        for atom, variable in predictions.items()
    )
    return replace(
        lowered,
        variables=(*lowered.variables, *predictions.values()),
        guarantees=(*lowered.guarantees, *facts),
    )


class _PromelaWriter:
    """Writes one model."""

    def __init__(self, contract: Contract) -> None:
        self._contract = contract
        self._domains = index_domains(contract)
        self._prefix = "next_"
        while any(name.startswith(self._prefix) for name in self._domains):
            self._prefix += "_"
        self._notation = Notation(_WORDS, lambda name: f"{self._prefix}{name}")
        self._facts = [*contract.assumptions, *filter(is_step, contract.guarantees)]
        self._recurring = list(filter(is_recurring, contract.assumptions))

    def iter_lines(self) -> Iterator[str]:
        """Yield the lines of the model."""
        claims = list(self._iter_claims())
        name = format_comment(self._contract.component)
        yield f"/* {name}: its behaviour and requirements, written by sysmlc."
        yield "   Check one claim: spin -a FILE && gcc -o pan pan.c && ./pan -a -N CLAIM */"
        yield ""
        literals = [*list_literals(self._contract), "FIRST", "ENVIRONMENT", "COMPONENT"]
        yield f"mtype = {{ {', '.join(literals)} }};"
        for variable in self._contract.variables:
            direction = "input" if variable.owner is Owner.ENVIRONMENT else "output"
            type_ = _print_type(variable.domain)
            yield f"{type_} {variable.name}, {self._prefix}{variable.name}; /* {direction} */"
        yield "bool step;    /* once in each round, when the next values are chosen */"
        yield "bool blocked; /* the values chosen are no step: the run does not count */"
        if self._recurring:
            yield "bool fair;    /* each recurring assumption has held since the last time */"
            yield "int due;      /* the recurring assumption that comes next */"
        yield "mtype turn = FIRST;"
        yield ""
        yield from self._iter_commit()
        yield from self._iter_environment()
        yield from self._iter_component()
        yield from claims

    def _iter_commit(self) -> Iterator[str]:
        """Yield a macro that makes the next values the current ones."""
        yield "inline take_next_values() {"
        yield "  d_step {"
        yield "    step = false;"
        for variable in self._contract.variables:
            yield f"    {variable.name} = {self._prefix}{variable.name};"
        if self._recurring:
            yield "    fair = false;"
            yield "    if"
            for index, assumption in enumerate(self._recurring):
                condition = self._print_condition(assumption.formula)
                yield f"    :: due == {index} && ({condition}) -> due = {index + 1}"
            yield "    :: else"
            yield "    fi;"
            yield f"    if :: due == {len(self._recurring)} -> due = 0; fair = true :: else fi;"
        yield from ("    skip", "  }", "}", "")

    def _iter_environment(self) -> Iterator[str]:
        yield "active proctype environment() {"
        yield "  do"
        yield "  :: atomic { turn == ENVIRONMENT ->"
        yield "      take_next_values();"
        yield from self._iter_choices(list(self._iter_steps()), Owner.ENVIRONMENT)
        yield "      turn = COMPONENT"
        yield "    }"
        yield "  od;"
        yield "stop: blocked = true"
        yield "}"
        yield ""

    def _iter_component(self) -> Iterator[str]:
        yield "active proctype component() {"
        yield "  atomic { turn == FIRST ->"
        start = list(self._iter_start())
        for owner in Owner:
            yield from self._iter_choices(start, owner)
        yield "      turn = ENVIRONMENT"
        yield "  };"
        yield "  do"
        yield "  :: atomic { turn == COMPONENT ->"
        yield from self._iter_choices(list(self._iter_steps()), Owner.SYSTEM)
        yield "      step = true;"
        yield "      turn = ENVIRONMENT"
        yield "    }"
        yield "  od;"
        yield "stop: blocked = true"
        yield "}"

    # -- the step relation -------------------------------------------------------------------------

    def _iter_start(self) -> Iterator[Formula]:
        """Yield the facts about the first step, as formulas about next values."""
        for fact in self._facts:
            is_about_start = fact.class_ is Class.INIT
            is_about_all = fact.class_ is Class.SAFETY and not f.has_primes(fact.formula)
            if is_about_start or is_about_all:
                yield from f.split_conjunction(f.prime(fact.formula))

    def _iter_steps(self) -> Iterator[Formula]:
        """Yield the facts about a step and the next one."""
        for fact in self._facts:
            if fact.class_ is Class.SAFETY:
                formula = fact.formula
                yield from f.split_conjunction(
                    formula if f.has_primes(formula) else f.prime(formula)
                )

    def _iter_choices(self, facts: Sequence[Formula], owner: Owner) -> Iterator[str]:
        """Yield the choice of the next values of one owner; inputs are chosen before outputs."""
        inputs = [v for v in self._contract.variables if v.owner is Owner.ENVIRONMENT]
        outputs = [v for v in self._contract.variables if v.owner is Owner.SYSTEM]
        for variable, tests in _order(inputs, outputs, facts):
            if variable.owner is owner:
                yield from (f"      {line}" for line in self._iter_choice(variable, tests))

    def _iter_choice(self, variable: Variable, tests: Sequence[Formula]) -> Iterator[str]:
        name = f"{self._prefix}{variable.name}"
        if len(tests) == 1:
            value = _find_definition(variable, tests[0])
            if value is not None:
                yield f"{name} = {self._print_condition(value)};"
                return
        match variable.domain:
            case BooleanDomain():
                yield f"if :: {name} = false :: {name} = true fi;"
            case EnumerationDomain(literals):
                yield f"if {' '.join(f':: {name} = {literal}' for literal in literals)} fi;"
            case IntegerDomain(low, high):
                yield f"select ({name} : {low} .. {high});"
        if tests:
            yield "if"
            *firsts, last = (f"({self._print_condition(test)})" for test in tests)
            # SPIN ends a statement at a line that ends with a parenthesis.
            lines = [*(f"{test} &&" for test in firsts), last]
            yield f":: {lines[0]}"
            yield from (f"   {line}" for line in lines[1:])
            yield ":: else -> goto stop"
            yield "fi;"

    def _print_condition(self, formula: Formula) -> str:
        """Return a formula without temporal operators as an expression of Promela."""
        return self._notation.print(_convert_connectives(formula))

    # -- claims ------------------------------------------------------------------------------------

    def _iter_claims(self) -> Iterator[str]:
        """Yield the claims: in each run of the contract that is not blocked, the formula holds."""
        general = [
            sample_start(as_ltl(item), self._print_condition)
            for item in self._contract.assumptions
            if item.class_ in (Class.OTHER, Class.LIVENESS) and item not in self._recurring
        ]
        names = Names(*self._domains, *_RESERVED, *list_literals(self._contract))
        for claim in itertools.filterfalse(is_step, self._contract.guarantees):
            formula = as_ltl(claim)
            recurrence = ["([]<>fair)"] if self._recurring and claim.class_ != Class.SAFETY else []
            assumed = " && ".join([*recurrence, *general])
            text = sample_start(formula, self._print_condition)
            text = f"(({assumed}) -> {text})" if assumed else text
            yield ""
            yield f"/* {format_comment(print_formula(formula))} */"
            title = names.new(claim.viewpoint or "claim", "claim")
            yield f"ltl {title} {{ (<>blocked) || {text} }}"


def _order(
    inputs: Sequence[Variable], outputs: Sequence[Variable], facts: Iterable[Formula]
) -> Iterator[tuple[Variable, list[Formula]]]:
    """Yield the variables in the order of their choice, each with the facts that it completes.

    A fact is complete when all its next values are chosen. Of several variables the one comes first
    that completes most facts, so that wrong guesses are found early.
    """
    missing = {
        fact: {variable.name for variable in f.variables(fact) if variable.primed}
        for fact in dict.fromkeys(facts)
        if fact != f.TRUE
    }
    for group in (inputs, outputs):
        remaining = list(group)
        while remaining:
            counts = [
                sum(names == {variable.name} for names in missing.values())
                for variable in remaining
            ]
            variable = remaining.pop(counts.index(max(counts)))
            tests = [fact for fact, names in missing.items() if names <= {variable.name}]
            for fact in tests:
                del missing[fact]
            for names in missing.values():
                names.discard(variable.name)
            yield variable, tests


def _find_definition(variable: Variable, fact: Formula) -> Formula | None:
    """Return the next value of a variable if the fact is an equation for it."""
    next_value = Var(variable.name, primed=True)
    match fact:
        case Var():
            return f.TRUE
        case Apply(Op.NOT, (operand,)) if operand == next_value:
            return f.FALSE
        case Apply(Op.IFF, (left, right)) if left == next_value:
            return None if next_value in f.variables(right) else right
        case Apply(Op.EQ, (left, Const(value))) if left == next_value:
            return Const(value) if domains.contains(variable.domain, value) else None
        case Apply(Op.EQ, (left, Var(name) as other)) if left == next_value:
            return other if name == variable.name else None
        case _:
            return None


def _convert_connectives(formula: Formula) -> Formula:
    """Replace implication and equivalence, which expressions of Promela do not have."""
    match formula:
        case Apply(op, args):
            operands = tuple(map(_convert_connectives, args))
            if op is Op.IMPLIES:
                return f.either(f.negate(operands[0]), operands[1])
            return Apply(Op.EQ if op is Op.IFF else op, operands)
        case _:
            return formula


def _print_type(domain: Domain) -> str:
    match domain:
        case BooleanDomain():
            return "bool"
        case EnumerationDomain():
            return "mtype"
        case IntegerDomain(low, high):
            return "byte" if low >= 0 and high <= 255 else "int"
