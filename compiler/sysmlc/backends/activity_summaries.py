"""Summary of an activity in sentences, for the page of its contract.

The paragraphs state what the activity reads and writes, in which order its steps run, what holds
before and after, and what is assumed. All text of the model is escaped for Markdown.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import islice

from sysmlc.logic.activities.handshakes import describe_performance
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import (
    ACTIVITY_REGION,
    NodeKind,
    Store,
    TokenEdge,
    TokenNode,
    Write,
)
from sysmlc.logic.contract import Class, Conjunct, Contract, Variable
from sysmlc.logic.domains import describe
from sysmlc.logic.formula import TRUE, Const, variables
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.contract_reduction import as_ltl
from sysmlc.logic.region_formulas import describe_literals, print_worded
from sysmlc.support.escapes import escape_code, escape_markdown

_STEPS = (NodeKind.ACTION, NodeKind.STRUCTURED)
_SEQUENTIAL = (*_STEPS, NodeKind.INITIAL, NodeKind.DECISION, NodeKind.MERGE)
_FINALS = (NodeKind.ACTIVITY_FINAL, NodeKind.FLOW_FINAL)
_LISTED = (*_STEPS, NodeKind.ACTIVITY_FINAL)
_MAX_PATHS = 100
"""Most paths of control nodes behind a flow whose guards are listed."""
_MANY_GUARDS = ("...",)
"""Stands for the guards of too many paths."""
_END = ""
"""Stands for the end among the ids of the nodes that follow."""
_Branches = dict[tuple[str, ...], list[str]]
"""The ids of the steps that follow under the same guards; empty guards mean always."""


class ActivitySummary:
    """Describes one activity."""

    def __init__(self, game: TokenGraph, contract: Contract) -> None:
        self._game = game
        self._contract = contract

    def iter_paragraphs(self) -> Iterator[str]:
        """Yield the paragraphs as Markdown."""
        game = self._game
        done = {name for node in game.nodes if node.done for name in _names_in(node)}
        if game.handshake is not None:
            yield f"**Performance.** It runs {describe_performance(game.handshake, '`')}."
        inputs = [v for v in game.inputs if v.name not in done and v.name not in game.pulses]
        events = [v for v in game.inputs if v.name not in done and v.name in game.pulses]
        stores = [store for store in (*game.stores, *game.shared) if store.follows is None]
        names = _join([_quote(event.name) for event in events])
        waits = f" It waits for {names}." if names else ""
        yield f"**Inputs.** {_list_variables('It reads', inputs)}{waits}"
        # A step may assign a feature without a finite range, which the contract leaves open.
        outputs = "The contract states no value that a step assigns."
        if stores:
            outputs = _list_variables("Its steps assign", [store.variable for store in stores])
        yield f"**Outputs.** {outputs}{self._describe_writes(stores)}"
        order = _join_sentences(self._iter_order(ACTIVITY_REGION, "It"))
        yield f"**Order of the steps.** {order or 'It has no steps.'}"
        for node in game.nodes:
            inner = _join_sentences(self._iter_order(node.id, _name(node)))
            if node.kind is NodeKind.STRUCTURED and inner:
                yield f"**Inside {_name(node)}.** {inner}"
        yield f"**Before.** {self._describe_start()}"
        yield f"**After.** {' '.join(self._iter_after())}"
        yield f"**Assumed.** {self._describe_assumptions()}"

    # -- order -------------------------------------------------------------------------------------

    def _iter_order(self, region: str, subject: str) -> Iterator[str]:
        """Yield the sentences about the steps directly in a region."""
        marked = [edge for edge in self._game.inside(region)[0] if edge.marked]
        starts = self._collect_branches(list(filter(self._leads_to_first, marked)))
        if starts:
            yield f"{subject} starts with {self._describe_branches(starts)}."
        steps = [node for node in self._game.members(region) if node.kind in _STEPS]
        followers = {
            node.id: self._collect_branches(self._game.outgoing(node), node.id) for node in steps
        }
        continued: set[str] = set()
        for node in steps:
            if node.id in continued:
                continue
            chain = self._find_chain(node.id, followers, starts)
            continued.update(chain)
            if len(chain) > 1:
                names = self._join_names(chain)
                yield f"{names} run one after the other."
            if followers[chain[-1]]:
                name = _name(self._game.node(chain[-1]))
                yield f"After {name} comes {self._describe_branches(followers[chain[-1]])}."
        for node in self._game.members(region):
            waited = self._find_waited(node)
            if len(waited) > 1 and (node.kind in _STEPS or node.kind in _FINALS):
                name = _name(node) if node.kind in _STEPS else "The end"
                yield f"{name} waits for {self._join_names(waited)}."

    def _find_chain(
        self, start: str, followers: dict[str, _Branches], starts: _Branches
    ) -> list[str]:
        """Return the steps from *start* on that run one after the other without alternatives."""
        groups = [ids for branches in (starts, *followers.values()) for ids in branches.values()]
        reached = [id for ids in groups for id in ids]
        chain = [start]
        while True:
            branches = followers[chain[-1]]
            following = branches.get((), [])
            if len(branches) != 1 or len(following) != 1 or following[0] not in followers:
                return chain
            if reached.count(following[0]) != 1 or following[0] in chain:
                return chain
            chain.append(following[0])

    def _leads_to_first(self, edge: TokenEdge) -> bool:
        """Whether a step at the end of the edge waits for no other step."""
        target = self._game.node(edge.target)
        is_alone = target.kind not in _STEPS or len(self._game.incoming(target)) == 1
        return is_alone or not self._find_steps_before(target)

    def _collect_branches(self, edges: Sequence[TokenEdge], origin: str = "") -> _Branches:
        """Return the steps that tokens on the edges reach from the node *origin*, by guards.

        If there are too many paths of control nodes, all steps are under ``_MANY_GUARDS``.
        """
        paths: list[tuple[tuple[str, ...], str | None]] = []
        for edge in edges:
            listed = list(islice(self._iter_paths(edge, origin), _MAX_PATHS + 1))
            if len(listed) > _MAX_PATHS:
                return {_MANY_GUARDS: self._find_reachable(edges)}
            paths += listed
        branches: _Branches = {}
        for guards, id in paths:
            if id is not None and id not in branches.setdefault(guards, []):
                branches[guards].append(id)
        return branches

    def _iter_paths(
        self, edge: TokenEdge, origin: str
    ) -> Iterator[tuple[tuple[str, ...], str | None]]:
        """Yield the guards and the step of each path of control nodes; None without a step."""
        worklist: list[tuple[TokenEdge, tuple[str, ...], frozenset[str]]] = [
            (edge, (), frozenset([origin]))
        ]
        while worklist:
            edge, guards, seen = worklist.pop()
            if edge.guard is not None:
                guards = (*guards, "" if edge.is_else else edge.guard.text)
            target = self._game.node(edge.target)
            following = [] if target.id in seen else self._game.outgoing(target)
            if target.kind in _LISTED:
                yield guards, target.id if target.kind in _STEPS else _END
            elif following:
                behind = seen | {target.id}
                worklist += ((next_edge, guards, behind) for next_edge in reversed(following))
            else:
                yield guards, None

    def _find_reachable(self, edges: Sequence[TokenEdge]) -> list[str]:
        """Return the steps that tokens on the edges reach through control nodes."""
        steps: list[str] = []
        waiting, seen = list(reversed(edges)), set[str]()
        while waiting:
            target = self._game.node(waiting.pop().target)
            if target.kind in _LISTED:
                id = target.id if target.kind in _STEPS else _END
                steps += [id] if id not in steps else []
            elif target.id not in seen:
                seen.add(target.id)
                waiting += reversed(self._game.outgoing(target))
        return steps

    def _find_waited(self, node: TokenNode) -> list[str]:
        """Return the steps that have to end before a step or the end, because of a join."""
        incoming = self._game.incoming(node)
        if node.kind in _STEPS and len(incoming) > 1:
            return self._find_steps_before(node)
        while len(incoming) == 1:
            node = self._game.node(incoming[0].source)
            if node.kind is NodeKind.JOIN:
                return self._find_steps_before(node)
            incoming = self._game.incoming(node) if node.kind is NodeKind.FORK else []
        return []

    def _find_steps_before(self, node: TokenNode) -> list[str]:
        """Return the steps from which tokens reach a node through control nodes."""
        steps: set[str] = set()
        waiting, seen = [node], {node.id}
        while waiting:
            for edge in self._game.incoming(waiting.pop()):
                source = self._game.node(edge.source)
                if source.kind in _STEPS:
                    steps.add(source.id)
                elif source.id not in seen:
                    seen.add(source.id)
                    waiting.append(source)
        return [other.id for other in self._game.nodes if other.id in steps]

    def _describe_branches(self, branches: _Branches) -> str:
        """Return the steps that follow, each with its guards; those after ``else`` come last."""
        texts = []
        for guards, ids in sorted(branches.items(), key=lambda branch: "" in branch[0]):
            conditions = [_quote(guard) for guard in dict.fromkeys(guards) if guard]
            steps = [_name(self._game.node(id)) if id != _END else "the end" for id in ids]
            if guards == _MANY_GUARDS:
                texts.append(f"{_join(steps, 'or')}, as the guards in between decide")
                continue
            text = _join(steps) + (" at the same time" if len(steps) > 1 else "")
            text = f"{text} if {_join(conditions)}" if conditions else text
            texts.append(f"otherwise {text}" if "" in guards else text)
        return ", ".join(texts)

    def _join_names(self, ids: Sequence[str]) -> str:
        return _join([_name(self._game.node(id)) for id in ids])

    # -- values ------------------------------------------------------------------------------------

    def _describe_writes(self, stores: Iterable[Store]) -> str:
        sentences = (
            f" {_name(self._game.node(write.node))} sets {_quote(store.variable.name)}"
            f" to {_describe_value(write)}."
            for store in stores
            for write in store.writes
        )
        return "".join(sentences)

    def _describe_start(self) -> str:
        """Return the conditions of the first step that are about values, not about tokens."""
        own = {node.run for node in self._game.nodes}
        own |= {edge.variable for edge in self._game.edges}
        own |= {name for _, name in self._game.named_conditions}
        own |= {store.variable.name for store in self._game.stores if store.follows is not None}
        if self._game.handshake is not None:
            own.add(self._game.handshake.running)
        texts = [
            _quote(print_worded(conjunct.formula, self._contract.variables))
            for conjunct in (*self._contract.assumptions, *self._contract.guarantees)
            if conjunct.class_ is Class.INIT
            and own.isdisjoint(variable.name for variable in variables(conjunct.formula))
        ]
        return f"{_join(texts)} when it starts." if texts else "It starts with any values."

    def _iter_after(self) -> Iterator[str]:
        finals = [escape_markdown(n.label) for n in self._game.nodes if n.kind in _FINALS]
        if not self._game.finishes:
            yield "It never ends."
        elif finals:
            yield f"It ends at {_join(finals, 'or')}."
        else:
            yield "It ends when no step is left."
        for store in self._game.stores if self._is_sequential() else ():
            last = self._find_last_writes(store)
            if last is not None and len(last) == 1 and _is_constant(last[0]):
                node = _name(self._game.node(last[0].node))
                value = _describe_value(last[0])
                yield f"At the end {_quote(store.variable.name)} is {value}, set by {node}."
        if self._game.shared:
            names = _join([_quote(store.variable.name) for store in self._game.shared])
            yield f"Other behaviours may assign {names}, too."
        for conjunct in self._contract.guarantees:
            if not conjunct.is_derived:
                formula = _quote(print_worded(as_ltl(conjunct), self._contract.variables))
                yield f"The author demands {formula}."

    def _is_sequential(self) -> bool:
        """Whether there is at most one token, so that the steps of a run are a sequence."""
        game = self._game
        is_plain = all(node.kind in (*_SEQUENTIAL, *_FINALS) for node in game.nodes)
        has_one_token = sum(edge.marked for edge in game.edges) == 1 and all(
            len(game.outgoing(node)) <= 1 or node.kind is NodeKind.DECISION for node in game.nodes
        )
        is_flat = all(node.region == ACTIVITY_REGION for node in game.nodes)
        return is_plain and has_one_token and is_flat and not game.interruptibles

    def _find_last_writes(self, store: Store) -> list[Write] | None:
        """Return the writes that can be the last in a run, or None if there may be no write."""
        writes = {write.node: write for write in store.writes}
        last: dict[str, Write] = {}
        waiting = [node for node in self._game.nodes if not self._game.outgoing(node)]
        seen = {node.id for node in waiting}
        while waiting:
            node = waiting.pop()
            if node.id in writes:
                last[node.id] = writes[node.id]
                continue
            incoming = self._game.incoming(node)
            if node.kind is NodeKind.INITIAL or not incoming or any(e.marked for e in incoming):
                return None
            for edge in incoming:
                if edge.source not in seen:
                    seen.add(edge.source)
                    waiting.append(self._game.node(edge.source))
        return list(last.values())

    # -- assumptions -------------------------------------------------------------------------------

    def _describe_assumptions(self) -> str:
        """Return the assumptions; that single actions end is one sentence."""
        done = {node.origin: node for node in self._game.nodes if node.done is not None}
        endings: list[str] = []
        others: list[str] = []
        for conjunct in self._contract.assumptions:
            node = done.get(conjunct.origin)
            is_ending = node is not None and _is_ending(conjunct, node)
            if node is not None and is_ending and conjunct.is_derived and not conjunct.awaited:
                endings.append(_name(node))
            else:
                others.append(escape_markdown(conjunct.text))
        if endings:
            others.insert(0, f"Sooner or later, the environment ends {_join(endings)}.")
        return " ".join(others) or "Nothing."


def _is_ending(conjunct: Conjunct, node: TokenNode) -> bool:
    """Whether an assumption is only that an action ends."""
    names = {variable.name for variable in variables(conjunct.formula)}
    return conjunct.class_ is Class.LIVENESS and names == {node.run, *_names_in(node)}


def _names_in(node: TokenNode) -> set[str]:
    return set() if node.done is None else {variable.name for variable in variables(node.done)}


def _name(node: TokenNode) -> str:
    """Return the name of a step; only a step without name needs its kind."""
    kind, quote, name = node.label.partition(" '")
    has_plain_name = quote and kind in ("action", "structured node")
    return escape_markdown(f"'{name}" if has_plain_name else node.label)


def _join_sentences(sentences: Iterable[str]) -> str:
    return " ".join(sentence[:1].upper() + sentence[1:] for sentence in sentences)


def _list_variables(verb: str, listed: Sequence[Variable]) -> str:
    if not listed:
        return f"{verb} no feature."
    names = [f"{_quote(v.name)} ({_describe_values(v)})" for v in listed]
    return f"{verb} {_join(names)}."


def _describe_values(variable: Variable) -> str:
    conditions = [_quote(condition) for _, condition in describe_literals(variable)]
    return ", ".join(conditions) or escape_markdown(describe(variable.domain))


def _is_constant(write: Write) -> bool:
    """Whether a node always writes the same value."""
    return len(write.values) == 1 and isinstance(write.values[0][1], Const)


def _describe_value(write: Write) -> str:
    """Return the value that a node writes, as the author or the formula spells it."""
    if write.text:
        return _quote(write.text)
    texts = [
        _quote(print_formula(value))
        if condition == TRUE
        else f"{_quote(print_formula(value))} if {_quote(print_formula(condition))}"
        for condition, value in write.values
    ]
    return _join(texts, "or")


def _quote(text: str) -> str:
    return f"`{escape_code(text)}`"


def _join(texts: Sequence[str], word: str = "and") -> str:
    """Return a list in words: a, b and c."""
    *firsts, last = texts or [""]
    return f"{', '.join(firsts)} {word} {last}" if firsts else last
