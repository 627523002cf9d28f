"""Random requirements, concerns, cases and views."""

from random_texts.behaviour import Scope, draw_action_body
from random_texts.drafts import Definition, Draft, Feature
from random_texts.expressions import (
    Variable,
    draw_expression,
    draw_type,
    list_globals,
    list_variables,
    refer_type,
)
from random_texts.structure import draw_notes


def _draw_subject(draft: Draft, part: Definition) -> tuple[str, str, list[Variable]]:
    """Return the name of a subject, its declaration, and the attributes that it offers."""
    name = draft.draw_name()
    features = [feature for feature in part.features if feature.kind != "hidden"]
    return name, f"subject {name} : {draft.refer(part)};", list_variables(features, f"{name}.")


def draw_requirement_definition(draft: Draft) -> Definition | None:
    """Draw a requirement definition with subject, attribute, assumptions and constraints."""
    part = draft.find("part def")
    if part is None:
        return None
    definition = draft.make_definition(
        draft.choose(["requirement def", "requirement def", "concern def"])
    )
    _, subject, variables = _draw_subject(draft, part)
    texts = [*draw_notes(draft, 0.5), subject]
    if draft.is_drawn(0.6):
        feature = Feature(draft.draw_name(), "attribute", draw_type(draft))
        definition.features.append(feature)
        texts.append(f"attribute {feature.name} : {refer_type(draft, feature.type)};")
        variables.append(Variable(feature.name, feature.type))
    person = draft.refer(part)
    for kind, probability in (("actor", 0.3), ("stakeholder", 0.3)):
        if draft.is_drawn(probability):
            texts.append(f"{kind} {draft.draw_name()} : {person};")
    texts += _draw_constraints(draft, variables)
    concern = draft.find("concern def")
    if concern is not None and draft.is_drawn(0.4):
        texts.append(f"frame concern {draft.draw_name()} : {draft.refer(concern)};")
    definition.type = part
    head = f"{definition.kind} {draft.identify(definition)}"
    return draft.add(definition, draft.make_block(head, texts))


def _draw_constraints(draft: Draft, variables: list[Variable]) -> list[str]:
    texts = []
    for kind in ("assume", "require", "require"):
        if draft.is_drawn(0.6):
            name = draft.join_drawn(0.4, f" {draft.draw_name()}")
            value = draw_expression(draft, "Boolean", variables)
            definition = draft.find("constraint def")
            if definition is not None and draft.is_drawn(0.2):
                # The names of the parameters may hide those of the variables.
                inputs = [
                    f"in {f.name} = {draw_expression(draft, f.type, list_globals(draft), 0)};"
                    for f in definition.features
                ]
                head = f"{kind} constraint{name} : {draft.refer(definition)}"
                texts.append(draft.make_block(head, inputs))
            else:
                texts.append(draft.make_block(f"{kind} constraint{name}", [value]))
    return texts


def draw_requirement_usage(draft: Draft) -> Definition | None:
    """Draw a requirement, with values for the attributes of its definition."""
    definition = draft.find("requirement def")
    if definition is None:
        return None
    usage = draft.make_definition("requirement usage")
    texts = draw_notes(draft, 0.3)
    for feature in definition.features:
        if draft.is_drawn(0.7):
            value = draw_expression(draft, feature.type, list_globals(draft), 1)
            texts.append(f"{draft.choose([':>> ', 'attribute :>> '])}{feature.name} = {value};")
    usage.type = definition.type
    head = f"requirement {draft.identify(usage)} : {draft.refer(definition)}"
    return draft.add(usage, draft.make_block(head, texts))


def draw_requirement_group(draft: Draft) -> None:
    """Draw a requirement that requires another one, or contains one."""
    requirement = draft.find("requirement usage")
    definition = draft.find("requirement def")
    if requirement is None or definition is None:
        return
    texts = [f"require {draft.refer(requirement)};"]
    texts.append(f"requirement {draft.draw_name()} : {draft.refer(definition)};")
    draft.add_member(draft.make_block(f"requirement {draft.draw_name()}", texts))


def draw_satisfaction(draft: Draft) -> None:
    """Draw a satisfaction of a requirement by a part of a package."""
    requirement = draft.find("requirement usage")
    if requirement is None:
        return
    part = draft.find("part usage", lambda usage: usage.type is requirement.type)
    if part is None:
        return
    reference, name = draft.refer(requirement), draft.draw_name()
    verb = draft.choose(["satisfy", "assert satisfy", "not satisfy", "assert not satisfy"])
    if draft.is_drawn(0.5):
        draft.add_member(f"{verb} {reference} by {draft.refer(part)};")
        return
    body = draft.choose([f"{verb} {reference};", f"satisfy {reference} by {name};"])
    draft.add_member(draft.make_block(f"part {name} : {draft.refer(requirement.type)}", [body]))


def draw_case(draft: Draft) -> None:
    """Draw a case, an analysis, a verification or a use case."""
    part = draft.find("part def")
    if part is None:
        return
    draft.choose([_draw_analysis, _draw_verification, _draw_use_case, _draw_plain_case])(
        draft, part
    )


def _draw_head(draft: Draft, keyword: str) -> str:
    return f"{keyword} {draft.choose(['def ', ''])}{draft.draw_name()}"


def _draw_analysis(draft: Draft, part: Definition) -> None:
    _, subject, variables = _draw_subject(draft, part)
    type_ = draft.choose(["Real", "Integer", "MassValue"])
    value = draw_expression(draft, type_, variables)
    typing = refer_type(draft, type_)
    result = draft.choose([[f"return : {typing};", value], [f"return r1 : {typing} = {value};"]])
    objective = draft.join_drawn(0.5, f"objective {draft.draw_name()} {{ doc /* why */ }}")
    texts = [subject, objective, *result]
    draft.add_member(draft.make_block(_draw_head(draft, "analysis"), texts))


def _draw_verification(draft: Draft, part: Definition) -> None:
    requirement = draft.find("requirement usage", lambda usage: usage.type is part)
    _, subject, _ = _draw_subject(draft, part)
    verify = [f"verify {draft.refer(requirement)};"] if requirement else ["doc /* nothing */"]
    texts = [subject, draft.make_block("objective", verify)]
    if draft.is_drawn(0.5):
        texts += draw_action_body(draft, Scope(), 1)
    kind = "VerificationCases::VerdictKind"
    verdict = draft.choose(["VerificationCases::PassIf(true)", f"{kind}::pass"])
    texts.append(draft.choose(["", f"return verdict : {kind} = {verdict};", verdict]))
    if draft.is_drawn(0.3):
        texts.insert(
            0,
            "metadata VerificationCases::VerificationMethod"
            " { kind = VerificationCases::VerificationMethodKind::test; }",
        )
    draft.add_member(draft.make_block(_draw_head(draft, "verification"), texts))


def _draw_use_case(draft: Draft, part: Definition) -> None:
    _, subject, _ = _draw_subject(draft, part)
    texts = [subject, f"actor {draft.draw_name()} : {draft.refer(part)};"]
    texts.append(draft.join_drawn(0.5, "objective { doc /* goal */ }"))
    other = draft.find("use case usage")
    if other is not None:
        texts.append(f"include {draft.refer(other)};")
    texts.append(draft.join_drawn(0.5, f"include use case {draft.draw_name()};"))
    if draft.is_drawn(0.4):
        texts += draw_action_body(draft, Scope(), 1)
    usage = draft.make_definition("use case usage")
    if draft.is_drawn(0.5):
        draft.add(usage, draft.make_block(f"use case {draft.identify(usage)}", texts))
    else:
        draft.add_member(draft.make_block(f"use case def {draft.draw_name()}", texts))


def _draw_plain_case(draft: Draft, part: Definition) -> None:
    _, subject, _ = _draw_subject(draft, part)
    texts = [
        subject,
        "objective { doc /* goal */ }",
        f"actor {draft.draw_name()} : {draft.refer(part)};",
    ]
    draft.add_member(draft.make_block(_draw_head(draft, "case"), texts))


_FILTERS = ("@SysML::PartUsage", "not @SysML::PortUsage", "@SysML::PartUsage or @SysML::ItemUsage")


def draw_view(draft: Draft) -> None:
    """Draw a viewpoint with a view definition and a view, or a view without a definition."""
    typing = _draw_view_definition(draft) if draft.is_drawn(0.5) else ""
    element = draft.find("part usage") or draft.find("part def")
    exposed = draft.refer(element) if element else draft.refer_library("SysML", "PartUsage")
    extent = draft.choose(["", "::*", "::**", "::*::**", "::*[@SysML::PartUsage]"])
    texts = [f"expose {exposed}{extent};"]
    texts.append(draft.join_drawn(0.4, f"filter {draft.choose(_FILTERS)};"))
    if not typing:
        rendering = f"render rendering {draft.draw_name()} : Views::TextualRendering;"
        texts.append(draft.choose(["", "render Views::asElementTable;", rendering]))
    draft.add_member(draft.make_block(f"view {draft.draw_name()}{typing}", texts))


def _draw_view_definition(draft: Draft) -> str:
    """Draw a viewpoint and a view definition for it; return the typing of a view."""
    concern = draft.find("concern def")
    viewpoint, name = draft.draw_name(), draft.draw_name()
    texts = [draft.choose(["doc /* concerns */", f"subject {draft.draw_name()};"])]
    if concern is not None:
        texts.append(f"frame concern {draft.draw_name()} : {draft.refer(concern)};")
    draft.add_member(draft.make_block(f"viewpoint def {viewpoint}", texts))
    texts = [
        f"viewpoint {draft.draw_name()} : {viewpoint};",
        "render Views::asTreeDiagram;",
        f"filter {draft.choose(_FILTERS)};",
    ]
    draft.add_member(draft.make_block(f"view def {name}", texts))
    return f" : {name}"
