"""Trees written as interchange files: unfolding, ids, hrefs, and what cannot be written."""

import re

import pytest
from lxml import etree
from v2_trees import outline, reading_file

from sysmlc.diagnostics import Sink
from sysmlc.language.interchange import interchange_path, link, read, write
from sysmlc.language.text import parse
from sysmlc.language.tree import Document, Node, Reference, Relation
from sysmlc.sources import Source

TYPE = "{http://www.w3.org/2001/XMLSchema-instance}type"
ID = "{http://www.omg.org/XMI}id"


def document(*members, path="m.sysml", language="sysml"):
    root = Node("Namespace")
    for member in members:
        root.add_member(member)
    return Document(path, language, root)


def made(kind, name=None, *members, membership="OwningMembership", **facts):
    node = Node(kind, name, membership=membership)
    node.attributes.update(facts)
    for member in members:
        node.add_member(member)
    return node


def relate(node, kind, *targets):
    reference = Reference(tuple((target.name or "?",) for target in targets))
    reference.set_targets(list(targets))
    node.relations.append(Relation(kind, reference))
    return node


def written(one, *others):
    sink = Sink()
    text = write(one, [one, *others], sink).decode()
    return text, [f"{found.rule.code} {found.message}" for found in sink]


def kinds(one):
    """The written elements, indented, without ids and relationships to others."""
    text, messages = written(one)
    assert messages == []
    return list(_kinds(etree.fromstring(text.encode()), 0))


def _kinds(element, depth):
    said = [f"{n}={v}" for n, v in element.items() if n[0] != "{" and not _is_id(v)]
    kind = element.get(TYPE, "sysml:Namespace").partition(":")[2]
    yield " ".join(["  " * depth + kind, *said])
    for inner in element:
        if inner.get("href") is None:
            yield from _kinds(inner, depth + 1)


def _is_id(value):
    return re.fullmatch(r"[0-9a-f-]{36}( [0-9a-f-]{36})*", value)


def literal(value, membership="ParameterMembership", role=""):
    return role_of(made("LiteralInteger", membership=membership, value=value), role)


def role_of(node, role):
    node.role = role
    return node


def test_members_get_their_memberships():
    part = made("PartUsage", "arm", membership="FeatureMembership")
    part.visibility = "private"
    assert kinds(document(made("PartDefinition", "Robot", part, isAbstract=True))) == [
        "Namespace",
        "  OwningMembership",
        "    PartDefinition declaredName=Robot isAbstract=true",
        "      FeatureMembership visibility=private",
        "        PartUsage declaredName=arm isComposite=true",
    ]


def test_arguments_get_parameters_and_results():
    plus = made("OperatorExpression", None, literal(1), literal(2), operator="+")
    assert kinds(document(plus))[2:] == [
        "    OperatorExpression operator=+",
        "      ParameterMembership",
        "        Feature direction=in",
        "          FeatureValue",
        "            LiteralInteger value=1",
        "      ParameterMembership",
        "        Feature direction=in",
        "          FeatureValue",
        "            LiteralInteger value=2",
        "      ReturnParameterMembership",
        "        Feature direction=out",
    ]


def test_what_is_evaluated_late_is_owned_by_a_reference():
    late = literal(2, role="expression")
    lines = kinds(document(made("OperatorExpression", None, literal(1), late, operator="and")))
    assert lines[7:13] == [
        "      ParameterMembership",
        "        Feature direction=in",
        "          FeatureValue",
        "            FeatureReferenceExpression",
        "              FeatureMembership",
        "                LiteralInteger value=2",
    ]


@pytest.mark.parametrize(
    ("role", "said"),
    [
        ("=", ""),
        (":=", " isInitial=true"),
        ("default", " isDefault=true"),
        ("default =", " isDefault=true"),
        ("default :=", " isDefault=true isInitial=true"),
    ],
)
def test_feature_values_say_their_sign(role, said):
    feature = made("Feature", "x", literal(1, "FeatureValue", role))
    assert kinds(document(feature))[3] == f"      FeatureValue{said}"


def test_port_definitions_get_conjugates_and_individuals_multiplicities():
    port = made("PortDefinition", "P")
    person = made("OccurrenceDefinition", "I", isIndividual=True)
    assert kinds(document(port, person))[2:] == [
        "    PortDefinition declaredName=P",
        "      OwningMembership",
        "        ConjugatedPortDefinition",
        "          PortConjugation",
        "  OwningMembership",
        "    OccurrenceDefinition declaredName=I isIndividual=true",
        "      OwningMembership",
        "        Multiplicity",
    ]


def test_chains_are_features_owned_by_the_relationship():
    a, b = made("Feature", "a"), made("Feature", "b")
    user = relate(made("Feature", "x"), "Subsetting", a, b)
    assert kinds(document(a, b, user))[6:] == [
        "    Feature declaredName=x",
        "      Subsetting",
        "        Feature",
        "          FeatureChaining",
        "          FeatureChaining",
    ]


def test_ends_are_ends_by_their_membership():
    end = made("ReferenceUsage", None, membership="EndFeatureMembership")
    other = made("ReferenceUsage", None, membership="EndFeatureMembership")
    lines = kinds(document(made("SuccessionAsUsage", None, end, other)))
    assert lines[3:] == ["      EndFeatureMembership", "        ReferenceUsage isEnd=true"] * 2


def test_references_within_the_file_are_ids():
    machine = made("PartDefinition", "Machine")
    robot = relate(made("PartDefinition", "Robot"), "Subclassification", machine)
    root = etree.fromstring(written(document(machine, robot))[0].encode())
    (relation,) = root.xpath("//*[@superclassifier]")
    definition, special = root.xpath("//ownedRelatedElement")
    assert relation.get("superclassifier") == definition.get(ID)
    assert relation.get("subclassifier") == special.get(ID)


def test_references_to_other_documents_are_hrefs():
    base = made("PartDefinition", "Machine")
    robot = relate(made("PartDefinition", "Robot"), "Subclassification", base)
    library = document(base, path="my library/Base Types.sysml")
    text, messages = written(document(robot, path="plant/robots.sysml"), library)
    assert messages == []
    assert 'href="../my%20library/Base%20Types.sysmlx#' in text


def test_an_import_refers_to_the_membership():
    thing = made("PartDefinition", "Thing")
    imported = relate(Node("MembershipImport", visibility="private"), "importedMembership", thing)
    root = etree.fromstring(written(document(thing, imported))[0].encode())
    (owned, imports) = root
    assert imports.get("importedMembership") == owned.get(ID)
    assert imports.get("visibility") == "private"


def test_a_conjugated_typing_refers_to_the_conjugate():
    port = made("PortDefinition", "P")
    usage = relate(made("PortUsage", "p"), "ConjugatedPortTyping", port)
    root = etree.fromstring(written(document(port, usage))[0].encode())
    (typing,) = root.xpath("//*[@conjugatedPortDefinition]")
    (conjugate,) = root.xpath(
        "//*[contains(@xsi:type, 'ConjugatedPortDefinition')]",
        namespaces={"xsi": TYPE[1:].partition("}")[0]},
    )
    assert typing.get("conjugatedPortDefinition") == conjugate.get(ID)


def test_a_reference_that_leads_nowhere_is_reported_and_left_out():
    robot = made("PartDefinition", "Robot")
    robot.relations.append(Relation("Subclassification", Reference((("Gone",),))))
    text, messages = written(document(robot))
    assert "Subclassification" not in text
    assert messages == [
        "SM758 'Gone' of 'Robot' is not in the interchange file, because the name is not resolved"
    ]


def test_characters_that_xml_cannot_have_are_reported_and_replaced():
    text, messages = written(document(made("Package", "form\ffeed")))
    assert 'declaredName="form\ufffdfeed"' in text
    assert messages == [
        "SM759 the 'declaredName' of 'form\ffeed' contains characters that XML does not "
        "allow: they are replaced"
    ]


def test_line_ends_and_markup_of_texts_come_back():
    body = "a < b & \"c\"\r\n\td 'e' \u00e9\n"
    text, messages = written(document(made("Comment", None, body=body)))
    again, told = reading_file(text)
    assert (messages, told) == ([], [])
    assert again.root.members[0].attributes["body"] == body


def test_ids_are_the_same_in_every_run_and_follow_names():
    first = written(document(made("Package", "P", made("PartDefinition", "A"))))[0]
    second = written(
        document(made("Package", "P", made("PartDefinition", "B"), made("PartDefinition", "A")))
    )[0]
    ids = [
        re.search(r'PartDefinition" xmi:id="([^"]+)"[^>]*declaredName="A"', text)[1]
        for text in (first, second)
    ]
    assert ids[0] == ids[1]
    assert first == written(document(made("Package", "P", made("PartDefinition", "A"))))[0]


def test_no_two_elements_have_one_id():
    twice = made("Package", "P", made("PartDefinition", "A"), made("PartDefinition", "A"))
    text = written(document(twice, made("Package", "P")))[0]
    ids = re.findall(r'xmi:id="([^"]+)"', text)
    assert len(ids) == len(set(ids)) == 9


def test_long_lists_are_written_and_read():
    nested = literal(0)
    for _ in range(1_000):
        nested = made(
            "OperatorExpression",
            None,
            literal(1),
            nested,
            membership="ParameterMembership",
            operator=",",
        )
    one = document(made("Feature", "x", role_of(nested, "=")))
    nested.membership = "FeatureValue"
    again, messages = reading_file(written(one)[0])
    assert messages == []
    assert len(list(again.root.walk())) == len(list(one.root.walk()))


@pytest.mark.parametrize(
    ("path", "language", "expected"),
    [
        ("a/b.sysml", "sysml", "a/b.sysmlx"),
        ("a.b/c", "kerml", "a.b/c.kermlx"),
        ("lib.kpar!Base.kerml", "kerml", "lib.kpar/Base.kermlx"),
    ],
)
def test_interchange_files_are_called_as_their_documents(path, language, expected):
    assert interchange_path(Document(path, language, Node("Namespace"))) == expected


# -- the library ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def library(corpus):
    """Files of the library as they are released, and their documents."""
    sink, folder = Sink(), corpus / "sysml2/interchange/xmi"
    paths = sorted(path for path in folder.rglob("*.*mlx"))
    sources = [Source(path.relative_to(folder).as_posix(), path.read_bytes()) for path in paths]
    documents = [read(source, sink) for source in sources]
    link(documents, sink)
    assert [found.message for found in sink] == []
    return sources, documents


@pytest.mark.corpus
def test_every_named_element_of_the_library_is_read(library):
    sources, documents = library
    assert len(sources) == 34
    for source, one in zip(sources, documents, strict=True):
        stated = [
            (element.get(TYPE)[6:], element.get("declaredName"))
            for element in etree.fromstring(source.data).iter("ownedRelatedElement")
            if element.get("declaredName") not in (None, "", "apayload")
        ]
        found = [
            (node.kind, node.name)
            for node in one.root.walk()
            if node.name and node.kind != "Membership" and node.name != "apayload"
        ]
        assert found == stated


@pytest.mark.long
@pytest.mark.corpus
def test_the_library_is_the_same_tree_when_written_and_read_again(library):
    sink, (_, documents) = Sink(), library
    again = [read(Source(one.path, write(one, documents, sink)), sink) for one in documents]
    link(again, sink)
    assert [found.message for found in sink] == []
    for before, after in zip(documents, again, strict=True):
        assert outline(after.root) == outline(before.root)


@pytest.mark.corpus
def test_ids_of_the_library_are_those_of_the_standard(library):
    """What has another id is an element with the name of what it implicitly redefines.

    Such a redefinition is no part of the files; where names are resolved it is known.
    """
    sink, (sources, documents) = Sink(), library
    same = other = 0
    for source, one in zip(sources, documents, strict=True):
        released = set(re.findall(rb'xmi:id="([^"]+)"', source.data))
        ours = set(re.findall(rb'xmi:id="([^"]+)"', write(one, documents, sink)))
        same += len(ours & released)
        other += len(ours - released)
    assert (same, other) == (14_774, 625)


@pytest.mark.long
@pytest.mark.corpus
def test_the_library_as_we_write_it_is_valid_for_the_metamodel(library, corpus, tmp_path):
    from pyecore.resources import URI, ResourceSet

    resources, sink = ResourceSet(), Sink()
    metamodel = corpus / "sysml2/interchange/metamodel/SysML.ecore"
    package = resources.get_resource(URI(str(metamodel))).contents[0]
    resources.metamodel_registry[package.nsURI] = package
    _, documents = library
    for one in documents[:12]:
        file = tmp_path / one.path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(write(one, documents, sink))
        (root,) = resources.get_resource(URI(str(file))).contents
        count = sum(1 for _ in root.eAllContents())
        assert count == file.read_text().count("xmi:id=") - 1


def test_what_is_left_out_is_told_at_its_byte_or_its_xml_element():
    text = "package 'Größe' { part def Robot :> Gone; }"
    sink = Sink()
    one = parse(text, "m.sysml", "sysml", Sink())
    write(one, [one], sink)
    (found,) = sink
    assert found.subject.place.offset == text.encode().index(b"part def")
    sink = Sink()
    node = made("PartDefinition", "Robot")
    node.start = 7
    node.relations.append(Relation("Subclassification", Reference((("Gone",),))))
    write(document(node, path="m.sysmlx"), [], sink)
    (found,) = sink
    assert (found.subject.place.ordinal, found.subject.place.offset) == (7, -1)
