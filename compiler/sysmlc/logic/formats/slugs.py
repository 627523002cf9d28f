"""Both formats of slugs: lines below ``[INPUT]``, ``[SYS_TRANS]`` and other sections.

Structured slugs has ranges, and formulas in infix notation with sums; slugsin has Booleans, and
formulas in prefix notation (``& a | ! b c'``), where ``$ n`` and ``? i`` share subformulas:
``$ n`` stores the n formulas that follow it in a list. Each formula may refer to the i-th entry of
the list as ``? i`` if that precedes it; the value of ``$ n`` is the last formula. The reader
accepts both kinds of lines in both formats.

Source: slugs' doc/input_formats.md, examples and tools/StructuredSlugsParser, which takes every
line that is not in prefix notation for infix notation.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import PurePath

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
from sysmlc.logic.formats.draft import ContractDraft, SpecificationFile
from sysmlc.logic.formats.encodings import encode_as_bits, encode_as_integers
from sysmlc.logic.formats.lowering import (
    flatten_atom,
    index_domains,
    rename_reserved,
    rewrite_conjuncts,
    rewrite_contract_atoms,
)
from sysmlc.logic.formats.writing import (
    LTL_WORDS,
    Notation,
    add_prime,
    apply_lowering,
    conjuncts_of,
    reduce_to_gr1,
)
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var
from sysmlc.logic.infix import BOOLEAN, MAX_DEPTH, FormulaReader, Term
from sysmlc.logic.simplification import rebuild
from sysmlc.logic.syntax import (
    BOOLEANS,
    COMPARISON_SIGNS,
    CONNECTIVE_SIGNS,
    PRECEDENCE,
    Cursor,
    FormulaError,
    Syntax,
    tokenize,
)
from sysmlc.support.interpreter import allow_recursion

_CHAINS = {"&": f.both, "|": f.either}
_MAX_INDEX_DIGITS = 6


class PrefixError(ValueError):
    """A line that is not a formula in prefix notation."""


def parse_prefix(line: str, domains: Mapping[str, Domain]) -> Formula:
    """Parse a formula over Boolean variables. Raises PrefixError."""
    reader = _PrefixReader(line.split(), domains)
    with allow_recursion(MAX_DEPTH):
        formula = reader.read_formula(0)
    if reader.has_more():
        raise PrefixError
    return formula


class _PrefixReader:
    """Reads from the words of a line."""

    def __init__(self, words: list[str], domains: Mapping[str, Domain]) -> None:
        self._words = words
        self._index = 0
        self._domains = domains
        self._memory: list[Formula] = []

    def has_more(self) -> bool:
        return self._index < len(self._words)

    def _peek(self) -> str:
        if not self.has_more():
            raise PrefixError
        return self._words[self._index]

    def _take(self) -> str:
        word = self._peek()
        self._index += 1
        return word

    def read_formula(self, depth: int) -> Formula:
        if depth > MAX_DEPTH:
            raise PrefixError
        word = self._take()
        if word in _CHAINS:
            return self._read_chain(word, depth)
        if word == "^":
            left, right = self.read_formula(depth + 1), self.read_formula(depth + 1)
            return f.negate(f.iff(left, right))
        if word == "!":
            return f.negate(self.read_formula(depth + 1))
        if word == "$":
            return self._read_memory(depth)
        if word == "?":
            return self._read_reference()
        return self._read_atom(word)

    def _read_chain(self, word: str, depth: int) -> Formula:
        """Read all operands of nested operators of one kind: one more than there are operators."""
        # A conjunction of n operands nests n - 1 operators; recursion would exceed MAX_DEPTH.
        operands: list[Formula] = []
        operators = 1
        while len(operands) <= operators:
            if self._peek() == word:
                self._take()
                operators += 1
            else:
                operands.append(self.read_formula(depth + 1))
        return _CHAINS[word](*operands)

    def _read_memory(self, depth: int) -> Formula:
        """Read ``$ n`` and its formulas, which cannot refer to entries of an enclosing ``$``."""
        count = self._read_index()
        outer, self._memory = self._memory, []
        for _ in range(count):
            self._memory.append(self.read_formula(depth + 1))
        value = self._memory[-1] if self._memory else f.TRUE
        self._memory = outer
        return value

    def _read_reference(self) -> Formula:
        index = self._read_index()
        if index >= len(self._memory):
            raise PrefixError
        return self._memory[index]

    def _read_index(self) -> int:
        number = self._take()
        if not number.isdecimal() or len(number) > _MAX_INDEX_DIGITS:
            raise PrefixError
        return int(number)

    def _read_atom(self, word: str) -> Formula:
        if word in ("0", "1"):
            return Const(word == "1")
        name = word.removesuffix("'")
        if not isinstance(self._domains.get(name), BooleanDomain):
            raise PrefixError
        return Var(name, word != name)


def eliminate_implications(formula: Formula) -> Formula:
    """Replace ``a -> b`` by ``!a | b``: prefix notation has no implication."""
    match formula:
        case Apply(Op.IMPLIES, (left, right)):
            left, right = eliminate_implications(left), eliminate_implications(right)
            return f.either(f.negate(left), right)
        case Apply(op, args):
            return rebuild(op, tuple(map(eliminate_implications, args)))
        case _:
            return formula


def print_prefix(formula: Formula) -> str:
    """Return a formula over Booleans without implications in prefix notation."""
    match formula:
        case Const(value):
            return "1" if value else "0"
        case Var(name, primed):
            return f"{name}'" if primed else name
        case Apply(op, args):
            return _print_operator(op, [print_prefix(arg) for arg in args])


def _print_operator(op: Op, operands: list[str]) -> str:
    match op:
        case Op.NOT:
            return f"! {operands[0]}"
        case Op.IFF:
            return f"! ^ {operands[0]} {operands[1]}"
        case _:
            return f"{f'{op} ' * (len(operands) - 1)}{' '.join(operands)}"


# -- formats ---------------------------------------------------------------------------------------


SYNTAX = Syntax(
    {"!": Op.NOT},
    {**CONNECTIVE_SIGNS, **COMPARISON_SIGNS, "+": Op.ADD},
    BOOLEANS,
    {"(": ")"},
    PRECEDENCE,
    signs=("^", "-"),
)
_DECLARATIONS = {"INPUT": Owner.ENVIRONMENT, "OUTPUT": Owner.SYSTEM}
_SECTIONS = {
    "ENV_INIT": (Owner.ENVIRONMENT, Class.INIT),
    "SYS_INIT": (Owner.SYSTEM, Class.INIT),
    "ENV_TRANS": (Owner.ENVIRONMENT, Class.SAFETY),
    "SYS_TRANS": (Owner.SYSTEM, Class.SAFETY),
    "ENV_LIVENESS": (Owner.ENVIRONMENT, Class.LIVENESS),
    "SYS_LIVENESS": (Owner.SYSTEM, Class.LIVENESS),
}
_SECTION_TITLE = re.compile(r"\[(\w+)\]$")
_DECLARATION = re.compile(r"([^\W\d]\w*)(?:\s*:\s*(-?\d+)\s*\.\.\.\s*(-?\d+))?$")
_MAX_BOUND_LENGTH = 18
_SIGN_IN_NAME = re.compile(r"(?<=\w)[.@](?=\w)")
"""The bits that slugs makes of ranges are called ``x@0.0.7``."""


# -- reading ---------------------------------------------------------------------------------------


def read(file: SpecificationFile) -> tuple[Contract, ...]:
    """Return the contract, named after the file, or nothing if a fault was reported."""
    draft = ContractDraft(file, "slugs")
    section = ""
    # Names with "@" and "." are no identifiers in the other formats.
    for offset, line in _iter_lines(_SIGN_IN_NAME.sub("_", file.text)):
        title = _SECTION_TITLE.match(line)
        if title:
            section = _read_title(draft, title.group(1), offset)
        elif section in _DECLARATIONS:
            _read_declaration(draft, line, offset, _DECLARATIONS[section])
        elif section in _SECTIONS:
            _read_conjunct(draft, line, offset, *_SECTIONS[section])
        elif not draft.is_broken:
            draft.report_not_understood(offset, "it is below no [SECTION]")
    return draft.build(PurePath(file.path).stem)


def _iter_lines(text: str) -> Iterator[tuple[int, str]]:
    """Yield the lines that are not empty, without comments and indentation, with their offsets."""
    offset = 0
    for line in text.split("\n"):
        content = line.partition("#")[0]
        if content.strip():
            yield offset + len(content) - len(content.lstrip()), content.strip()
        offset += len(line) + 1


def _read_title(draft: ContractDraft, title: str, offset: int) -> str:
    """Return the title of a section; report an unknown one and return an empty text."""
    if title in _DECLARATIONS or title in _SECTIONS:
        return title
    titles = ", ".join([*_DECLARATIONS, *_SECTIONS])
    draft.report_not_understood(offset, f"[{title}] is not a section; the sections are {titles}")
    return ""


def _read_declaration(draft: ContractDraft, line: str, offset: int, owner: Owner) -> None:
    declaration = _DECLARATION.match(line)
    if declaration is None:
        reason = f"'{line}' is neither a name nor a name with a range (x:0...7)"
        draft.report_not_understood(offset, reason)
        return
    name, low, high = declaration.groups()
    if low is None:
        draft.declare(name, offset, owner, BooleanDomain())
    elif max(len(low), len(high)) > _MAX_BOUND_LENGTH or int(low) > int(high):
        draft.report_not_understood(offset, f"the range of '{name}' is empty or too large")
    else:
        draft.declare(name, offset, owner, IntegerDomain(int(low), int(high)))


def _read_conjunct(
    draft: ContractDraft, line: str, offset: int, owner: Owner, class_: Class
) -> None:
    def read() -> None:
        draft.add(owner, class_, _parse_line(draft, line, offset), offset)

    draft.read_formula(owner, class_, read)


def _parse_line(draft: ContractDraft, line: str, offset: int) -> Formula:
    """Parse a line in prefix notation, or else in infix notation. Raises FormulaError."""
    try:
        return parse_prefix(line, draft.domains)
    except PrefixError:
        pass
    try:
        reader = _SlugsReader(Cursor(tokenize(line, SYNTAX)), SYNTAX, draft.domains)
        formula = reader.read_formula()
        reader.cursor.expect_end()
    except FormulaError as error:
        raise FormulaError(str(error), offset + error.offset) from None
    return formula


class _SlugsReader(FormulaReader):
    """Reads ``a ^ b`` as exclusive or, and 0 and 1 as Booleans where a Boolean is required."""

    def require_boolean(self, term: Term) -> Formula:
        if isinstance(term.formula, Const) and term.formula.value in (0, 1):
            return Const(bool(term.formula.value))
        return super().require_boolean(term)

    def read_term(self, min_precedence: int) -> Term:
        term = super().read_term(min_precedence)
        while min_precedence <= PRECEDENCE[Op.OR] and self.cursor.accept("^"):
            right = super().read_term(PRECEDENCE[Op.OR] + 1)
            equivalence = f.iff(self.require_boolean(term), self.require_boolean(right))
            term = Term(f.negate(equivalence), BOOLEAN, term.offset)
        return term


# -- writing ---------------------------------------------------------------------------------------


def _print_literal(value: Literal) -> str:
    return {True: "TRUE", False: "FALSE"}[value] if isinstance(value, bool) else str(value)


_NOTATION = Notation(LTL_WORDS, add_prime, _print_literal, "structured")


def lower(contract: Contract, format_name: str) -> Contract:
    """Return the contract in GR(1), over Booleans for slugsin, over integers for structured slugs.

    Raises NotExpressibleError.
    """
    game = reduce_to_gr1(contract, format_name, allow_primed_liveness=True)
    if format_name == "slugsin":
        return apply_lowering(
            game,
            format_name,
            lambda contract: rewrite_conjuncts(encode_as_bits(contract), eliminate_implications),
        )
    return apply_lowering(
        rename_reserved(game, SYNTAX.booleans), format_name, _eliminate_unsupported
    )


def _eliminate_unsupported(contract: Contract) -> Contract:
    """Encode enumerations, and expand comparisons that slugs does not support."""
    encoded = encode_as_integers(contract, is_flat=False)
    domains = index_domains(encoded)
    return rewrite_contract_atoms(
        encoded, lambda atom: atom if _is_supported(atom) else flatten_atom(atom, domains)
    )


def _is_supported(formula: Formula) -> bool:
    """Whether a term is a sum of variables and numbers that are not negative."""
    match formula:
        case Const(value):
            return isinstance(value, int) and value >= 0
        case Apply(op, args):
            return op not in (Op.SUB, Op.MUL, Op.DIV, Op.MOD) and all(map(_is_supported, args))
        case Var():
            return True


def write(contract: Contract, format_name: str) -> str:
    """Return the contract as text. Raises NotExpressibleError."""
    lowered = lower(contract, format_name)
    if format_name == "slugsin":
        return _print_sections(
            lowered,
            lambda variable: variable.name,
            lambda conjunct: print_prefix(conjunct.formula),
        )
    return _print_sections(
        lowered,
        _print_declaration,
        _NOTATION.print_conjunct,
    )


def _print_sections(
    contract: Contract,
    print_declaration: Callable[[Variable], str],
    print_line: Callable[[Conjunct], str],
) -> str:
    sections = []
    for title, owner in _DECLARATIONS.items():
        lines = [
            print_declaration(variable)
            for variable in contract.variables
            if variable.owner is owner
        ]
        sections.append("\n".join([f"[{title}]", *lines, ""]))
    for title, (owner, class_) in _SECTIONS.items():
        lines = [print_line(conjunct) for conjunct in conjuncts_of(contract, owner, class_)]
        sections.append("\n".join([f"[{title}]", *lines, ""]))
    return "\n".join(sections)


def _print_declaration(variable: Variable) -> str:
    if isinstance(variable.domain, IntegerDomain):
        return f"{variable.name}:{variable.domain.low}...{variable.domain.high}"
    return variable.name
