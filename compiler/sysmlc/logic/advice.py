"""Advice for formulas that other languages write differently: the nearest form that can be read."""

import re

_BOUND = "write 'always if P then Q holds within 5 steps' with the language 'pattern'"
_CALLS = (
    (r"(?:done|ended|completed|terminated)\s*\(", "write 'finished(P)' where an action ends"),
    (r"(?:active|executing|performing|runs)\s*\(", "write 'running(P)' while an action runs"),
    (r"(?:received?|accept(?:s|ed)?|occurs|sent)\b", "write 'event=P' for an event that occurs"),
    (r"in\s*\(", "write 'state=P' for an active state"),
)
"""Functions and words of other languages that are about actions, events and states."""
_ADVICE = (
    *_CALLS,
    (r"is\s+always\b", "write 'P always holds'"),
    (r"is\s+never\b", "write 'P never holds'"),
    (r"is\b", "write '=' for 'is'"),
    (r"<(?<==<)", "write '<=' for '=<'"),
    (r"=(?<=/=)", "write '!=' for '/='"),
    (r"[\w.]+\s*<>", "write '!=' for '<>', which means 'eventually'"),
    (r":\s*=|:", "write '=' for ':='"),
    (r"xor\b|\^(?!\s*\d)", "write 'P != Q' for one of two conditions"),
    (r"\^|\[\s*\d|<=?\s*\d+\s+\w", f"write 'X' for each step, or {_BOUND}"),
    (r"within\b", _BOUND),
    (r"be\b", "write 'shall always satisfy P' or 'shall eventually satisfy P'"),
    (r"never\b", "write 'G !(P)'"),
    (r"(?:AG|AF|AX|AU)\b", "formulas are about all runs: write 'G', 'F', 'X' or 'U' without 'A'"),
    (r"(?:EG|EF|EX|EU)\b", "formulas are about all runs: none can say that some run exists"),
    (r"only\b", "write 'P -> Q' for 'P only if Q'"),
    (r"if\b", "write 'P -> Q' for 'if P then Q'"),
    (r"(?:whenever|when|upon)\b", "write 'G (P -> Q)' for 'whenever P, Q'"),
    (r"infinitely\b", "write 'G F P'"),
    (r"unless\b", "write 'P W Q' for 'P unless Q'"),
    (r"before\b", "write 'P precedes Q' with the language 'pattern'"),
    (r"after\b", "write 'after Q, P always holds' with the language 'pattern'"),
    (r"follows\b", "write 'P responds to Q'"),
    (r"between\b", "write 'a <= x & x <= b'"),
    (r"mode\b", "write 'in P mode' at the start of the sentence"),
    (r"(?:else|otherwise)\b", "write '(P -> Q) & (!P -> R)' for 'if P then Q else R'"),
    (r"then\b", "write 'P -> Q' for 'if P then Q'"),
    (r"in\b", "write 'state=A | state=B', one comparison for each value"),
    (r"\?", "write '(P -> Q) & (!P -> R)' for 'P ? Q : R'"),
    (r"(?:forall|exists|∀|∃)", "write the condition once for each part, joined by '&' or '|'"),
    (r"'(?<=\)')", "write 'X (P)' for the next value of a condition"),
    (r";", "remove the ';'"),
    (r"[\"']", "write names and values without quotation marks"),
    (r"\.\s*\d", "write whole numbers, in a smaller unit if need be"),
    (r"<|<=|>|>=|==?", "write 'a < b & b < c' for 'a < b < c'"),
)
"""Regular expressions for the text at a fault, with the advice; the first match counts."""
_ENTRIES = tuple((re.compile(pattern, re.IGNORECASE), advice) for pattern, advice in _ADVICE)


def suggest_form(text: str, offset: int) -> str:
    """Return advice on what is written at the offset of a fault; empty if there is none."""
    return next((advice for pattern, advice in _ENTRIES if pattern.match(text, offset)), "")


def is_foreign_call(text: str, offset: int) -> bool:
    """Whether a function of another language stands at the offset, which is no mistyped name."""
    return any(re.compile(call, re.IGNORECASE).match(text, offset) for call, _ in _CALLS)
