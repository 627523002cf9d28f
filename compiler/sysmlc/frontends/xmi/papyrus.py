"""Peculiarities of Papyrus and EMF: models split into files, and namespaces of profiles."""

from sysmlc.diagnostics import Subject, Verdict
from sysmlc.frontends.xmi import rules
from sysmlc.frontends.xmi.document import Document
from sysmlc.frontends.xmi.unit import File
from sysmlc.ir import Element, Graph

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


def join_contained_element(file: File, row: int) -> None:
    """Move the element that another file holds for this document below its owner."""
    owner = file.find_owner(row)
    if owner is None:
        return
    graph = file.unit.graph
    target = file.unit.find_target(file, file.document.href(row), True)
    element = target.element if target is not None else None
    problem = _find_problem(graph, owner, element)
    if element is None or problem:
        _report(file, row, owner, problem)
    else:
        graph.move(element, owner)
        file.verdicts[row] = Verdict.MAPPED


def _find_problem(graph: Graph, owner: Element, element: Element | None) -> str:
    """Return why the element cannot be moved below the owner, or the empty string."""
    if element is None:
        return "which no file of the compile unit has"
    if element.owner is not None:
        return "which belongs to another element"
    is_cycle = element is owner or element in graph.ancestors(owner)
    return "which it is in itself" if is_cycle else ""


def _report(file: File, row: int, owner: Element, problem: str) -> None:
    name = file.unit.graph.qualified_name(owner)
    href = file.document.href(row)
    subject = Subject(name, owner.id, file.locate(row))
    file.unit.sink.report(rules.MISSING_PART, subject, owner=name, href=href, problem=problem)


# -- namespaces of profiles ------------------------------------------------------------------------


def record_ecore_namespaces(file: File, row: int) -> None:
    """Record the namespaces of a profile; Papyrus writes them in an Ecore copy of the profile.

    *row* is the ``eAnnotations`` element that contains the copy.
    """
    package = file.element_ids[row]
    for inner in range(row + 1, file.document.ends[row]):
        uri = file.document.attributes[inner].get("nsURI")
        if uri and package:
            file.unit.profiles.add(uri, package)


def is_package_namespace(document: Document, row: int) -> bool:
    """Whether the row applies ``EPackage`` to a profile, which gives it a namespace."""
    return "nsURI" in document.attributes[row] and "base_Package" in document.attributes[row]


def record_applied_namespaces(file: File) -> None:
    """Record the namespaces that applications of ``EPackage`` give profiles."""
    for row in file.applications:
        values = file.document.attributes[row]
        if is_package_namespace(file.document, row):
            package = file.unit.find_target_id(file, values["base_Package"], False)
            if package:
                file.unit.profiles.add(values["nsURI"], package)
