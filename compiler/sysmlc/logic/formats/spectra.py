"""The GR(1) part of Spectra: variables, arrays, defines, predicates, patterns, monitors, counters.

Source: the grammar of the Spectra language (S. Maoz, J. O. Ringert) and its examples. Regular
expressions, triggers and existential guarantees are reported as not supported. Weights are reported
too: they rank strategies, but do not change whether a contract is realizable.
"""

import os
from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise, product
from pathlib import Path

from sysmlc.logic.contract import Contract, Owner
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.draft import SpecificationFile
from sysmlc.logic.formats.spectra_expressions import (
    SYNTAX,
    Array,
    Meaning,
    Parameter,
    SpectraReader,
)
from sysmlc.logic.formats.spectra_statements import Pattern, StatementReader
from sysmlc.logic.infix import Term
from sysmlc.logic.reduction.history import History
from sysmlc.logic.syntax import FormulaError, Token, tokenize
from sysmlc.sources import Roots, SourceError
from sysmlc.sources.files import read_whole
from sysmlc.sources.source import DOCUMENT_LIMITS
from sysmlc.support.counts import count

_OWNERS = {
    **dict.fromkeys(("env", "envvar", "input", "in"), Owner.ENVIRONMENT),
    **dict.fromkeys(("sys", "sysvar", "output", "out", "aux", "auxvar"), Owner.SYSTEM),
}
_SIDES = {
    **dict.fromkeys(("assumption", "asm"), Owner.ENVIRONMENT),
    **dict.fromkeys(("guarantee", "gar"), Owner.SYSTEM),
}
_UNSUPPORTED = ("regexp", "regtest", "separated")
_ENDING = ".spectra"


def read(file: SpecificationFile) -> tuple[Contract, ...]:
    """Return the contract of the file's module, or nothing if a fault was reported.

    An imported file is below the folder of the specification, or below one of ``file.include``. It
    is named from the importing file or from such a folder.
    """
    return _ModuleReader(_append_imports(file)).read()


class _ModuleReader(StatementReader):
    """Reads a module in three rounds: definitions, variables, assumptions and guarantees.

    A name may be used before it is declared. Each round therefore records the positions of texts
    that a later round reads.
    """

    def __init__(self, file: SpecificationFile) -> None:
        super().__init__(file)
        self._variables: list[Callable[[], None]] = []
        """Reads declarations with types in the second round."""
        self._bodies: list[Callable[[], None]] = []
        """Reads the bodies of monitors and counters in the third round."""
        self._statements: list[tuple[Owner, int]] = []
        self._name = ""

    def read(self) -> tuple[Contract, ...]:
        """Return the contract, or nothing if a fault was reported."""
        cursor = self._cursor
        while not cursor.is_at_end:
            self._draft.read_statement(cursor, self._read_element, ";")
        for read_variable in (self._types.check_definitions, *self._variables):
            self._draft.read_statement(cursor, read_variable)
        if self._draft.is_broken:
            return ()
        self._history = History([*self._draft.domains, *self._definitions])
        for read_body in self._bodies:
            self._draft.read_statement(cursor, read_body)
        for owner, mark in self._statements:
            cursor.reset(mark)
            self._read_statement(owner, {}, owner)
        for variable in self._history.variables:
            self._draft.declare(variable.name, 0, Owner.SYSTEM, variable.domain)
        for conjunct in self._history.conjuncts:
            self._draft.add_derived(Owner.SYSTEM, conjunct)
        return self._draft.build(self._name or Path(self._draft.file.path).stem)

    # -- first round: definitions ------------------------------------------------------------------

    def _read_element(self) -> None:
        token = self._cursor.expect_kind("name", "a declaration")
        word = token.text
        if word in ("module", "spec"):
            # The texts of imported modules follow the module itself.
            name = self._cursor.expect_kind("name", "a name").text
            self._name = self._name or name
        elif word == "import":
            self._check_import()
        elif word in _OWNERS:
            owner, mark = _OWNERS[word], self._cursor.mark()
            self._variables.append(lambda: self._read_variable(mark, owner))
            self._cursor.skip_past(";")
        elif word in _SIDES:
            self._statements.append((_SIDES[word], self._cursor.mark()))
            self._cursor.skip_past(";")
        elif word in _ELEMENT_READERS:
            _ELEMENT_READERS[word](self)
        elif word == "weight":
            self._draft.file.report(rules.WEIGHT, token.offset)
            self._cursor.skip_past(";")
        elif word in _UNSUPPORTED:
            self._draft.report_outside(token.offset, f"'{word}'")
            self._cursor.skip_past(";")
        else:
            raise FormulaError(f"'{word}' begins nothing that is known", token.offset)

    def _check_import(self) -> None:
        name = self._cursor.expect_kind("string", "the name of a file")
        self._cursor.accept(";")
        file = self._draft.file
        base = Path(file.locate(name.offset)[0])
        path = _resolve_import(file, base, name.text[1:-1])
        if path is None:
            reason = "is no Spectra file below the folder of the specification or of --include"
            raise FormulaError(f"{name.text} {reason}", name.offset)
        if _read_import(path) is None:
            raise FormulaError(f"{name.text} cannot be read", name.offset)

    def _read_type_definition(self) -> None:
        name = self._cursor.expect_kind("name", "a name")
        self._cursor.expect("=")
        self._types.define(name.text)
        self._cursor.skip_past(";")

    def _read_defines(self) -> None:
        cursor = self._cursor
        while cursor.next.kind == "name" and cursor.after_next.text in (":=", "["):
            name = cursor.take()
            mark = cursor.mark()
            if cursor.is_next("["):
                self._variables.append(partial(self._read_array_definition, name, mark))
            else:
                cursor.take()
                self._define_marks[name.text] = cursor.mark()
                self._define(name, self._create_define_meaning(cursor.mark()))
            cursor.skip_past(";")

    def _read_predicate(self) -> None:
        name = self._cursor.expect_kind("name", "a name")
        mark = self._cursor.mark()
        self._skip_block("(", ")")
        opening = self._cursor.expect(":", "{").text
        body = self._cursor.mark()
        self._variables.append(partial(self._define_predicate, name, mark, body))
        self._cursor.skip_past(";" if opening == ":" else "}")

    def _read_pattern(self) -> None:
        name = self._cursor.expect_kind("name", "a name")
        parameters = self._read_parameters() if self._cursor.is_next("(") else ()
        self._patterns[name.text] = Pattern(parameters, self._skip_block())

    def _skip_block(self, opening: str = "{", closing: str = "}") -> int:
        """Skip a text in brackets, which may contain others, and return where its inside begins."""
        cursor = self._cursor
        cursor.expect(opening)
        inside, depth = cursor.mark(), 1
        while depth and not cursor.is_at_end:
            token = cursor.take()
            depth += (token.text == opening) - (token.text == closing)
        return inside

    def _read_monitor(self) -> None:
        mark = self._cursor.mark()
        if self._cursor.is_next("{"):
            self._skip_block()
        self._cursor.skip_to("{")
        body = self._skip_block()
        self._variables.append(partial(self._declare_monitor, mark))
        self._bodies.append(lambda: self._read_block(body, {}, Owner.SYSTEM, Owner.SYSTEM))

    def _read_counter(self) -> None:
        name = self._cursor.expect_kind("name", "a name")
        self._cursor.expect("(")
        mark = self._cursor.mark()
        self._cursor.skip_to("{")
        body = self._skip_block()
        self._variables.append(partial(self._declare_counter, name, mark, body))

    def _define(self, name: Token, meaning: Meaning) -> None:
        if name.text in self._definitions:
            self._draft.report_fault(rules.DECLARED_TWICE, name.offset, name=name.text)
        self._definitions[name.text] = meaning

    # -- second round: variables -------------------------------------------------------------------

    def _read_variable(self, mark: int, owner: Owner) -> None:
        self._cursor.reset(mark)
        type_ = self._types.read_array_type()
        name = self._cursor.expect_kind("name", "a name")
        self._cursor.expect(";")
        if not type_.dimensions:
            self._draft.declare(name.text, name.offset, owner, type_.domain)
            return
        elements: dict[tuple[int, ...], Meaning] = {}
        for indexes in product(*map(range, type_.dimensions)):
            self._count_expansion(f"the array '{name.text}' is too large", name)
            element = "_".join((name.text, *map(str, indexes)))
            self._draft.declare(element, name.offset, owner, type_.domain)
            elements[indexes] = partial(_read_variable_element, element)
        self._arrays[name.text] = Array(type_.dimensions, elements)

    def _read_array_definition(self, name: Token, mark: int) -> None:
        """Read ``[2] := {a, b};`` behind the name of a define."""
        cursor = self._cursor
        cursor.reset(mark)
        dimensions = self._types.read_dimensions()
        cursor.expect(":=")
        marks: list[int] = []
        while not cursor.is_next(";") and not cursor.is_at_end:
            if not cursor.accept("{", "}", ","):
                marks.append(cursor.mark())
                self._skip_element()
        indexes = list(product(*map(range, dimensions)))
        if len(marks) != len(indexes):
            reason = f"'{name.text}' needs {count(len(indexes), 'value')}, not {len(marks)}"
            raise FormulaError(reason, name.offset)
        meanings = map(self._create_define_meaning, marks)
        self._arrays[name.text] = Array(dimensions, dict(zip(indexes, meanings, strict=True)))

    def _skip_element(self) -> None:
        """Skip an element of a defined array; commas inside of brackets belong to it."""
        cursor, depth = self._cursor, 0
        while not cursor.is_at_end and (depth or not cursor.is_next(",", "}", ";")):
            token = cursor.take()
            depth += (token.text in ("(", "[", "{")) - (token.text in (")", "]", "}"))

    def _define_predicate(self, name: Token, mark: int, body: int) -> None:
        self._cursor.reset(mark)
        self._define(name, self._create_predicate_meaning(body, self._read_parameters()))

    def _read_parameters(self) -> tuple[Parameter, ...]:
        """Read parameters; a type may precede each name."""
        cursor = self._cursor
        cursor.expect("(")
        parameters: list[Parameter] = []
        while not cursor.accept(")"):
            has_type = cursor.after_next.text not in (",", ")")
            is_array = has_type and bool(self._types.read_array_type().dimensions)
            name = cursor.expect_kind("name", "a parameter").text
            parameters.append(Parameter(name, is_array))
            cursor.accept(",")
        return tuple(parameters)

    def _declare_monitor(self, mark: int) -> None:
        self._cursor.reset(mark)
        domain = self._types.read_type()
        name = self._cursor.expect_kind("name", "a name")
        self._draft.declare(name.text, name.offset, Owner.SYSTEM, domain)

    def _declare_counter(self, name: Token, mark: int, body: int) -> None:
        self._cursor.reset(mark)
        domain = self._types.read_range(")")
        self._draft.declare(name.text, name.offset, Owner.SYSTEM, domain)
        self._bodies.append(lambda: self._read_counter_body(body, name, domain))


_ELEMENT_READERS: dict[str, Callable[[_ModuleReader], None]] = {
    "define": _ModuleReader._read_defines,
    "predicate": _ModuleReader._read_predicate,
    "pattern": _ModuleReader._read_pattern,
    "monitor": _ModuleReader._read_monitor,
    "counter": _ModuleReader._read_counter,
    "type": _ModuleReader._read_type_definition,
}


def _read_variable_element(name: str, reader: SpectraReader, token: Token) -> Term:
    """Return an element of an array of variables; this is its ``Meaning``."""
    element = Token("name", name, token.offset)
    return reader.build_variable(element, reader.cursor.accept("'"))


# -- imports -----------------------------------------------------------------------------------


def _append_imports(file: SpecificationFile) -> SpecificationFile:
    """Return the file with the text of all files that it imports, directly or indirectly.

    A file that cannot be read is reported where it is imported, by ``_ModuleReader``.
    """
    first, seen = file, {Path(os.path.realpath(file.path))}
    pending = [(Path(file.path), name) for name in _list_imports(file.text)]
    while pending:
        base, name = pending.pop(0)
        path = _resolve_import(first, base, name)
        text = None if path is None or path in seen else _read_import(path)
        if path is None or text is None:
            continue
        seen.add(path)
        file = file.append(text, _name_import(first, path))
        pending += [(path, name) for name in _list_imports(text)]
    return file


def _list_imports(text: str) -> Iterator[str]:
    tokens = tokenize(text, SYNTAX)
    for word, name in pairwise(tokens):
        if word.text == "import" and name.kind == "string":
            yield name.text[1:-1]


def _list_import_folders(file: SpecificationFile) -> tuple[Path, ...]:
    return (Path(file.path).parent, *file.include)


def _resolve_import(file: SpecificationFile, base: Path, name: str) -> Path | None:
    """Return the Spectra file that *name* means in the file *base*, its links resolved, or None.

    Only Spectra files below the folder of the specification, and below the folders that the user
    named, are opened, because the specification may be untrusted.
    """
    roots = Roots(_list_import_folders(file))
    for start in (base, *(folder / base.name for folder in file.include)):
        path = roots.resolve(start, name)
        if path is not None and path.suffix == _ENDING:
            return path
    return None


def _name_import(file: SpecificationFile, path: Path) -> str:
    """Return the name of an imported file in diagnostics: its path from the folder it is below."""
    for folder in _list_import_folders(file):
        real = os.path.realpath(folder)
        if path.is_relative_to(real):
            return (folder / path.relative_to(real)).as_posix()
    return path.as_posix()


def _read_import(path: Path) -> str | None:
    """Return the text of an imported file, or None if it cannot be read."""
    try:
        return read_whole(path, path.as_posix(), DOCUMENT_LIMITS).decode("utf-8-sig")
    except (SourceError, UnicodeDecodeError):
        return None
