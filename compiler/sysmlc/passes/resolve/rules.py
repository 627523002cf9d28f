"""What can be wrong with references."""

from sysmlc.diagnostics import Severity, rule

BROKEN_REFERENCE = rule(
    "SM150",
    "broken-reference",
    Severity.ERROR,
    "'{relation}' of '{element}' leads to '{target}', which does not exist",
    why="The file refers to an element that it does not contain, so what depends on it is lost.",
    help="restore the element in the modelling tool, or remove what refers to it",
    wrong="""\
Class gate "Gate"
  Port gate.in "in"
    ?> typed-by pallet Class
""",
    right="""\
Class gate "Gate"
  Port gate.in "in"
    ?> typed-by pallet Class
Class pallet "Pallet"
""",
)
BROKEN_ID = rule(
    "SM151",
    "broken-id",
    Severity.ERROR,
    "'{relation}' of '{element}' names '{target}', which does not exist",
    why="The element is described with the help of another one that the model does not contain.",
    help="restore the element in the modelling tool, or remove what refers to it",
    wrong="""\
Activity pull "Pull in"
  Control free "bay free?" subkind="decision" decision_input="isFree"
""",
    right="""\
Activity pull "Pull in"
  Control free "bay free?" subkind="decision" decision_input="isFree"
Activity isFree "is free"
""",
)
MANY_BROKEN = rule(
    "SM166",
    "broken-references",
    Severity.ERROR,
    "'{relation}' of '{element}' leads to '{target}' and {others} more that do not exist",
    why="The file refers to elements that it does not contain, so what depends on them is lost.",
    help="restore the elements in the modelling tool, or remove what refers to them",
    wrong="""\
Association line "line"
  ?> end a Property
  ?> end b Property
  ?> end c Property
  ?> end d Property
  ?> end e Property
""",
    right="""\
Association line "line"
  ?> end a Property
  ?> end b Property
  Property a "a"
  Property b "b"
""",
)
SEVERAL_TARGETS = rule(
    "SM167",
    "several-targets",
    Severity.ERROR,
    "'{relation}' of '{element}' leads to {count} elements, but a flow has only one; "
    "the first counts",
    why="A control flow, object flow or transition leads from one node to one node. With several "
    "it cannot be told what happens after what.",
    help="draw one flow for each, with a fork or a decision before them",
    wrong="""\
Activity pull "Pull in"
  Control start "start" subkind="initial"
  Action lower "Lower" subkind="opaque"
  Action raise "Raise" subkind="opaque"
  ControlFlow go
    ?> flow-source start Control
    ?> flow-target lower Action
    ?> flow-target raise Action
""",
    right="""\
Activity pull "Pull in"
  Control start "start" subkind="initial"
  Action lower "Lower" subkind="opaque"
  ControlFlow go
    ?> flow-source start Control
    ?> flow-target lower Action
""",
)
MISSING_LIBRARY = rule(
    "SM152",
    "missing-library",
    Severity.WARNING,
    "'{library}' is not part of the compile unit; what it holds ({count}) is known by name only",
    why="What the model takes from a file that is not read has a name and a kind, nothing more: "
    "no features, no stereotypes, no behaviour.",
    help="give the file '{library}' as a further input",
    wrong="""\
Class gate "Gate"
  Port gate.in "in"
    ?> typed-by plant.uml#pallet Class "Pallet"
""",
    right="""\
Class gate "Gate" @line.uml:1
  Port gate.in "in"  @line.uml:2
    ?> typed-by plant.uml#pallet Class "Pallet"
Class pallet "Pallet" @plant.uml:1
""",
)
UNKNOWN_IN_LIBRARY = rule(
    "SM153",
    "unknown-in-library",
    Severity.WARNING,
    "'{library}' is known to sysmlc without reading it, but {count} of what the model takes from "
    "it is not",
    why="The file comes with every modelling tool, so that nobody gives it as an input. It has no "
    "element of this name in any version, or the reference shows only an id, because the name was "
    "lost with the extensions of the tool. What is not known has a kind, nothing more.",
    help="choose the type again in the modelling tool, or give the file as a further input",
    wrong="""\
Class gate "Gate"
  Property gate.count "count"
    ?> typed-by pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml#Intger DataType
""",
    right="""\
Class gate "Gate"
  Property gate.count "count"
    ?> typed-by pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml#Integer DataType
""",
)
