"""Rules about files of contracts and specifications (SM580-SM589)."""

from sysmlc.diagnostics import Severity, rule

_TURN = (
    '{"variables": {"go": {"owner": "env", "type": "bool"}, "n": {"owner": "sys", "type": [0, 3]}},'
    ' "guarantees": {"safety": ["{formula}"]}}'
)

UNKNOWN_FORM = rule(
    "SM580",
    "contract-form-unknown",
    Severity.ERROR,
    "'{file}' is in none of the forms of contracts that are known: {forms}",
    why="The form is seen from the file's ending and from how it begins.",
    help="give the file the ending of its form",
    wrong="x := y;\n",
    right="ENV: x;\nSYS: y;\nSYSGOAL: []<>y;\n",
)
NOT_UNDERSTOOD = rule(
    "SM581",
    "contract-text-fault",
    Severity.ERROR,
    "the {form} text is not understood: {reason}",
    why="What cannot be read would be missing in the contract; so the contract is not read at all.",
    wrong="ENV: x;\nSYS y;\n",
    right="ENV: x;\nSYS: y;\n",
)
WRONG_SHAPE = rule(
    "SM582",
    "contract-shape",
    Severity.ERROR,
    "{what}",
    why="metamodels/sysmlc-contract.schema.json says what a contract in JSON looks like.",
    wrong='{"variables": {"go": {"owner": "me", "type": "bool"}}}',
    right='{"variables": {"go": {"owner": "sys", "type": "bool"}}}',
)
WRONG_FORMULA = rule(
    "SM583",
    "contract-formula-fault",
    Severity.ERROR,
    "the formula among the {section} is not understood: {reason}",
    why="Formulas speak of the variables that the contract declares, each by its own values.",
    wrong=_TURN.replace("{formula}", "go -> m=1"),
    right=_TURN.replace("{formula}", "go -> n=1"),
)
DECLARED_TWICE = rule(
    "SM584",
    "contract-name-twice",
    Severity.ERROR,
    "'{name}' is declared twice",
    why="A variable has one owner and one range.",
    wrong="ENV: x;\nSYS: x;\n",
    right="ENV: x;\nSYS: y;\n",
)
OUTSIDE = rule(
    "SM585",
    "contract-part-outside",
    Severity.ERROR,
    "{what} is outside what is read of {form}",
    why="A contract without it would say something else.",
    wrong="module M\nsys Int(0..3) n;\nregexp r = [n=1]*;\ngar GF n=1;\n",
    right="module M\nsys Int(0..3) n;\ngar GF n=1;\n",
)
WRONG_CLASS = rule(
    "SM586",
    "contract-class-fault",
    Severity.ERROR,
    "'{formula}' cannot be among the {section}: {reason}",
    why="Initial conditions speak of the first step alone, the others of one step and the next.",
    wrong='{"variables": {"go": {"owner": "env", "type": "bool"}},'
    ' "assumptions": {"init": ["go\'"]}}',
    right='{"variables": {"go": {"owner": "env", "type": "bool"}},'
    ' "assumptions": {"safety": ["go\'"]}}',
)
OWNER_NOT_SAID = rule(
    "SM587",
    "contract-owner-not-said",
    Severity.WARNING,
    "it is not said who decides {names}; all are taken as outputs",
    why="A formula alone does not say what is an input.",
    help="add lines '.inputs a b' and '.outputs c d' below the formula",
    wrong="[](req -> <>(ack))\n",
    right="[](req -> <>(ack))\n.inputs req\n.outputs ack\n",
)
NOT_STRICT = rule(
    "SM588",
    "contract-not-strict",
    Severity.INFO,
    "the semantics '{semantics}' is read as strict implication, as in games of GR(1)",
    why="Without Strict a system may break a safety guarantee when the environment breaks an "
    "assumption later; where neither side can force the other to that, both mean the same.",
    help="write SEMANTICS: Mealy,Strict",
    wrong="INFO { SEMANTICS: Mealy }\nMAIN { OUTPUTS { a; } ASSERT { a; } }\n",
    right="INFO { SEMANTICS: Mealy,Strict }\nMAIN { OUTPUTS { a; } ASSERT { a; } }\n",
)
