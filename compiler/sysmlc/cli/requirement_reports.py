"""Verdicts about the requirements of a model, as text and as a list for programs."""

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sysmlc.logic.requirements.stated_requirements import StatedRequirement
    from sysmlc.synthesis.contract_checks import CheckedContract
    from sysmlc.synthesis.requirement_verdicts import RequirementVerdict

_WORDS = {
    "holds": "holds",
    "holds-if-actions-end": "holds if its actions end",
    "broken": "broken",
    "not-decided": "not decided",
}
_NO_BEHAVIOUR = "'{component}' has no behaviour to check"


def describe_verdicts(result: "CheckedContract", is_verbose: bool) -> Iterator[str]:
    """Yield a line for each requirement of a component that does not simply hold.

    With *is_verbose* those that hold are shown, too.
    """
    from sysmlc.synthesis.witnesses import print_temporal

    for verdict in result.requirements:
        if is_verbose or verdict.answer != "holds":
            name = f"{verdict.conjunct.viewpoint}: " if verdict.conjunct.viewpoint else ""
            yield f"  {name}{_WORDS[verdict.answer]}: {print_temporal(verdict.conjunct)}"


def list_verdicts(
    requirements: "Sequence[StatedRequirement]", results: "Iterable[CheckedContract]"
) -> list[dict[str, object]]:
    """Return an entry for each conjunct of each requirement, in the order of the model."""
    verdicts: dict[tuple[str, str], list[RequirementVerdict]] = {}
    for result in results:
        for verdict in result.requirements:
            key = result.verdict.component, verdict.conjunct.origin
            verdicts.setdefault(key, []).append(verdict)
    return [
        entry
        for requirement in requirements
        for entry in _list_entries(
            requirement, verdicts.get((requirement.component, requirement.constraint), ())
        )
    ]


def _list_entries(
    requirement: "StatedRequirement", verdicts: "Sequence[RequirementVerdict]"
) -> Iterator[dict[str, object]]:
    from sysmlc.synthesis.witnesses import print_temporal

    for verdict in verdicts:
        trace = verdict.trace
        yield {
            "requirement": requirement.name,
            "component": requirement.component,
            "formula": print_temporal(verdict.conjunct),
            "verdict": str(verdict.answer),
            "witness": trace and {"steps": [*map(dict, trace.steps)], "loop": trace.loop},
            "reason": verdict.reason or None,
        }
    if not verdicts:
        yield {
            "requirement": requirement.name,
            "component": requirement.component or None,
            "formula": requirement.text,
            "verdict": "not-decided",
            "witness": None,
            "reason": requirement.reason or _NO_BEHAVIOUR.format(component=requirement.component),
        }
