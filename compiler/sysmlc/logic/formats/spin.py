"""SPIN's LTL: one formula with ``[]``, ``<>`` and propositions such as ``{state==Idle}``.

SPIN 6 reads ``&& || -> <->`` from left to right with one precedence, so the reader refuses formulas
that mix them without parentheses. A file may end with Spot's lines ``.inputs`` and ``.outputs``;
without them every variable is read as an output, which is reported.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from functools import lru_cache
from pathlib import PurePath

from msgspec.structs import replace

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
)
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.draft import ContractDraft, SpecificationFile
from sysmlc.logic.formats.lowering import (
    TooManyValuesError,
    expand_comparison,
    has_partial_division,
    index_domains,
    rename_ambiguous_literals,
    separate_steps,
)
from sysmlc.logic.formats.spot import (
    blank_partition,
    list_partition,
    read_implication,
    read_partition,
)
from sysmlc.logic.formats.writing import Notation, NotExpressibleError
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var
from sysmlc.logic.infix import FormulaReader, Term
from sysmlc.logic.printing import print_literal
from sysmlc.logic.syntax import NEUTRAL, FormulaError
from sysmlc.support.disjoint_sets import DisjointSets
from sysmlc.support.program_text import C_WORDS

# -- reading ---------------------------------------------------------------------------------------

SYNTAX = replace(NEUTRAL, infix={**NEUTRAL.infix, "%": Op.MOD}, comment=r"/\*[\s\S]*?\*/|//[^\n]*")
_EQUAL_PRECEDENCE = frozenset([Op.AND, Op.OR, Op.IMPLIES, Op.IFF])
_BRACES = re.compile(r"\{([^{}]*)\}")
_EQUALITY = re.compile(r"\s*([^\W\d]\w*)\s*==\s*(-?\w+)\s*")
_WORD = re.compile(r"[^\W\d]\w*")
_NUMBER = re.compile(r"(?<!\w)-?\d{1,18}(?!\d)")
# A proposition is matched whole, so that no names are found inside it.
_NAME_OR_PROPOSITION = re.compile(r"\{[^{}]*\}|[^\W\d]\w*|[\s\S]")
_MOST_NAMED = 8
"""Most variables without an owner that a diagnostic names."""


def read(file: SpecificationFile) -> tuple[Contract, ...]:
    """Return the contract, named after the file, or nothing if a fault was reported."""
    draft = ContractDraft(file, "SPIN")
    text = blank_partition(file.text)
    owners = read_partition(file.text)
    without_owner = []
    for name, domain in _infer_domains(text, owners).items():
        if name not in owners:
            without_owner.append(name)
        draft.declare(name, 0, owners.get(name, Owner.SYSTEM), domain)
    if without_owner:
        file.report(rules.OWNER_NOT_SAID, 0, names=", ".join(without_owner[:_MOST_NAMED]))
    read_implication(draft, text, SYNTAX, _SpinReader)
    return draft.build(PurePath(file.path).stem.removesuffix(".spin"))


def _infer_domains(text: str, owners: Iterable[str]) -> dict[str, Domain]:
    """Return the variables of the formula with the values that it compares them with.

    Variables in one expression have the same values. The text has no ranges, so that numbers are
    those of the formula, and one more below and above for an expression that is not ``x==3``.
    """
    propositions = [match.group(1) for match in _BRACES.finditer(text)]
    equalities = [match.groups() for match in map(_EQUALITY.fullmatch, propositions) if match]
    variables = {*owners, *(name for name, _ in equalities)}
    values: dict[str, dict[str, None]] = {}
    groups: DisjointSets[str] = DisjointSets()
    for proposition in propositions:
        equality = _EQUALITY.fullmatch(proposition)
        if equality is not None and equality.group(2) not in variables:
            values.setdefault(equality.group(1), {})[equality.group(2)] = None
            continue
        operands = [word for word in _WORD.findall(proposition) if word not in SYNTAX.infix]
        numbers = [int(number) for number in _NUMBER.findall(proposition)]
        for name in operands:
            groups.union(operands[0], name)
            nearby = (str(number + offset) for number in numbers for offset in (-1, 0, 1))
            values.setdefault(name, {}).update(dict.fromkeys(nearby))
    merged: dict[str, dict[str, None]] = {}
    for name, compared in values.items():
        merged.setdefault(groups.find(name), {}).update(compared)
    inferred = {name: _infer_domain(list(merged[groups.find(name)])) for name in values}
    without_comments = re.sub(SYNTAX.comment, " ", text)
    words = {*SYNTAX.prefix, *SYNTAX.infix, *SYNTAX.booleans}
    names = dict.fromkeys(
        name
        for name in _NAME_OR_PROPOSITION.findall(without_comments)
        if name[0].isidentifier() and name not in words
    )
    return inferred | {name: BooleanDomain() for name in names if name not in inferred}


def _infer_domain(values: list[str]) -> Domain:
    """Return the range from 0 to the largest number, or the enumeration of the names.

    A name that is the only value gets a second one: otherwise its comparison would always be true.
    """
    numbers = [int(value) for value in values if re.fullmatch(r"-?\d{1,18}", value)]
    if len(numbers) == len(values):
        return IntegerDomain(min([0, *numbers]), max([1, *numbers]))
    if len(values) == 1:
        values = [*values, f"not_{values[0]}".replace("-", "_")]
    return EnumerationDomain(tuple(values))


class _SpinReader(FormulaReader):
    """Reads formulas of SPIN; rejects those that SPIN and other tools read differently."""

    _previous_op: Op | None = None
    """The connective before, inside the same brackets."""

    def _read_brackets(self) -> Term:
        outer_op, self._previous_op = self._previous_op, None
        term = super()._read_brackets()
        self._previous_op = outer_op
        return term

    def _read_infix(self, op: Op, left: Term) -> Term:
        offset = self.cursor.next.offset
        if op in _EQUAL_PRECEDENCE:
            if self._previous_op not in (None, op):
                raise FormulaError("parentheses must say what belongs together here", offset)
            self._previous_op = op
        return super()._read_infix(op, left)


# -- writing ---------------------------------------------------------------------------------------

_INFIX = {
    Op.AND: "&&",
    Op.OR: "||",
    Op.IMPLIES: "->",
    Op.IFF: "<->",
    Op.UNTIL: "U",
    Op.RELEASE: "V",
    Op.WEAK_UNTIL: "W",
}
_EXPRESSIONS = Notation({**{op: str(op) for op in Op}, Op.EQ: "==", Op.MOD: "%"}, lambda name: name)
"""Comparisons in SPIN's expression language, which is that of C."""
_PREFIX = {Op.NOT: "!", Op.NEXT: "X ", Op.ALWAYS: "[]", Op.EVENTUALLY: "<>"}
_PROPOSITION = re.compile(r"!?(X )?(\{[^{}]*\}|\w+)")
_SPIN_NAME = re.compile(r"[a-z_]\w*")
MAX_PROPOSITIONS = 20_000
"""Most propositions to which one comparison may be expanded."""
_CACHED_COMPARISONS = 1 << 14
_CACHED_PRINTERS = 64
# Machines of one kind have the same variables and comparisons.


class TooLargeError(Exception):
    """A comparison over so many values that its formula would be useless."""


def write(contract: Contract, format_name: str) -> str:
    """Return the contract as one formula with the owners of the variables below it."""
    renamed = rename_ambiguous_literals(contract)
    try:
        formula = print_spin(renamed).rstrip("\n")
    except TooLargeError:
        raise NotExpressibleError(format_name, str(TooManyValuesError())) from None
    return "\n".join([formula, *list_partition(renamed), ""])


def print_spin(contract: Contract) -> str:
    """Return ``(assumptions) -> (guarantees)``, or the guarantees alone. Raises TooLargeError."""
    printer = _create_printer(tuple(index_domains(contract).items()))
    assumptions = printer.print_conjunction(contract.assumptions)
    guarantees = printer.print_conjunction(contract.guarantees)
    return f"{guarantees}\n" if assumptions == "true" else f"({assumptions}) -> ({guarantees})\n"


class SpinPrinter:
    """Prints formulas over some variables, each formula once.

    A comparison about one step is a proposition with arithmetic, such as ``{x<y + 1}``, or
    ``X {x<3}`` about next values. A comparison of current with next values becomes cases.
    """

    def __init__(self, variable_domains: Mapping[str, Domain]) -> None:
        self._domains = variable_domains
        self._texts: dict[Formula, str] = {}

    def print_conjunction(self, conjuncts: Iterable[Conjunct]) -> str:
        """Return the conjunction of the conjuncts. Raises TooLargeError."""
        stated = (item for item in conjuncts if self.print_formula(item.formula) != "true")
        return " && ".join(map(self.print_conjunct, stated)) or "true"

    def print_conjunct(self, conjunct: Conjunct) -> str:
        """Return a conjunct with the temporal operators of its class. Raises TooLargeError."""
        text = self.print_formula(conjunct.formula)
        match conjunct.class_:
            case Class.SAFETY:
                return f"[]({text})"
            case Class.LIVENESS:
                return f"[]<>({text})"
            case _:
                return f"({text})"

    def print_formula(self, formula: Formula) -> str:
        """Return the formula. Raises TooLargeError."""
        text = self._texts.get(formula)
        if text is None:
            text = self._texts[formula] = self._print(formula)
        return text

    def _print(self, formula: Formula) -> str:
        match formula:
            case Const(value):
                return print_literal(value)
            case Var():
                return _print_variable(formula)
            case Apply(op, args) if op in _INFIX:
                return f" {_INFIX[op]} ".join(map(self._print_operand, args))
            case Apply(op, args) if op in _PREFIX:
                return f"{_PREFIX[op]}{self._print_operand(args[0])}"
            case _:
                names = dict.fromkeys(variable.name for variable in f.variables(formula))
                pairs = tuple((name, self._domains[name]) for name in names)
                separate = _separate(formula, pairs)
                is_proposition = separate == formula
                return _print_comparison(formula) if is_proposition else self._print(separate)

    def _print_operand(self, formula: Formula) -> str:
        text = self.print_formula(formula)
        if not isinstance(formula, Apply) or formula.op in _PREFIX:
            return text
        return text if _PROPOSITION.fullmatch(text) else f"({text})"


@lru_cache(_CACHED_PRINTERS)
def _create_printer(variables: tuple[tuple[str, Domain], ...]) -> SpinPrinter:
    return SpinPrinter(dict(variables))


@lru_cache(_CACHED_COMPARISONS)
def _separate(comparison: Formula, pairs: tuple[tuple[str, Domain], ...]) -> Formula:
    """Return a comparison as propositions about one step each. Raises TooLargeError."""
    variable_domains = dict(pairs)
    try:
        if has_partial_division(comparison):
            return expand_comparison(comparison, variable_domains, MAX_PROPOSITIONS)
        return separate_steps(comparison, variable_domains, MAX_PROPOSITIONS)
    except TooManyValuesError:
        raise TooLargeError from None


def _print_comparison(comparison: Formula) -> str:
    """Return a comparison about one step as a proposition of SPIN's language, with its operators.

    That a variable has no value is the negated proposition that it has the value.
    """
    match comparison:
        case Apply(Op.NE, (Var(_, is_primed) as variable, Const() as value)):
            text = _print_comparison(f.eq(variable, value))
            return f"!({text})" if is_primed else f"!{text}"
        case _:
            text = _EXPRESSIONS.print(comparison)
            is_primed = any(variable.primed for variable in f.variables(comparison))
            return f"X {{{text}}}" if is_primed else f"{{{text}}}"


def _print_variable(variable: Var) -> str:
    """Return the proposition that a Boolean is true."""
    # Names of SPIN's propositions begin with a small letter.
    is_name = _SPIN_NAME.fullmatch(variable.name)
    text = variable.name if is_name else f"{{{variable.name}==1}}"
    return f"X {text}" if variable.primed else text


# -- claims about a model ------------------------------------------------------------------------

KEYWORDS = C_WORDS.union(
    re.findall(
        r"\w+",
        # Promela.
        "active assert atomic bit bool break byte chan c_code c_decl c_expr c_state c_track "
        "d_proctype d_step do else empty enabled end eval false fi for full get_priority goto "
        "hidden if in init inline int len local ltl mtype nempty never nfull notrace np_ od "
        "of pc_value pid print printf printm priority proctype provided return run select "
        "set_priority short show skip timeout trace true typedef unless unsigned xr xs always "
        "eventually until weakuntil stronguntil release implies equivalent next _ _last "
        "_nr_pr _pid _priority "
        # Names of the verifier, a program in C that has a structure with the variables.
        "final getframe iam_alive max maxseq0 maxseq1 maxseq2 minseq0 minseq1 minseq2 mix "
        "onstack_put onstack_zap pthread_equal q_sz rand rot ulong ushort wasnew uchar uint",
    )
)
"""Words that cannot be names of variables in Promela, and so in its verifier, a program in C."""
_SAMPLED = {
    Op.NOT: "(!{})",
    Op.ALWAYS: "([] (step -> {}))",
    Op.EVENTUALLY: "(<> (step && {}))",
    Op.UNTIL: "((step -> {}) U (step && {}))",
    Op.WEAK_UNTIL: "((step -> {}) W (step && {}))",
    Op.RELEASE: "((step && {}) V (step -> {}))",
}
"""Operators about the states in which ``step`` is true."""


def sample_start(formula: Formula, print_condition: Callable[[Formula], str]) -> str:
    """Return a formula about the next step as one about the states of a model of ``promela``.

    ``step`` is true once in each round of the model, and false in the state where the result holds,
    such as the first one. *print_condition* prints formulas about one step and the next.
    """
    match formula:
        case Apply(Op.IMPLIES | Op.IFF | Op.AND | Op.OR as op, args) if f.has_future(formula):
            texts = (sample_start(arg, print_condition) for arg in args)
            return f"({f' {_INFIX[op]} '.join(texts)})"
        case Apply(Op.NOT, (operand,)) if f.has_future(formula):
            return f"(!{sample_start(operand, print_condition)})"
        case Apply(op) if op in _SAMPLED and f.has_future(formula):
            # No state before the step matters to these operators.
            return _sample(formula, print_condition)
        case _:
            return f"((!step) U (step && {_sample(formula, print_condition)}))"


def _sample(formula: Formula, print_condition: Callable[[Formula], str]) -> str:
    """Return a formula about steps, for a state in which ``step`` is true."""
    if not isinstance(formula, Apply) or not f.has_future(formula):
        return f"({print_condition(formula)})"
    if formula.op is Op.NEXT:
        return f"(step U (!step && {sample_start(formula.args[0], print_condition)}))"
    texts = [_sample(arg, print_condition) for arg in formula.args]
    template = _SAMPLED.get(formula.op)
    return template.format(*texts) if template else f"({f' {_INFIX[formula.op]} '.join(texts)})"
