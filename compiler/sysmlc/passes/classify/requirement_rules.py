"""What can be wrong with requirements themselves."""

from sysmlc.diagnostics import Severity, rule

_SYSML = 'namespace="http://www.omg.org/spec/SysML/20150709/SysML"'


def _requirement(id: str, name: str, tags: str) -> str:
    return (
        f'Class {id} "{name}"\n'
        f'  Application {id}.a stereotype="Requirement" {_SYSML} {tags}\n'
        f"    -> subject {id}\n"
    )


_COPY = f"""\
Dependency d subkind="abstraction"
  -> client b
  -> supplier a
  Application c stereotype="Copy" {_SYSML}
    -> subject d
"""

REPEATED_ID = rule(
    "SM213",
    "repeated-requirement-id",
    Severity.WARNING,
    "requirement '{requirement}' has the id {id}, as '{first}' has",
    why="The id of a requirement is unique (SysML 1.6 clause 16.3.2); tables, reports and other "
    "tools find a requirement by it.",
    help="give one of the two another id",
    wrong=_requirement("a", "No jam", 'tag.id="R1"') + _requirement("b", "Quiet", 'tag.id="R1"'),
    right=_requirement("a", "No jam", 'tag.id="R1"') + _requirement("b", "Quiet", 'tag.id="R2"'),
)
NO_ID = rule(
    "SM214",
    "requirement-without-id",
    Severity.INFO,
    "requirement '{requirement}' has no id",
    why="Nothing but its name tells the requirement from others, and names change.",
    help="fill in the tag id (Papyrus) or Id (MagicDraw, Cameo) of «Requirement»",
    wrong=_requirement("a", "No jam", 'tag.id=" " tag.text="Pallets never jam."'),
    right=_requirement("a", "No jam", 'tag.Id="R1" tag.text="Pallets never jam."'),
)
COPY_DIFFERS = rule(
    "SM215",
    "copy-with-other-text",
    Severity.WARNING,
    "requirement '{copy}' is a copy of '{master}' and has another text",
    why="The text of a copy is a read-only copy of its master's text (SysML 1.6 clause 16.3.2), "
    "so that one of the two is out of date.",
    help="take over the text of '{master}', or replace «copy» by «deriveReqt»",
    wrong=_requirement("a", "No jam", 'tag.id="R1" tag.text="Pallets never jam."')
    + _requirement("b", "No jam here", 'tag.id="R2" tag.text="Pallets seldom jam."')
    + _COPY,
    right=_requirement("a", "No jam", 'tag.id="R1" tag.text="Pallets never jam."')
    + _requirement("b", "No jam here", 'tag.id="R2" tag.text="Pallets  never jam."')
    + _COPY,
)
