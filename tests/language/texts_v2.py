"""Texts in KerML and SysML v2, their trees as lines and what is said about them."""

from v2_trees import outline

from sysmlc.diagnostics import Sink
from sysmlc.language.text import parse


def understood(text, language="sysml"):
    """The outline of a text about which nothing is said."""
    tree, said = parsed(text, language)
    assert said == []
    return tree


def parsed(text, language="sysml"):
    """The outline of a text, and what is said: line:column, code, message."""
    sink = Sink()
    document = parse(text, "m.sysml", language, sink)
    return outline(document.root), [f"{_place(text, one)} {_message(one)}" for one in sink]


def said(text, language="sysml"):
    """What is said about a text."""
    return parsed(text, language)[1]


def advised(text, language="sysml"):
    """The advice given about a text."""
    sink = Sink()
    parse(text, "m.sysml", language, sink)
    return [one.help for one in sink]


def _place(text, found):
    before = text.encode()[: found.subject.place.offset].decode()
    return f"{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"


def _message(found):
    return f"{found.rule.code} {found.message}"
