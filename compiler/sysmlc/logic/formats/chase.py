"""CHASE's .ltl: contracts with typed inputs and outputs, LTL assumptions and guarantees.

Source: demos and grammar of chase-cps/chase. Real numbers and probabilities are reported as not
supported.
"""

import re
from collections.abc import Callable, Iterator, Mapping

from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Domain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formats.draft import ContractDraft, SpecificationFile, read_conjuncts
from sysmlc.logic.formats.encodings import encode_as_integers
from sysmlc.logic.formats.lowering import eliminate_weak_until, rename_reserved, rewrite_conjuncts
from sysmlc.logic.formats.writing import (
    LTL_WORDS,
    Notation,
    add_prime,
    apply_lowering,
    convert_to_word,
)
from sysmlc.logic.formula import Op
from sysmlc.logic.infix import BOOLEAN, FormulaReader, Term
from sysmlc.logic.syntax import (
    ARITHMETIC_SIGNS,
    BOOLEANS,
    COMPARISON_SIGNS,
    CONNECTIVE_SIGNS,
    PRECEDENCE,
    TEMPORAL_SIGNS,
    TEMPORAL_WORDS,
    UNTIL_WORDS,
    Cursor,
    FormulaError,
    Syntax,
    Token,
    tokenize,
)

SYNTAX = Syntax(
    {"!": Op.NOT, "~": Op.NOT, **TEMPORAL_WORDS, **TEMPORAL_SIGNS},
    {
        **CONNECTIVE_SIGNS,
        "/\\": Op.AND,
        "\\/": Op.OR,
        **UNTIL_WORDS,
        **COMPARISON_SIGNS,
        **ARITHMETIC_SIGNS,
    },
    BOOLEANS,
    {"(": ")"},
    PRECEDENCE,
    signs=(":", ";"),
    comment=r"\#[^\n]*",
)
_BOX_WITH_BLANKS = re.compile(r"\[[ \t]+\]")
_OWNERS = {"input": Owner.ENVIRONMENT, "output": Owner.SYSTEM}
_SIDES = {"Assumptions": Owner.ENVIRONMENT, "Guarantees": Owner.SYSTEM}
_RESERVED = frozenset(
    {*SYNTAX.prefix, *SYNTAX.infix, *BOOLEANS, *_OWNERS, *_SIDES, "P", "NAME", "CONTRACT", "is"}
    | {"boolean", "integer", "real", "variable", "proposition"}
)


# -- reading ---------------------------------------------------------------------------------------


def read(file: SpecificationFile) -> tuple[Contract, ...]:
    """Return the contracts of the file without those for which a fault was reported."""
    # CHASE allows blanks in the box of "always". Offsets must stay, so the box moves to the left.
    text = _BOX_WITH_BLANKS.sub(lambda match: f"[]{' ' * (len(match.group()) - 2)}", file.text)
    cursor = Cursor(tokenize(text, SYNTAX))
    names: list[str] = []
    ContractDraft(file, "CHASE").read_statement(
        cursor, lambda: names.append(_read_system_name(cursor)), ";"
    )
    contracts: list[Contract] = []
    while not cursor.is_at_end:
        reader = _ContractReader(ContractDraft(file, "CHASE"), cursor)
        contracts.extend(reader.read(names[0] if names else ""))
    return tuple(contracts)


def _read_system_name(cursor: Cursor) -> str:
    cursor.expect("NAME")
    cursor.expect(":")
    name = cursor.expect_kind("name", "a name").text
    cursor.expect(";")
    return name


def _read_contract_name(cursor: Cursor) -> str:
    cursor.expect("CONTRACT")
    name = cursor.expect_kind("name", "a name").text
    cursor.expect(":")
    return name


class _ContractReader:
    """Reads one contract, from ``CONTRACT`` to the next."""

    def __init__(self, draft: ContractDraft, cursor: Cursor) -> None:
        self._draft = draft
        self._cursor = cursor
        self._owner = Owner.SYSTEM
        self._propositions: dict[str, Term] = {}

    def read(self, system: str) -> tuple[Contract, ...]:
        """Return the contract, or nothing if a fault was reported."""
        names: list[str] = []
        self._read_statement(lambda: names.append(_read_contract_name(self._cursor)))
        while not self._cursor.is_at_end and not self._cursor.is_next("CONTRACT"):
            self._read_statement(self._read_part)
        parts = (system, *names) if names != [system] else names
        return self._draft.build(".".join(filter(None, parts)))

    def _read_statement(self, read: Callable[[], None]) -> None:
        self._draft.read_statement(self._cursor, read, ";")

    def _read_part(self) -> None:
        cursor = self._cursor
        if cursor.is_next(*_SIDES):
            self._owner = _SIDES[cursor.take().text]
            cursor.expect(":")
        elif cursor.is_next(*_OWNERS):
            self._read_declaration()
        elif cursor.accept("proposition"):
            self._read_proposition()
        else:
            self._read_conjuncts()

    def _read_declaration(self) -> None:
        owner = _OWNERS[self._cursor.take().text]
        type_ = self._cursor.expect("boolean", "integer", "real")
        domain: Domain = BooleanDomain()
        if type_.text == "real":
            self._draft.report_outside(type_.offset, "a variable that is a real number")
        elif type_.text == "integer":
            domain = self._read_range()
        self._cursor.expect("variable")
        name = self._cursor.expect_kind("name", "a name")
        self._cursor.expect(";")
        self._draft.declare(name.text, name.offset, owner, domain)

    def _read_range(self) -> Domain:
        offset = self._cursor.expect("(").offset
        low = self._cursor.read_integer()
        self._cursor.expect(":")
        high = self._cursor.read_integer()
        self._cursor.expect(")")
        if low > high:
            raise FormulaError(f"the range {low}:{high} is empty", offset)
        return IntegerDomain(low, high)

    def _create_reader(self) -> "_ChaseReader":
        return _ChaseReader(self._cursor, self._draft.domains, self._propositions)

    def _read_proposition(self) -> None:
        name = self._cursor.expect_kind("name", "a name")
        self._cursor.expect("is")
        offset = self._cursor.next.offset
        condition = self._create_reader().read_formula()
        self._propositions[name.text] = Term(condition, BOOLEAN, offset)
        self._cursor.expect(";")

    def _read_conjuncts(self) -> None:
        def read() -> None:
            conjuncts = list(read_conjuncts(self._create_reader(), SYNTAX, ";"))
            if not self._cursor.is_next(";"):
                self._cursor.fail("';' is expected")
            for formula, offset in conjuncts:
                self._draft.add_ltl(self._owner, formula, offset)

        if not self._draft.read_formula(self._owner, Class.OTHER, read):
            self._cursor.skip_to(";")
        self._cursor.accept(";")


class _ChaseReader(FormulaReader):
    """Reads formulas in which names of propositions stand for the terms that define them."""

    def __init__(
        self,
        cursor: Cursor,
        variables: Mapping[str, Domain],
        propositions: Mapping[str, Term],
    ) -> None:
        super().__init__(cursor, SYNTAX, variables)
        self._propositions = propositions

    def resolve_name(self, token: Token) -> Term:
        if token.text in self._propositions:
            return self._propositions[token.text]
        if token.text == "P" and self.cursor.is_next("("):
            raise FormulaError("probabilities are not supported", token.offset)
        return super().resolve_name(token)


# -- writing ---------------------------------------------------------------------------------------


_NOTATION = Notation(LTL_WORDS | {Op.DIV: "/"}, add_prime, format_name="CHASE")


def lower(contract: Contract, format_name: str) -> Contract:
    """Return the contract without enumerations and weak until. Raises NotExpressibleError."""
    lowered = rewrite_conjuncts(rename_reserved(contract, _RESERVED), eliminate_weak_until)
    return apply_lowering(
        lowered,
        format_name,
        lambda contract: encode_as_integers(contract, is_flat=False, from_zero=False),
    )


def write(contract: Contract, format_name: str) -> str:
    """Return the contract as text. Raises NotExpressibleError."""
    lowered = lower(contract, format_name)
    system, _, name = contract.component.rpartition(".")
    lines = [
        f"NAME: {convert_to_word(system or name)};\n",
        f"CONTRACT {convert_to_word(name)}:",
        *(f"    {_print_declaration(variable)}" for variable in lowered.variables),
        "\n    Assumptions:",
        *_iter_lines(lowered.assumptions),
        "\n    Guarantees:",
        *_iter_lines(lowered.guarantees),
    ]
    return "\n".join([*lines, ""])


def _print_declaration(variable: Variable) -> str:
    direction = "input" if variable.owner is Owner.ENVIRONMENT else "output"
    type_ = "boolean"
    if isinstance(variable.domain, IntegerDomain):
        type_ = f"integer ({variable.domain.low}:{variable.domain.high})"
    return f"{direction} {type_} variable {variable.name};"


def _iter_lines(conjuncts: tuple[Conjunct, ...]) -> Iterator[str]:
    # The grammar of CHASE demands a formula in each section.
    for conjunct in conjuncts or (Conjunct(f.TRUE, Class.INIT, ""),):
        yield f"        {_NOTATION.print_ltl_conjunct(conjunct)};"
