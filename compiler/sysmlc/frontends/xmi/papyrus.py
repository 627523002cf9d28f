"""Peculiarities of Papyrus and EMF: models split into files, and namespaces of profiles."""

from sysmlc.diagnostics import Subject, Verdict
from sysmlc.frontends.xmi import rules
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.document import Document
from sysmlc.ir import Element

# -- contained elements in files of their own ------------------------------------------------------


def is_contained_href(document: Document, row: int) -> bool:
    """Whether the row stands for an element that its owner contains in another file.

    MagicDraw writes packages of used projects in the same way, but always with an extension that
    names them: those are not contained in the model.
    """
    feature = document.features[row]
    if feature != "packagedElement" and not feature.startswith(("owned", "nested")):
        return False
    return document.ends[row] == row + 1 and "href" in document.attributes[row]


def join_contained_elements(context: Context) -> None:
    """Move the elements that other files hold for this document below their owner."""
    for row in context.contained_hrefs:
        owner = context.find_owner(row)
        if owner is None:
            continue
        element = _find_contained(context, row)
        problem = _find_problem(context, owner, element)
        if element is None or problem:
            _report(context, row, owner, problem)
        else:
            context.graph.move(element, owner)
            context.verdicts[row] = Verdict.MAPPED


def _find_contained(context: Context, row: int) -> Element | None:
    target = context.unit.find_target(context.file, context.document.href(row), True)
    if target is None or not target.element:
        return None
    return context.graph[target.element_id]


def _find_problem(context: Context, owner: Element, element: Element | None) -> str:
    """Return why the element cannot be moved below the owner, or the empty string."""
    if element is None:
        return "which no file of the compile unit has"
    if element.owner is not None:
        return "which belongs to another element"
    is_cycle = element is owner or element in context.graph.ancestors(owner)
    return "which it is in itself" if is_cycle else ""


def _report(context: Context, row: int, owner: Element, problem: str) -> None:
    name = context.graph.qualified_name(owner)
    href = context.document.href(row)
    subject = Subject(name, owner.id, context.locate(row))
    context.sink.report(rules.MISSING_PART, subject, owner=name, href=href, problem=problem)


# -- namespaces of profiles ------------------------------------------------------------------------


def record_ecore_namespaces(context: Context, row: int) -> None:
    """Record the namespaces of a profile; Papyrus writes them in an Ecore copy of the profile.

    *row* is the ``eAnnotations`` element that contains the copy.
    """
    package = context.element_ids[row]
    for inner in range(row + 1, context.document.ends[row]):
        uri = context.document.attributes[inner].get("nsURI")
        if uri and package:
            context.unit.profiles.add(uri, package)


def is_package_namespace(document: Document, row: int) -> bool:
    """Whether the row applies ``EPackage`` to a profile, which gives it a namespace."""
    return "nsURI" in document.attributes[row] and "base_Package" in document.attributes[row]


def record_applied_namespaces(context: Context) -> None:
    """Record the namespaces that applications of ``EPackage`` give profiles."""
    for row in context.applications:
        values = context.document.attributes[row]
        if is_package_namespace(context.document, row):
            package = context.unit.find_target_id(context.file, values["base_Package"], False)
            if package:
                context.unit.profiles.add(values["nsURI"], package)
