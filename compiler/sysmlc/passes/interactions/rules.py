"""What can be wrong with interactions (UML 2.5.1 clause 17)."""

from sysmlc.diagnostics import Severity, rule

_LIFELINES = """\
Interaction feed "Feed"
  Lifeline g "gate"
  Lifeline b "belt"
"""

MESSAGE_WITHOUT_LIFELINE = rule(
    "SM440",
    "message-without-lifeline",
    Severity.WARNING,
    "message '{message}' of '{interaction}' {problem}",
    why="A message leads from a lifeline or gate to another; this one cannot be drawn, and nobody "
    "knows who sends or receives it.",
    help="tie the ends of the message to lifelines again, or delete it",
    wrong=_LIFELINES
    + """\
  Message m "open" subkind="synch-call" message_kind="unknown"
""",
    right=_LIFELINES
    + """\
  Occurrence s subkind="message"
    -> covers g
  Occurrence r subkind="message"
    -> covers b
  Message m "open" subkind="synch-call"
    -> send-event s
    -> receive-event r
    -> flow-source g
    -> flow-target b
""",
)
OPERANDS = rule(
    "SM441",
    "wrong-number-of-operands",
    Severity.WARNING,
    "fragment '{operator}' of '{interaction}' has {count} operands, but {wanted}",
    why="UML 2.5.1, 17.6.3: opt, loop, break, assert and neg have exactly one operand; a combined "
    "fragment without operand says nothing.",
    help="move the contents into one operand, or choose another operator",
    wrong=_LIFELINES
    + """\
  Fragment f subkind="opt"
    Operand f.1 guard="ready"
    Operand f.2 guard="else"
""",
    right=_LIFELINES
    + """\
  Fragment f subkind="alt"
    Operand f.1 guard="ready"
    Operand f.2 guard="else"
""",
)
ACROSS_OPERANDS = rule(
    "SM442",
    "message-across-fragments",
    Severity.WARNING,
    "message '{message}' of '{interaction}' is sent in one operand and received in another",
    why="UML 2.5.1, 17.4.5: a message does not cross the border of a combined fragment or of one "
    "of its operands, except through gates. It is drawn where its first end is.",
    help="move both ends of the message into the same operand",
    wrong=_LIFELINES
    + """\
  Occurrence s subkind="message"
    -> covers g
  Fragment f subkind="opt"
    Operand f.1 guard="ready"
      Occurrence r subkind="message"
        -> covers b
  Message m "open" subkind="synch-call"
    -> send-event s
    -> receive-event r
    -> flow-source g
    -> flow-target b
""",
    right=_LIFELINES
    + """\
  Fragment f subkind="opt"
    Operand f.1 guard="ready"
      Occurrence s subkind="message"
        -> covers g
      Occurrence r subkind="message"
        -> covers b
  Message m "open" subkind="synch-call"
    -> send-event s
    -> receive-event r
    -> flow-source g
    -> flow-target b
""",
)
AFTER_DESTRUCTION = rule(
    "SM443",
    "occurrence-after-destruction",
    Severity.WARNING,
    "something happens on lifeline '{lifeline}' of '{interaction}' after it was destroyed",
    why="UML 2.5.1, 17.5.3: no occurrence stands below a destruction on the same lifeline.",
    help="move the destruction to the end of the lifeline",
    wrong=_LIFELINES
    + """\
  Occurrence x subkind="destruction"
    -> covers g
  Occurrence o
    -> covers g
""",
    right=_LIFELINES
    + """\
  Occurrence o
    -> covers g
  Occurrence x subkind="destruction"
    -> covers g
""",
)
RECEIVED_FIRST = rule(
    "SM444",
    "received-before-sent",
    Severity.WARNING,
    "message '{message}' of '{interaction}' is received before it is sent",
    why="UML 2.5.1, 17.4.3: sending comes before receiving. The order of the fragments in the "
    "model says otherwise, often after messages were moved in the diagram.",
    help="move the message in the modelling tool, so that it orders the ends anew",
    wrong=_LIFELINES
    + """\
  Occurrence r subkind="message"
    -> covers g
  Occurrence s subkind="message"
    -> covers g
  Message m "check" subkind="synch-call"
    -> send-event s
    -> receive-event r
    -> flow-source g
    -> flow-target g
""",
    right=_LIFELINES
    + """\
  Occurrence s subkind="message"
    -> covers g
  Occurrence r subkind="message"
    -> covers g
  Message m "check" subkind="synch-call"
    -> send-event s
    -> receive-event r
    -> flow-source g
    -> flow-target g
""",
)
EXECUTION_BACKWARDS = rule(
    "SM445",
    "execution-ends-before-it-starts",
    Severity.WARNING,
    "execution '{execution}' of '{interaction}' ends before it starts",
    why="Its first and last occurrence stand in the wrong order, so it lasts for no time and no "
    "diagram shows it.",
    help="draw the execution again in the modelling tool",
    wrong=_LIFELINES
    + """\
  Occurrence e
    -> covers g
  Occurrence s
    -> covers g
  Execution x "move" subkind="behavior"
    -> covers g
    -> start s
    -> finish e
""",
    right=_LIFELINES
    + """\
  Occurrence s
    -> covers g
  Occurrence e
    -> covers g
  Execution x "move" subkind="behavior"
    -> covers g
    -> start s
    -> finish e
""",
)
NOT_OFFERED = rule(
    "SM446",
    "operation-not-offered",
    Severity.WARNING,
    "message '{message}' of '{interaction}' calls '{operation}', which '{type}' does not offer",
    why="The type of the lifeline that receives the call has no such operation, neither its own "
    "nor inherited nor of an interface that it realises, so nobody can answer.",
    help="add the operation to '{type}', or choose one of its operations for the message",
    wrong="""\
Class gate "Gate"
  Operation gate.open "open"
Class belt "Belt"
Interaction feed "Feed"
  Property p "belt"
    -> typed-by belt
  Lifeline b "belt"
    -> represents p
  Occurrence r subkind="message"
    -> covers b
  Message m "open" subkind="synch-call" message_kind="found"
    -> receive-event r
    -> flow-target b
    -> calls gate.open
""",
    right="""\
Class gate "Gate"
  Operation gate.open "open"
Class slide "Slide gate"
  -> specializes gate
Interaction feed "Feed"
  Property p "gate"
    -> typed-by slide
  Lifeline b "gate"
    -> represents p
  Occurrence r subkind="message"
    -> covers b
  Message m "open" subkind="synch-call" message_kind="found"
    -> receive-event r
    -> flow-target b
    -> calls gate.open
""",
)
CREATED_LATE = rule(
    "SM447",
    "created-after-its-first-occurrence",
    Severity.WARNING,
    "message '{message}' of '{interaction}' creates lifeline '{lifeline}', on which something has "
    "happened before",
    why="UML 2.5.1, 17.4.5: no occurrence stands above the reception of a creating message on the "
    "lifeline that it creates. The diagram shows the lifeline as there from the beginning.",
    help="move the message up, or choose another sort of message",
    wrong=_LIFELINES
    + """\
  Occurrence o
    -> covers b
  Occurrence s
    -> covers g
  Occurrence r
    -> covers b
  Message m "new" subkind="create-message"
    -> send-event s
    -> receive-event r
    -> flow-source g
    -> flow-target b
""",
    right=_LIFELINES
    + """\
  Occurrence s
    -> covers g
  Occurrence r
    -> covers b
  Occurrence o
    -> covers b
  Message m "new" subkind="create-message"
    -> send-event s
    -> receive-event r
    -> flow-source g
    -> flow-target b
""",
)
