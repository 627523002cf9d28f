"""Texts of plantuml, as its templates say.

Generated from templates/plantuml by ``python -m sysmlc.backends.translate``; do not edit.
"""

# fmt: off
# ruff: noqa: ANN401, C901, E501, PLR0912, RUF100

from collections.abc import Callable
from typing import Any


def _boxes(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(
        "hide circle\n"
        "hide stereotype\n"
        "hide empty members\n"
    )
    for box in view.boxes:
        add(f"class \"{box.label}\" as {box.alias} <<{box.style}>>")
        if box.compartments:
            add(" {\n")
            for compartment in box.compartments:
                if compartment.title:
                    add(f".. {compartment.title} ..\n")
                for row in compartment.rows:
                    add(f"{{field}} {row}\n")
            add("}\n")
        else:
            add("\n")
    for line in view.lines:
        add(f"{line.source}")
        if line.near:
            add(f" \"{line.near}\"")
        add(f" {line.arrow}")
        if line.far:
            add(f" \"{line.far}\"")
        add(f" {line.target}")
        if line.label:
            add(f" : {line.label}")
        add("\n")
    for line in view.guides:
        add(f"{line.source} {line.arrow} {line.target}\n")
    return "".join(made)


def _frame(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add("@startuml\n")
    for line in header:
        add(f"' {line}\n")
    add(_style(diagram, view, header))
    add(f"mainframe {diagram.frame}\n")
    if diagram.footer:
        add(f"footer {diagram.footer}\n")
    return "".join(made)


def _graph(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(
        "hide empty description\n"
        "hide stereotype\n"
    )
    def loop0(items: Any) -> str:
        made: list[str] = []
        add = made.append
        for node in items:
            add(f"state \"{node.label}\" as {node.alias} <<{node.shape}>>")
            if node.tint:
                add(f" <<{node.tint}>>")
            if node.children:
                add(
                    " {\n"
                    f"{loop0(node.children)}}}\n"
                )
            else:
                add("\n")
            for row in node.rows:
                add(f"{node.alias} : {row}\n")
            if node.note:
                add(f"note right of {node.alias} : {node.note}\n")
        return "".join(made)
    add(loop0(view.nodes))
    for note in view.notes:
        add(f"note \"{note.text}\" as {note.alias}\n")
        for target in note.targets:
            add(f"{note.alias} -[dotted,#A0AEC0]-> {target}\n")
    for line in view.lines:
        add(f"{line.source} {line.arrow} {line.target}")
        if line.label:
            add(f" : {line.label}")
        add("\n")
    return "".join(made)


def _internal(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    if view.has_ports:
        add("left to right direction\n")
    add(_internal_style(diagram, view, header))
    add(
        "skinparam nodesep 50\n"
        "skinparam ranksep 40\n"
        "hide stereotype\n"
    )
    def loop0(items: Any) -> str:
        made: list[str] = []
        add = made.append
        for part in items:
            add(f"rectangle \"{part.label}\" as {part.alias} <<{part.style}>>")
            if (part.ports or part.parts):
                add(" {\n")
                for port in part.ports:
                    add(f"{port.form} \"{port.label}\" as {port.alias}\n")
                add(f"{loop0(part.parts)}}}\n")
            else:
                add("\n")
        return "".join(made)
    add(loop0((view.frame,)))
    for line in view.lines:
        add(f"{line.source}")
        if line.near:
            add(f" \"{line.near}\"")
        add(f" {line.arrow}")
        if line.far:
            add(f" \"{line.far}\"")
        add(f" {line.target}")
        if line.label:
            add(f" : {line.label}")
        add("\n")
    for line in view.guides:
        add(f"{line.source} {line.arrow} {line.target}\n")
    if view.domains:
        add("legend bottom right\n")
        for domain in view.domains:
            add(f"<color:${domain}>{'**━━▶**' if domain == 'physical' else '**╍╍▶**'}</color>  {domain}\n")
        add("endlegend\n")
    return "".join(made)


def _internal_style(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(
        "<style>\n"
        ".frame, .part, .reference {\n"
        "  FontStyle plain\n"
        "}\n"
        "legend {\n"
        "  BackgroundColor #FFFFFF\n"
        "  LineColor #A0AEC0\n"
        "  FontSize 10\n"
        "  RoundCorner 0\n"
        "}\n"
        "</style>\n"
    )
    if view.domains:
        add(
            "!$physical = \"#0072B2\"\n"
            "!$physical_line = $physical + \",thickness=2\"\n"
            "!$information = \"#D55E00\"\n"
            "!$information_line = $information + \",dashed,thickness=2\"\n"
        )
    return "".join(made)


def _sequence_style(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(
        "<style>\n"
        "participant, actor {\n"
        "  BackgroundColor #F7FAFC\n"
        "  LineColor #4A5568\n"
        "}\n"
        "lifeLine {\n"
        "  BackgroundColor #EBF8FF\n"
        "  LineColor #A0AEC0\n"
        "}\n"
        "group, reference {\n"
        "  LineColor #A0AEC0\n"
        "  LineThickness 1\n"
        "  FontStyle plain\n"
        "  FontSize 11\n"
        "}\n"
        "reference {\n"
        "  BackgroundColor #FFFFFF\n"
        "}\n"
        "groupHeader, referenceHeader {\n"
        "  BackgroundColor #EDF2F7\n"
        "  LineColor #A0AEC0\n"
        "  LineThickness 1\n"
        "  FontSize 11\n"
        "}\n"
        "</style>\n"
    )
    return "".join(made)


def _style(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(
        "<style>\n"
        "root {\n"
        "  FontName \"DejaVu Sans\"\n"
        "  FontSize 12\n"
        "}\n"
        "document {\n"
        "  BackgroundColor #FFFFFF\n"
        "}\n"
        "mainframe {\n"
        "  LineColor #A0AEC0\n"
        "  Padding 8\n"
        "}\n"
        "footer {\n"
        "  FontSize 10\n"
        "  FontColor #718096\n"
        "}\n"
        "arrow {\n"
        "  FontSize 11\n"
        "  FontColor #2D3748\n"
        "  LineColor #4A5568\n"
        "}\n"
        "note {\n"
        "  BackgroundColor #FFFFF0\n"
        "  LineColor #CBD5E0\n"
        "  FontSize 11\n"
        "}\n"
        "class, state, rectangle, port {\n"
        "  BackgroundColor #F7FAFC\n"
        "  LineColor #4A5568\n"
        "}\n"
        "port {\n"
        "  BackgroundColor #FFFFFF\n"
        "  FontSize 10\n"
        "}\n"
        "class {\n"
        "  RoundCorner 0\n"
        "}\n"
        "state {\n"
        "  FontStyle plain\n"
        "}\n"
        ".value, .object, .store {\n"
        "  BackgroundColor #FFFFFF\n"
        "  RoundCorner 0\n"
        "}\n"
        ".interface {\n"
        "  LineStyle 4-3\n"
        "}\n"
        ".requirement {\n"
        "  BackgroundColor #FFFDF5\n"
        "}\n"
        ".elsewhere {\n"
        "  BackgroundColor #EDF2F7\n"
        "  FontColor #718096\n"
        "  LineColor #A0AEC0\n"
        "}\n"
        ".frame {\n"
        "  BackgroundColor #FFFFFF\n"
        "}\n"
        ".reference {\n"
        "  LineStyle 5-4\n"
        "}\n"
        ".law {\n"
        "  RoundCorner 15\n"
        "}\n"
        ".region, .lane, .section {\n"
        "  BackgroundColor transparent\n"
        "  LineColor #A0AEC0\n"
        "  LineStyle 5-4\n"
        "  RoundCorner 0\n"
        "}\n"
        ".structured {\n"
        "  BackgroundColor transparent\n"
        "  LineStyle 5-4\n"
        "}\n"
        ".machine {\n"
        "  BackgroundColor transparent\n"
        "  RoundCorner 0\n"
        "}\n"
        ".accept, .send {\n"
        "  DiagonalCorner 10\n"
        "  RoundCorner 0\n"
        "}\n"
        ".terminate, .flowfinal {\n"
        "  BackgroundColor transparent\n"
        "  LineColor transparent\n"
        "}\n"
        ".lane1 {\n"
        "  BackgroundColor #EBF8FF\n"
        "}\n"
        ".lane2 {\n"
        "  BackgroundColor #FEFCE8\n"
        "}\n"
        ".lane3 {\n"
        "  BackgroundColor #F0FFF4\n"
        "}\n"
        ".lane4 {\n"
        "  BackgroundColor #FFF5F5\n"
        "}\n"
        ".lane5 {\n"
        "  BackgroundColor #FAF5FF\n"
        "}\n"
        ".lane6 {\n"
        "  BackgroundColor #FFFAF0\n"
        "}\n"
        "</style>\n"
    )
    return "".join(made)


def _use_case_style(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(
        "<style>\n"
        "usecase, actor {\n"
        "  BackgroundColor #F7FAFC\n"
        "  LineColor #4A5568\n"
        "}\n"
        "</style>\n"
    )
    return "".join(made)


def _act_puml(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(_frame(diagram, view, header))
    add(_graph(diagram, view, header))
    add("@enduml\n")
    return "".join(made)


def _bdd_puml(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(_frame(diagram, view, header))
    add(_boxes(diagram, view, header))
    add("@enduml\n")
    return "".join(made)


def _class_puml(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(_frame(diagram, view, header))
    add(_boxes(diagram, view, header))
    add("@enduml\n")
    return "".join(made)


def _ibd_puml(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(_frame(diagram, view, header))
    add(_internal(diagram, view, header))
    add("@enduml\n")
    return "".join(made)


def _par_puml(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(_frame(diagram, view, header))
    add(_internal(diagram, view, header))
    add("@enduml\n")
    return "".join(made)


def _pkg_puml(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(_frame(diagram, view, header))
    add(_boxes(diagram, view, header))
    add("@enduml\n")
    return "".join(made)


def _req_puml(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(_frame(diagram, view, header))
    add(_boxes(diagram, view, header))
    add("@enduml\n")
    return "".join(made)


def _sd_puml(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(_frame(diagram, view, header))
    add(_sequence_style(diagram, view, header))
    add("hide footbox\n")
    for one in view.participants:
        add(f"{one.form} \"{one.label}\" as {one.alias}\n")
    for step in view.steps:
        if step.word == 'message':
            add(f"{step.source}{' ' if step.source not in ('[', '?o',) else ''}{step.arrow}{' ' if step.target not in (']', 'o?',) else ''}{step.target}")
            if step.text:
                add(f" : {step.text}")
            add("\n")
        elif step.word == 'open':
            add(f"{step.arrow}")
            if step.text:
                add(f" {step.text}")
            add("\n")
        elif step.word == 'else':
            add("else")
            if step.text:
                add(f" {step.text}")
            add("\n")
        elif step.word == 'end':
            add("end\n")
        elif step.word in ('note', 'hnote', 'ref',):
            add(f"{step.word} ")
            if step.over:
                add(f"over {', '.join(step.over)}")
            else:
                add("across")
            add(f" : {step.text}\n")
        else:
            add(f"{step.word} {step.source}\n")
    add("@enduml\n")
    return "".join(made)


def _stm_puml(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(_frame(diagram, view, header))
    add(_graph(diagram, view, header))
    add("@enduml\n")
    return "".join(made)


def _uc_puml(diagram: Any, view: Any, header: Any) -> str:
    made: list[str] = []
    add = made.append
    add(_frame(diagram, view, header))
    add(
        "left to right direction\n"
        "hide stereotype\n"
    )
    add(_use_case_style(diagram, view, header))
    def figure(one: Any) -> str:
        made: list[str] = []
        add = made.append
        add(f"{one.form} \"{one.label}\" as {one.alias}")
        if one.style:
            add(f" <<{one.style}>>")
        return "".join(made)
    for one in view.actors:
        add(f"{figure(one)}\n")
    for subject in view.subjects:
        add(f"rectangle \"{subject.label}\" as {subject.alias} <<frame>> {{\n")
        for one in subject.cases:
            add(f"{figure(one)}\n")
        add("}\n")
    for one in view.cases:
        add(f"{figure(one)}\n")
    for line in view.lines:
        add(f"{line.source}")
        if line.near:
            add(f" \"{line.near}\"")
        add(f" {line.arrow}")
        if line.far:
            add(f" \"{line.far}\"")
        add(f" {line.target}")
        if line.label:
            add(f" : {line.label}")
        add("\n")
    for note in view.notes:
        add(f"note \"{note.text}\" as {note.alias}\n")
        for target in note.targets:
            add(f"{note.alias} .. {target}\n")
    add("@enduml\n")
    return "".join(made)


TEXTS: dict[str, Callable[..., str]] = {
    "act.puml.j2": _act_puml,
    "bdd.puml.j2": _bdd_puml,
    "class.puml.j2": _class_puml,
    "ibd.puml.j2": _ibd_puml,
    "par.puml.j2": _par_puml,
    "pkg.puml.j2": _pkg_puml,
    "req.puml.j2": _req_puml,
    "sd.puml.j2": _sd_puml,
    "stm.puml.j2": _stm_puml,
    "uc.puml.j2": _uc_puml,
}
