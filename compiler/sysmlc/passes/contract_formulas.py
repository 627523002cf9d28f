"""Constraints written in LTL, as conjuncts of the contracts of what they constrain."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic import formula as f
from sysmlc.logic.classes import classified
from sysmlc.logic.contract import Class, Conjunct, Contract, Owner
from sysmlc.logic.formula import Formula
from sysmlc.logic.texts.formal import is_formal, read_formal, told
from sysmlc.values import replace

_MACHINE = """\
Class c "Lamp"
  -> classifier-behavior m
  StateMachine m "M"
    Region r
      Pseudostate i subkind="initial"
      State a "Off"
      State b "On"
      Transition t0
        -> flow-source i
        -> flow-target a
      Transition t1
        -> flow-source a
        -> flow-target b
        -> trigger g
        Trigger g subkind="signal"
          -> typed-by s
  Constraint k "Lit" language="LTL" body={body}
Signal s "start"
"""

NOT_A_FORMULA = rule(
    "SM501",
    "formula-not-understood",
    Severity.ERROR,
    "the formula of '{constraint}' is not understood: {reason}",
    why="What it demands would be missing in the contract.",
    help="write LTL (G F X U or [] <> X U; of the past Y O H S), or a sentence like 'globally, it "
    "is always the case that if P holds then Q eventually holds', over: {variables}",
    wrong=_MACHINE.replace("{body}", '"[](Statte=On)"'),
    right=_MACHINE.replace("{body}", '"[](<>(state=On))"'),
)
NO_CONTRACT = rule(
    "SM502",
    "formula-without-contract",
    Severity.WARNING,
    "'{constraint}' is a formula about '{component}', which has no behaviour with a contract",
    why="A formula in temporal logic speaks of the variables of a behaviour.",
    help="give '{component}' a classifier behaviour, or move the formula to what has one",
    wrong='Class c "Lamp"\n  Constraint k "Lit" language="LTL" body="[](<>on)"\n',
    right=_MACHINE.replace("{body}", '"[](<>(state=On))"'),
)
OUTSIDE_GR1 = rule(
    "SM503",
    "formula-outside-gr1",
    Severity.INFO,
    "the formula of '{constraint}' is not in GR(1); the contract keeps it as general LTL",
    why="Synthesis decides initial, one-step and infinitely-often conditions, and what can be said "
    "by them with history bits; the rest can only be checked.",
    wrong=_MACHINE.replace("{body}", '"<>[](state=On)"'),
    right=_MACHINE.replace("{body}", '"[](event=start -> <>(state=On))"'),
)


def add_formulas(graph: Graph, contracts: list[Contract], sink: Sink) -> list[Contract]:
    """The contracts with the formulas of the model's constraints as further conjuncts."""
    made = {contract.component: contract for contract in contracts}
    for constraint in graph.of_kind(Kind.CONSTRAINT):
        if not _is_formula(constraint):
            continue
        for component in _components(graph, constraint):
            if component in made:
                made[component] = _with_formula(graph, made[component], constraint, sink)
            else:
                _report_orphan(graph, constraint, component, sink)
    return list(made.values())


def _is_formula(constraint: Element) -> bool:
    body = str(constraint.attrs.get("body", ""))
    return bool(body) and is_formal(str(constraint.attrs.get("language", "")), body)


def _components(graph: Graph, constraint: Element) -> Iterator[str]:
    """Names of the components that a constraint speaks of, each once.

    What a requirement demands is no part of a behaviour (``logic.requirements``).
    """
    owner = graph.owner(constraint)
    subjects = graph.targets(constraint, Edge.REFERENCES) or ([] if owner is None else [owner])
    about = (one for one in subjects if not query.is_requirement(one))
    yield from dict.fromkeys(query.component_name(graph, one) for one in about)


def _report_orphan(graph: Graph, constraint: Element, component: str, sink: Sink) -> None:
    name = constraint.name or "<Constraint>"
    sink.report(NO_CONTRACT, graph.subject(constraint), constraint=name, component=component)


def _with_formula(graph: Graph, contract: Contract, constraint: Element, sink: Sink) -> Contract:
    from sysmlc.logic.reduction.reduce import is_reducible, remembering
    from sysmlc.logic.spelling import FormulaError

    name = constraint.name or "<Constraint>"
    domains = {variable.name: variable.domain for variable in contract.variables}
    subject = graph.subject(constraint)
    body = str(constraint.attrs["body"])
    try:
        formula = read_formal(body, str(constraint.attrs["language"]), domains)
    except FormulaError as error:
        known, facts = ", ".join(domains), told(error, body)
        sink.report(NOT_A_FORMULA, subject, constraint=name, reason=facts, variables=known)
        return contract
    conjuncts = [
        Conjunct(part, class_, constraint.id, f"'{name}' demands it.")
        for class_, part in classified(formula)
    ]
    if any(one.class_ is Class.OTHER and not is_reducible(one.formula) for one in conjuncts):
        sink.report(OUTSIDE_GR1, subject, constraint=name)
    return remembering(_extended(contract, conjuncts))


def _extended(contract: Contract, conjuncts: list[Conjunct]) -> Contract:
    """What speaks of inputs alone is an assumption, everything else a guarantee."""
    assumed = [one for one in conjuncts if _is_about_inputs(contract, one.formula)]
    promised = [one for one in conjuncts if one not in assumed]
    return replace(
        contract,
        assumptions=(*contract.assumptions, *assumed),
        guarantees=(*contract.guarantees, *promised),
    )


def _is_about_inputs(contract: Contract, formula: Formula) -> bool:
    owners = {variable.name: variable.owner for variable in contract.variables}
    used = [owners[variable.name] for variable in f.variables(formula)]
    return bool(used) and all(owner is Owner.ENVIRONMENT for owner in used)
