"""Our templates as functions of Python: ``python -m sysmlc.backends.translate``.

To import jinja2 and to fill in its templates takes a twentieth of the compilation of a small model.
The templates stay what people change and read; a test holds that the functions are up to date, and
that both give the same texts.
"""

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from jinja2 import Environment, nodes

from sysmlc.backends.templates import OPTIONS
from sysmlc.resources import path

FOLDERS = {"plantuml": ("diagram", "view", "header"), "contracts": ("page",)}
"""Folders of templates whose functions are kept, and what their templates are filled in with."""

_HEAD = '''"""Texts of {folder}, as its templates say.

Generated from templates/{folder} by ``python -m sysmlc.backends.translate``; do not edit.
"""

# fmt: off
# ruff: noqa: ANN401, C901, E501, PLR0912, RUF100

from collections.abc import Callable
from typing import Any
'''
_OPERATORS = {"eq": "==", "ne": "!=", "gt": ">", "lt": "<", "in": "in", "notin": "not in"}


def module_of(folder: str) -> str:
    """Text of the module with a function for each template of the folder."""
    environment = Environment(**OPTIONS)
    lines, table = [_HEAD.format(folder=folder)], []
    for file in sorted(path("templates", folder).glob("*.j2")):
        text = environment.parse(file.read_text(encoding="utf-8"))
        body = _block(text.body, "    ", _Names(FOLDERS[folder]))
        lines += ["", _signature(_word(file.name), FOLDERS[folder]), *body, ""]
        if not file.name.startswith("_"):
            table.append(f'    "{file.name}": {_word(file.name)},')
    return "\n".join([*lines, "", "TEXTS: dict[str, Callable[..., str]] = {", *table, "}", ""])


class _Names(NamedTuple):
    """Names of values that templates are filled in with, and of loops that call themselves."""

    values: tuple[str, ...]
    loops: tuple[str, ...] = ()


def _word(name: str) -> str:
    return "_" + name.lstrip("_").removesuffix(".j2").replace(".", "_")


def _signature(name: str, parameters: Iterable[str]) -> str:
    return f"def {name}({', '.join(f'{one}: Any' for one in parameters)}) -> str:"


def _block(body: Iterable[nodes.Node], indent: str, names: _Names) -> Iterator[str]:
    """Body of a function that puts a text together."""
    yield f"{indent}made: list[str] = []"
    yield f"{indent}add = made.append"
    yield from _statements(body, indent, names)
    yield f'{indent}return "".join(made)'


def _statements(body: Iterable[nodes.Node], indent: str, names: _Names) -> Iterator[str]:
    inner = f"{indent}    "
    for node in body:
        match node:
            case nodes.Output():
                yield from _output(node, indent, names)
            case nodes.If():
                yield f"{indent}if {_expression(node.test, names)}:"
                yield from _statements(node.body, inner, names)
                for other in node.elif_:
                    yield f"{indent}elif {_expression(other.test, names)}:"
                    yield from _statements(other.body, inner, names)
                if node.else_:
                    yield f"{indent}else:"
                    yield from _statements(node.else_, inner, names)
            case nodes.For():
                yield from _loop(node, indent, names)
            case nodes.Include(template=nodes.Const(value=name)):
                yield f"{indent}add({_word(name)}({', '.join(names.values)}))"
            case nodes.Macro():
                yield indent + _signature(node.name, [one.name for one in node.args])
                yield from _block(node.body, inner, names)
            case _:
                raise NotImplementedError(f"{type(node).__name__} in line {node.lineno}")


def _loop(node: nodes.For, indent: str, names: _Names) -> Iterator[str]:
    inner, items = f"{indent}    ", _expression(node.iter, names)
    target = _expression(node.target, names)
    if node.recursive:
        own = f"loop{len(names.loops)}"
        yield f"{indent}def {own}(items: Any) -> str:"
        each = nodes.For(node.target, nodes.Name("items", "load"), node.body, [], None, False)
        yield from _block([each], inner, names._replace(loops=(*names.loops, own)))
        yield f"{indent}add({own}({items}))"
        return
    yield f"{indent}for {target} in {items}:"
    yield from _statements(node.body, inner, names)
    if node.else_:
        yield f"{indent}if not {items}:"
        yield from _statements(node.else_, inner, names)


def _output(node: nodes.Output, indent: str, names: _Names) -> Iterator[str]:
    """One call for texts and plain values, in a line of code for each line of text."""
    pieces = [_piece(one, names) for one in node.nodes]
    written = "".join(pieces).splitlines(keepends=True)
    if len(written) == 1:
        yield f"{indent}add({_literal(written[0])})"
        return
    yield f"{indent}add("
    yield from (f"{indent}    {_literal(one)}" for one in written)
    yield f"{indent})"


def _literal(text: str) -> str:
    text = text.replace("\n", "\\n")
    if "{" in text.replace("{{", ""):
        return f'f"{text}"'
    return f'"{text.replace("{{", "{").replace("}}", "}")}"'


def _piece(node: nodes.Expr, names: _Names) -> str:
    """Part of an f-string in double quotes."""
    if isinstance(node, nodes.TemplateData):
        text = node.data.replace("\\", "\\\\").replace('"', '\\"')
        return text.replace("{", "{{").replace("}", "}}")
    return f"{{{_expression(node, names)}}}"


def _expression(node: nodes.Node, names: _Names) -> str:
    """The expression in Python, with single quotes."""
    match node:
        case nodes.Name():
            return names.loops[-1] if node.name == "loop" else str(node.name)
        case nodes.Const():
            return repr(node.value)
        case nodes.Getattr():
            return f"{_expression(node.node, names)}.{node.attr}"
        case nodes.Call():
            return f"{_expression(node.node, names)}({_listed(node.args, names)})"
        case nodes.List() | nodes.Tuple():
            return f"({_listed(node.items, names)},)"
        case _:
            return _operation(node, names)


def _listed(items: Iterable[nodes.Node], names: _Names) -> str:
    return ", ".join(_expression(one, names) for one in items)


def _operation(node: nodes.Node, names: _Names) -> str:
    def of(one: nodes.Node) -> str:
        return _expression(one, names)

    match node:
        case nodes.And() | nodes.Or():
            word = "and" if isinstance(node, nodes.And) else "or"
            return f"({of(node.left)} {word} {of(node.right)})"
        case nodes.Not():
            return f"not {of(node.node)}"
        case nodes.Compare(ops=[one]):
            return f"{of(node.expr)} {_OPERATORS[one.op]} {of(one.expr)}"
        case nodes.CondExpr():
            other = "''" if node.expr2 is None else of(node.expr2)
            return f"{of(node.expr1)} if {of(node.test)} else {other}"
        case nodes.Filter(name="join", node=nodes.Node() as joined):
            return f"{of(node.args[0])}.join({of(joined)})"
        case _:
            raise NotImplementedError(f"{type(node).__name__} in line {node.lineno}")


def target(folder: str) -> Path:
    """The module that is generated."""
    return Path(__file__).parent / folder / "written.py"


if __name__ == "__main__":
    for one in FOLDERS:
        target(one).write_text(module_of(one), encoding="utf-8")
