"""Action nodes: accept, send, assign, terminate, if, while, loop, for (SysML 8.2.2.17)."""

from sysmlc.language.text.build.connections import Tail
from sysmlc.language.text.build.expressions import chain_of
from sysmlc.language.text.build.features import Part, specialize
from sysmlc.language.text.build.names import Names, call
from sysmlc.language.text.build.owning import FEATURE, made, own
from sysmlc.language.text.scan import Tokens
from sysmlc.language.tree import Node, Relation

PARAMETER = "ParameterMembership"


def parameter(value: Node | None, start: int) -> Node:
    """A parameter of an action node, bound to a value or empty."""
    end = start if value is None else value.end
    node = Node("ReferenceUsage", membership=PARAMETER, start=start, end=end)
    if value is not None:
        node.start = node.name_start = value.start
        value.membership, value.role = "FeatureValue", "="
        node.own(value)
    return node


def _accept(
    tokens: Tokens,
    at: int,
    begin: int,
    payload: Node | None,
    trigger: Node | None,
    via: Node | None,
) -> Tail:
    if payload is None:
        payload = made("ReferenceUsage", PARAMETER, tokens, begin + 1, max(at, begin + 2))
    if trigger is not None:
        _name(payload)
        payload.own(trigger)
    members = [payload]
    if via is not None:
        members.append(parameter(via, via.start))
    return Tail("AcceptActionUsage", "step", members)


def _name(payload: Node) -> None:
    """Before a trigger, a name alone is that of the payload, not its type (8.2.2.17.4)."""
    for relation in payload.relations[:1]:
        chain, start = relation.reference.chain, relation.reference.start
        if payload.name is None and start == payload.start and len(chain[0]) == len(chain) == 1:
            payload.name = chain[0][0]
            payload.name_start = start
            payload.relations.pop(0)


def _trigger(tokens: Tokens, at: int, begin: int, keyword: int, value: Node) -> Node:
    node = made("TriggerInvocationExpression", "FeatureValue", tokens, begin, at)
    node.role = "="
    node.facts["kind"] = tokens[keyword]
    value.membership = PARAMETER
    if tokens[keyword] == "when":
        value.role = "expression"
    node.own(value)
    return node


def _accept_step(_tokens: Tokens, _at: int, _begin: int, accept: Tail) -> Tail:
    return accept


def _send(
    tokens: Tokens,
    _at: int,
    begin: int,
    item: Node | None,
    via: Node | None,
    to: Node | None,
) -> Tail:
    given = [item, via, to]
    while given and given[-1] is None:
        given.pop()
    start = tokens.ends[begin]
    return Tail("SendActionUsage", "step", [parameter(value, start) for value in given])


def _assign(tokens: Tokens, _at: int, begin: int, target: Node, value: Node) -> Tail:
    tail = Tail("AssignmentActionUsage", "step", [parameter(None, tokens.ends[begin])])
    if target.kind == "FeatureChainExpression":
        tail.relations = [target.relations[0]]
        tail.members = [parameter(target.members[0], target.start)]
    elif (reference := chain_of(target)) is not None:
        tail.relations = [Relation("Membership", reference)]
    else:
        tail.members = [parameter(target, target.start)]
    tail.members.append(parameter(value, value.start))
    return tail


def _terminate(_tokens: Tokens, _at: int, _begin: int, value: Node | None) -> Tail:
    return Tail(
        "TerminateActionUsage", "step", [] if value is None else [parameter(value, value.start)]
    )


def _block(tokens: Tokens, at: int, begin: int, body: list[Node]) -> Node:
    return own(made("ActionUsage", PARAMETER, tokens, begin, at), body)


def _named_block(
    tokens: Tokens,
    at: int,
    begin: int,
    names: Names | None,
    parts: list[Part] | None,
    body: list[Node],
) -> Node:
    node = call(made("ActionUsage", PARAMETER, tokens, begin, at), names, tokens)
    return own(specialize(node, parts, tokens), body)


def _condition(value: Node) -> Node:
    value.membership = PARAMETER
    return value


def _if(tokens: Tokens, at: int, begin: int, condition: Node, *branches: Node | Tail) -> Tail:
    members = [_condition(condition)]
    for branch in branches:
        if isinstance(branch, Tail):
            nested = made("IfActionUsage", PARAMETER, tokens, begin, at)
            nested.kind = branch.kind
            for member in branch.members:
                nested.own(member)
            nested.start = nested.name_start = branch.members[0].start
            members.append(nested)
        else:
            members.append(branch)
    return Tail("IfActionUsage", "step", members)


def _while(_tokens: Tokens, _at: int, _begin: int, *given: Node) -> Tail:
    for expression in (given[0], *given[2:]):
        _condition(expression)
    return Tail("WhileLoopActionUsage", "step", list(given))


def _loop(tokens: Tokens, _at: int, begin: int, body: Node, until: Node | None = None) -> Tail:
    members = [parameter(None, tokens.ends[begin]), body]
    if until is not None:
        members.append(_condition(until))
    return Tail("WhileLoopActionUsage", "step", members)


def _for(
    tokens: Tokens,
    _at: int,
    begin: int,
    names: Names,
    parts: list[Part] | None,
    value: Node,
    body: Node,
) -> Tail:
    variable = call(made("ReferenceUsage", FEATURE, tokens, begin + 1, begin + 2), names, tokens)
    specialize(variable, parts, tokens)
    return Tail("ForLoopActionUsage", "step", [variable, parameter(value, value.start), body])


ACTIONS = {
    "accept": _accept,
    "trigger": _trigger,
    "accept_step": _accept_step,
    "send": _send,
    "assign": _assign,
    "terminate": _terminate,
    "block_action": _block,
    "named_block": _named_block,
    "if_then": _if,
    "if_else": _if,
    "while": _while,
    "loop": _loop,
    "for": _for,
}
