"""Writing interchange files: unfolding of relationships, ids, hrefs, and losses."""

import re

import pytest
from interchange_files import list_messages, read_text
from lxml import etree
from official_models import load_xmi_sources, read_xmi_library
from tree_outlines import outline

from sysml_metamodel import count_ids, count_with_metamodel
from sysmlc.diagnostics import Sink
from sysmlc.language.interchange import link, read
from sysmlc.language.interchange.writer import interchange_path, write
from sysmlc.language.library import load_core
from sysmlc.language.names import resolve
from sysmlc.language.text import parse
from sysmlc.language.tree import Document, Node, Reference, Relation
from sysmlc.sources import Source

TYPE = "{http://www.w3.org/2001/XMLSchema-instance}type"
ID = "{http://www.omg.org/XMI}id"


def create_document(*members, path="m.sysml", language="sysml"):
    root = Node("Namespace")
    for member in members:
        root.add_member(member)
    return Document(path, language, root)


def create_node(kind, name=None, *members, membership="OwningMembership", role="", **attributes):
    node = Node(kind, name, membership=membership)
    node.role = role
    node.attributes.update(attributes)
    for member in members:
        node.add_member(member)
    return node


def create_literal(value, membership="ParameterMembership", role=""):
    return create_node("LiteralInteger", membership=membership, role=role, value=value)


def relate(node, kind, *targets):
    """Add a relation to the chain of *targets* and return *node*."""
    reference = Reference(tuple((target.name or "?",) for target in targets))
    reference.set_targets(list(targets))
    node.relations.append(Relation(kind, reference))
    return node


def write_text(document, *others):
    """Return the file of a document, and the messages about it."""
    sink = Sink()
    text = write(document, [document, *others], sink).decode()
    return text, list_messages(sink)


def list_written(document):
    """Return the written elements as indented lines, without ids and references."""
    text, messages = write_text(document)
    assert messages == []
    return list(_iter_lines(etree.fromstring(text.encode()), 0))


def _iter_lines(element, depth):
    attributes = [
        f"{name}={value}"
        for name, value in element.items()
        if not name.startswith("{") and not _is_list_of_ids(value)
    ]
    kind = element.get(TYPE, "sysml:Namespace").partition(":")[2]
    yield " ".join(["  " * depth + kind, *attributes])
    for child in element:
        if child.get("href") is None:
            yield from _iter_lines(child, depth + 1)


def _is_list_of_ids(value):
    return re.fullmatch(r"[0-9a-f-]{36}( [0-9a-f-]{36})*", value)


def test_members_are_written_within_memberships():
    part = create_node("PartUsage", "arm", membership="FeatureMembership")
    part.visibility = "private"
    assert list_written(
        create_document(create_node("PartDefinition", "Robot", part, isAbstract=True))
    ) == [
        "Namespace",
        "  OwningMembership",
        "    PartDefinition declaredName=Robot isAbstract=true",
        "      FeatureMembership visibility=private",
        "        PartUsage declaredName=arm isComposite=true",
    ]


def test_arguments_are_written_as_parameters_and_expressions_with_results():
    plus = create_node(
        "OperatorExpression", None, create_literal(1), create_literal(2), operator="+"
    )
    assert list_written(create_document(plus))[2:] == [
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


def test_an_operand_that_is_evaluated_conditionally_is_written_within_a_reference():
    second = create_literal(2, role="expression")
    lines = list_written(
        create_document(
            create_node("OperatorExpression", None, create_literal(1), second, operator="and")
        )
    )
    assert lines[7:13] == [
        "      ParameterMembership",
        "        Feature direction=in",
        "          FeatureValue",
        "            FeatureReferenceExpression",
        "              FeatureMembership",
        "                LiteralInteger value=2",
    ]


@pytest.mark.parametrize(
    ("role", "attributes"),
    [
        ("=", ""),
        (":=", " isInitial=true"),
        ("default", " isDefault=true"),
        ("default =", " isDefault=true"),
        ("default :=", " isDefault=true isInitial=true"),
    ],
)
def test_the_operator_of_a_feature_value_is_written_as_attributes(role, attributes):
    feature = create_node("Feature", "x", create_literal(1, "FeatureValue", role))
    assert list_written(create_document(feature))[3] == f"      FeatureValue{attributes}"


def test_port_definitions_have_conjugates_and_individuals_have_multiplicities():
    port = create_node("PortDefinition", "P")
    person = create_node("OccurrenceDefinition", "I", isIndividual=True)
    assert list_written(create_document(port, person))[2:] == [
        "    PortDefinition declaredName=P",
        "      OwningMembership",
        "        ConjugatedPortDefinition",
        "          PortConjugation",
        "  OwningMembership",
        "    OccurrenceDefinition declaredName=I isIndividual=true",
        "      OwningMembership",
        "        Multiplicity",
    ]


def test_a_chain_is_a_feature_owned_by_the_relationship():
    a, b = create_node("Feature", "a"), create_node("Feature", "b")
    user = relate(create_node("Feature", "x"), "Subsetting", a, b)
    assert list_written(create_document(a, b, user))[6:] == [
        "    Feature declaredName=x",
        "      Subsetting",
        "        Feature",
        "          FeatureChaining",
        "          FeatureChaining",
    ]


def test_members_of_end_memberships_are_ends():
    first = create_node("ReferenceUsage", None, membership="EndFeatureMembership")
    second = create_node("ReferenceUsage", None, membership="EndFeatureMembership")
    lines = list_written(create_document(create_node("SuccessionAsUsage", None, first, second)))
    assert lines[3:] == ["      EndFeatureMembership", "        ReferenceUsage isEnd=true"] * 2


def test_references_within_the_file_are_ids():
    machine = create_node("PartDefinition", "Machine")
    robot = relate(create_node("PartDefinition", "Robot"), "Subclassification", machine)
    root = etree.fromstring(write_text(create_document(machine, robot))[0].encode())
    (relation,) = root.xpath("//*[@superclassifier]")
    definition, specialisation = root.xpath("//ownedRelatedElement")
    assert relation.get("superclassifier") == definition.get(ID)
    assert relation.get("subclassifier") == specialisation.get(ID)


def test_references_to_other_documents_are_hrefs():
    base = create_node("PartDefinition", "Machine")
    robot = relate(create_node("PartDefinition", "Robot"), "Subclassification", base)
    library = create_document(base, path="my library/Base Types.sysml")
    text, messages = write_text(create_document(robot, path="plant/robots.sysml"), library)
    assert messages == []
    assert 'href="../my%20library/Base%20Types.sysmlx#' in text


def test_an_import_refers_to_the_membership():
    thing = create_node("PartDefinition", "Thing")
    member = relate(Node("MembershipImport", visibility="private"), "importedMembership", thing)
    root = etree.fromstring(write_text(create_document(thing, member))[0].encode())
    (membership, import_) = root
    assert import_.get("importedMembership") == membership.get(ID)
    assert import_.get("visibility") == "private"


def test_a_conjugated_typing_refers_to_the_conjugate():
    port = create_node("PortDefinition", "P")
    usage = relate(create_node("PortUsage", "p"), "ConjugatedPortTyping", port)
    root = etree.fromstring(write_text(create_document(port, usage))[0].encode())
    (typing,) = root.xpath("//*[@conjugatedPortDefinition]")
    (conjugate,) = root.xpath(
        "//*[contains(@xsi:type, 'ConjugatedPortDefinition')]",
        namespaces={"xsi": TYPE[1:].partition("}")[0]},
    )
    assert typing.get("conjugatedPortDefinition") == conjugate.get(ID)


def test_an_unresolved_reference_is_reported_and_omitted():
    robot = create_node("PartDefinition", "Robot")
    robot.relations.append(Relation("Subclassification", Reference((("Gone",),))))
    text, messages = write_text(create_document(robot))
    assert "Subclassification" not in text
    assert messages == [
        "SM758 'Gone' of 'Robot' is not in the interchange file, because the name is not resolved"
    ]


def test_characters_that_xml_does_not_allow_are_reported_and_replaced():
    text, messages = write_text(create_document(create_node("Package", "form\ffeed")))
    assert 'declaredName="form\ufffdfeed"' in text
    assert messages == [
        "SM759 the 'declaredName' of 'form\ffeed' contains characters that XML does not "
        "allow: they are replaced"
    ]


def test_line_ends_and_markup_of_texts_are_preserved():
    body = "a < b & \"c\"\r\n\td 'e' \u00e9\n"
    text, written_messages = write_text(create_document(create_node("Comment", None, body=body)))
    document, read_messages = read_text(text)
    assert (written_messages, read_messages) == ([], [])
    assert document.root.members[0].attributes["body"] == body


def write_package(*names):
    """Return the file of a package P with part definitions."""
    definitions = [create_node("PartDefinition", name) for name in names]
    return write_text(create_document(create_node("Package", "P", *definitions)))[0]


def test_ids_are_reproducible_and_depend_on_names():
    first, second = write_package("A"), write_package("B", "A")
    ids = [
        re.search(r'PartDefinition" xmi:id="([^"]+)"[^>]*declaredName="A"', text)[1]
        for text in (first, second)
    ]
    assert ids[0] == ids[1]
    assert first == write_package("A")


def test_every_element_has_an_id_of_its_own():
    definitions = [create_node("PartDefinition", "A") for _ in range(2)]
    package = create_node("Package", "P", *definitions)
    text = write_text(create_document(package, create_node("Package", "P")))[0]
    ids = re.findall(r'xmi:id="([^"]+)"', text)
    assert len(ids) == len(set(ids)) == 9


def test_a_sequence_of_1000_nested_operators_is_written_and_read():
    sequence = create_literal(0)
    for _ in range(1_000):
        sequence = create_node(
            "OperatorExpression",
            None,
            create_literal(1),
            sequence,
            membership="ParameterMembership",
            operator=",",
        )
    sequence.membership, sequence.role = "FeatureValue", "="
    before = create_document(create_node("Feature", "x", sequence))
    after, messages = read_text(write_text(before)[0])
    assert messages == []
    assert len(list(after.root.walk())) == len(list(before.root.walk()))


RELATIONSHIPS = """
    standard library package L { abstract class A; class B; feature f { feature g; } feature g; }
    class C :> L::A disjoint from L::B; class all D unions L::A, L::B intersects L::A, L::B;
    class E differences L::A, L::B; class F conjugates L::A;
    feature h : L::A [0..1] ordered nonunique :> L::f crosses L::f.g inverse of L::g;
    derived const feature i chains L::f.g featured by L::A; feature j :>> L::f; feature k ::> L::f;
    specialization S subtype L::A :> L::B; subclassifier L::A :> L::B; typing L::f : L::A;
    subset L::f :> L::g; redefinition L::f :>> L::g; conjugate L::A ~ L::B;
    disjoint L::A from L::B; inverse L::f of L::g; featuring of L::f by L::A;
    dependency from L::A to L::B; alias M for L::A; private import L::**;
    inv false n { true } feature o default := 1.5; feature p = "text"; composite feature q;
    comment locale "de" /* a */ rep language "c" /* b */ portion var feature r;
"""


def test_relationships_of_kerml_are_written_and_read():
    sink = Sink()
    before = parse(RELATIONSHIPS, "m.kerml", "kerml", sink)
    resolve([before], load_core(), sink)
    after = read(Source("m.kermlx", write(before, [before], sink)), sink)
    assert list_messages(sink) == []
    for node, copy in zip(before.root.walk(), after.root.walk(), strict=True):
        assert (node.kind, node.name, node.membership) == (copy.kind, copy.name, copy.membership)
        assert node.attributes == copy.attributes
        assert list_targets(node) == list_targets(copy)


def list_targets(node):
    targets = [(relation.kind, relation.reference.targets) for relation in node.relations]
    return [(kind, [target.name for target in links or ()]) for kind, links in targets]


@pytest.mark.parametrize(
    ("path", "language", "expected"),
    [
        ("a/b.sysml", "sysml", "a/b.sysmlx"),
        ("a.b/c", "kerml", "a.b/c.kermlx"),
        ("lib.kpar!Base.kerml", "kerml", "lib.kpar/Base.kermlx"),
    ],
)
def test_the_path_of_an_interchange_file_is_that_of_its_document(path, language, expected):
    assert interchange_path(Document(path, language, Node("Namespace"))) == expected


# -- the library ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def library():
    """The released files of the standard library, each with its document."""
    sources, documents = load_xmi_sources(), read_xmi_library()
    return list(zip(sources, documents, strict=True))


@pytest.mark.corpus
def test_every_named_element_of_the_library_is_read(library):
    assert len(library) == 34
    for source, document in library:
        expected = [
            (element.get(TYPE)[6:], element.get("declaredName"))
            for element in etree.fromstring(source.data).iter("ownedRelatedElement")
            if element.get("declaredName") not in (None, "", "apayload")
        ]
        elements = [
            (node.kind, node.name)
            for node in document.root.walk()
            if node.name and node.kind != "Membership" and node.name != "apayload"
        ]
        assert elements == expected


@pytest.mark.long
@pytest.mark.corpus
def test_the_library_has_the_same_trees_after_writing_and_reading(library):
    sink, documents = Sink(), [document for _, document in library]
    documents_again = [
        read(Source(document.path, write(document, documents, sink)), sink)
        for document in documents
    ]
    link(documents_again, sink)
    assert list_messages(sink) == []
    for before, after in zip(documents, documents_again, strict=True):
        assert outline(after.root) == outline(before.root)


@pytest.mark.corpus
def test_most_written_ids_of_the_library_are_those_of_the_release(library):
    """The others are ids of elements with the name of a feature that they implicitly redefine.

    Interchange files do not state such redefinitions; name resolution of texts adds them.
    """
    sink, documents = Sink(), [document for _, document in library]
    same = different = 0
    for source, document in library:
        released_ids = set(re.findall(rb'xmi:id="([^"]+)"', source.data))
        ids = set(re.findall(rb'xmi:id="([^"]+)"', write(document, documents, sink)))
        same += len(ids & released_ids)
        different += len(ids - released_ids)
    assert (same, different) == (14_774, 625)


@pytest.mark.long
@pytest.mark.corpus
def test_the_written_library_is_valid_for_the_metamodel(library, tmp_path, corpus):
    sink, documents = Sink(), [document for _, document in library]
    files = {
        document.path: write(document, documents, sink).decode() for document in documents[:12]
    }
    assert count_with_metamodel(files, tmp_path, corpus) == count_ids(files)


def test_a_loss_is_located_by_the_byte_of_the_text_or_by_the_ordinal_of_the_xml_element():
    text = "package 'Größe' { part def Robot :> Gone; }"
    sink = Sink()
    document = parse(text, "m.sysml", "sysml", Sink())
    write(document, [document], sink)
    (diagnostic,) = sink
    assert diagnostic.subject.place.offset == text.encode().index(b"part def")

    sink = Sink()
    node = create_node("PartDefinition", "Robot")
    node.start = 7
    node.relations.append(Relation("Subclassification", Reference((("Gone",),))))
    write(create_document(node, path="m.sysmlx"), [], sink)
    (diagnostic,) = sink
    assert (diagnostic.subject.place.ordinal, diagnostic.subject.place.offset) == (7, -1)
