"""What can be wrong with operations, calls, triggers and the behaviours of states."""

from sysmlc.diagnostics import Severity, rule

CALL_OF_NOTHING = rule(
    "SM400",
    "call-of-nothing",
    Severity.WARNING,
    "action '{action}' does not say which {what} it calls",
    why="Nobody receives what the action sends, or carries out what it asks for.",
    help="choose the {what} in the modelling tool",
    wrong="""\
Activity pull "Pull in"
  Action pull.read "read tag" subkind="call-operation"
""",
    right="""\
Class gate "Gate"
  Operation gate.read "readTag"
Activity pull "Pull in"
  Action pull.read "read tag" subkind="call-operation"
    -> calls gate.read
""",
)
CALL_WITHOUT_BEHAVIOR = rule(
    "SM406",
    "call-without-behavior",
    Severity.INFO,
    "action '{action}' calls no behaviour, so it counts as an elementary action",
    why="MagicDraw draws every plain action as a call; contracts know only its name, when it "
    "starts and when it is done.",
    help="choose the behaviour in the modelling tool if there is one",
    wrong="""\
Activity pull "Pull in"
  Action pull.read "read tag" subkind="call-behavior"
""",
    right="""\
Activity pull "Pull in"
  Action pull.read "read tag" subkind="call-behavior"
    -> calls read
Activity read "Read"
""",
)
CALL_ARGUMENTS = rule(
    "SM401",
    "call-arguments",
    Severity.WARNING,
    "action '{action}' has {pins} {direction} pins, '{called}' has {parameters} {direction} "
    "parameters",
    why="Each parameter of what is called has its pin (UML 2.5.1 clause 16.3.3), so values have "
    "no place to go, or come from nowhere.",
    help="let the modelling tool synchronise the pins of the action",
    wrong="""\
Activity read "Read"
  Parameter read.id "id" direction="return"
Activity pull "Pull in"
  Action pull.read "read tag" subkind="call-behavior"
    -> calls read
""",
    right="""\
Activity read "Read"
  Parameter read.id "id" direction="return"
Activity pull "Pull in"
  Action pull.read "read tag" subkind="call-behavior"
    -> calls read
    Pin pull.read.id "id" direction="out" subkind="result"
""",
)
NO_BEHAVIOR = rule(
    "SM402",
    "no-behavior",
    Severity.WARNING,
    "the {relation} of '{element}' leads to '{target}', which is no behaviour",
    why="Entry, do, exit, effect, method and classifier behaviour are behaviours (UML 2.5.1 "
    "clause 13.2).",
    help="let it lead to an activity, state machine or interaction",
    wrong="""\
Class gate "Gate"
  Operation gate.open "open"
StateMachine sm "Gate states"
  Region sm.r
    State sm.open "open"
      -> entry gate.open
""",
    right="""\
Class gate "Gate"
  Activity gate.open "open"
StateMachine sm "Gate states"
  Region sm.r
    State sm.open "open"
      -> entry gate.open
""",
)
METHOD_BY_NAME = rule(
    "SM403",
    "method-by-name",
    Severity.INFO,
    "operation '{operation}' has no method, but '{owner}' has a behaviour of the same name",
    why="Equal names are no connection, so calls of the operation do not run the behaviour.",
    help="set the behaviour's specification to the operation if it implements it",
    wrong="""\
Class gate "Gate"
  Operation gate.open "open"
  Activity gate.doOpen "open"
""",
    right="""\
Class gate "Gate"
  Operation gate.open "open"
    -> method gate.doOpen
  Activity gate.doOpen "open"
""",
)
METHOD_PARAMETERS = rule(
    "SM404",
    "method-parameters",
    Severity.WARNING,
    "operation '{operation}' has the parameters ({own}), its method '{method}' ({other})",
    why="A method has the parameters of its operation (UML 2.5.1 clause 13.2.3.2), so a call "
    "cannot pass its arguments on.",
    help="give the behaviour the same parameters, in the same order",
    wrong="""\
Class gate "Gate"
  Operation gate.open "open"
    Parameter gate.open.a "angle"
    -> method gate.doOpen
  Activity gate.doOpen "open"
""",
    right="""\
Class gate "Gate"
  Operation gate.open "open"
    Parameter gate.open.a "angle"
    -> method gate.doOpen
  Activity gate.doOpen "open"
    Parameter gate.doOpen.a "angle"
""",
)
TRIGGER_OF_NOTHING = rule(
    "SM405",
    "trigger-of-nothing",
    Severity.WARNING,
    "{what} trigger of '{element}' does not say which {what} it waits for",
    why="Nobody can send what fires it.",
    help="choose the {what} in the modelling tool",
    wrong="""\
StateMachine sm "Gate states"
  Region sm.r
    Transition t "leave"
      -> trigger t.go
      Trigger t.go "go" subkind="signal"
""",
    right="""\
Signal go "Go"
StateMachine sm "Gate states"
  Region sm.r
    Transition t "leave"
      -> trigger t.go
      Trigger t.go "go" subkind="signal"
        -> typed-by go
""",
)
