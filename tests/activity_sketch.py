"""Small activities in a few lines, for the models of rules and for tests."""

_KINDS = {
    "initial": 'Control {} "" subkind="initial"',
    "final": 'Control {} "" subkind="final"',
    "end": 'Control {} "" subkind="flow-final"',
    "decision": 'Control {} "" subkind="decision"',
    "merge": 'Control {} "" subkind="merge"',
    "fork": 'Control {} "" subkind="fork"',
    "join": 'Control {} "" subkind="join"',
    "or-join": 'Control {} "" subkind="join" join_spec="or"',
    "action": 'Action {0} "{0}" subkind="opaque"',
    "accept": 'Action {0} "{0}" subkind="accept"',
    "raise": 'Action {0} "{0}" subkind="raise"',
    "protected": 'Action {0} "{0}" subkind="opaque" handlers=[[["repair"], [], []]]',
    "question": 'Control {} "" subkind="decision" decision_input="b"',
    "loop": 'Structured {0} "{0}" subkind="loop" body_part=["work"]',
    "expansion": 'Structured {0} "{0}" subkind="expansion" mode="parallel"',
    "iteration": 'Structured {0} "{0}" subkind="expansion" mode="iterative"',
    "structured": 'Structured {0} "{0}" subkind="structured"',
    "interruptible": 'Structured {0} "{0}" subkind="interruptible"',
    "pin": 'Pin {0} "{0}" direction="in" subkind="argument"',
    "on-pallet": 'Trigger {0} "pallet" subkind="signal"',
    "on-tool": 'Trigger {0} "tool" subkind="signal"',
}


def sketch(text: str) -> str:
    """Return the IR text of an activity; each line of *text* is a node or a flow.

    A node is written ``kind id``, a flow ``a -> b``. A flow may end in its guard in brackets or in
    attributes. Indented nodes are owned by the node above.
    """
    lines = ['Activity a "a"']
    flows = [line.strip() for line in text.splitlines() if "->" in line]
    for line in text.splitlines():
        if line.strip() and "->" not in line:
            kind, name = line.split()
            lines.append("  " + line[: len(line) - len(line.lstrip())] + _KINDS[kind].format(name))
    for number, flow in enumerate(flows):
        ends, _, rest = flow.partition(" [")
        source, target = (end.strip() for end in ends.split("->"))
        guard = f' guard="{rest.removesuffix("]")}"' if rest else ""
        target, _, attrs = target.partition(" ")
        lines.append(f"  ControlFlow f{number}{guard}{' ' + attrs if attrs else ''}")
        lines.append(f"    -> flow-source {source}")
        lines += [f"    -> flow-target {target}"] if target != "nothing" else []
    return "\n".join(lines) + "\n"
