"""One model that several tools or settings saved is one graph; what differs has a reason here.

The tables are checked exactly: a difference that no reason explains fails, and so does a reason
that explains another number of differences than it says.
"""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field

import pytest
from agreement import Agreement, Difference

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.frontends.xmi.snapshots.libraries import split_file_parts
from sysmlc.ir import Graph
from sysmlc.passes import pipeline
from sysmlc.sources import load

pytestmark = pytest.mark.corpus

Test = Callable[[Difference], bool]


@dataclass(frozen=True)
class Reason:
    """Why files differ, how often, and how such a difference is told."""

    why: str
    count: int
    fits: Test


@dataclass(frozen=True)
class Set:
    """Two files with one model, and in what they differ for which reasons."""

    left: str
    right: str
    at_least: int
    """Pairs; those that later readers add are welcome."""
    reasons: tuple[Reason, ...] = ()
    only_left: dict[str, int] = field(default_factory=dict)
    only_right: dict[str, int] = field(default_factory=dict)
    has_snapshots: bool = True
    """Whether to read the snapshots of profiles and libraries that a file has inside: only
    files that both have them say the same of what the profiles mean."""


def of(name: str, *aspects: str) -> Test:
    return lambda d: d.left.name == name and d.aspect in aspects


def tag(*names: str) -> Test:
    return lambda d: d.aspect.removeprefix("tag.") in names


SETS = {
    "fUML tests: MagicDraw, and its Eclipse export": Set(
        "magicdraw/fUML-Tests.mdxml",
        "papyrus/fUML-Tests.uml",
        at_least=1389,
        reasons=(
            Reason("MagicDraw calls the root Data, Eclipse Model", 1, of("Data", "name")),
            Reason("the mdxml is later: a pin has a new name", 1, of("Value(888).result", "name")),
            Reason(
                "the mdxml is later: an end belongs to a class now",
                1,
                of("TestAssociation", "-> end"),
            ),
            Reason(
                "the mdxml is later: a flow leaves another action",
                1,
                lambda d: d.left.kind == "ObjectFlow" and d.aspect == "-> flow-source",
            ),
        ),
        # Later: nine activities on streaming with a class, a package and an association, and
        # additions to the activities that test classes with two ends.
        only_left={
            "Activity": 9,
            "ObjectFlow": 7,
            "Action": 3,
            "Property": 3,
            "Pin": 2,
            "Parameter": 2,
            "ActivityParameter": 2,
            "Association": 1,
            "Class": 1,
            "Comment": 1,
            "Control": 1,
            "Package": 1,
        },
        # The end of the association, as it was; and an import of the library of primitive types.
        only_right={"Import": 1, "Property": 1},
    ),
    "Tank control: project, and plain XML of a near revision": Set(
        "magicdraw/Tank_control_2.mdzip",
        "magicdraw/Tank_control_2.xml",
        at_least=1993,
        reasons=(
            Reason(
                "the project has a sequence diagram that the XML does not have yet",
                1,
                of("TankControl-LocalCloud_DesignDescription", "-> classifier-behavior"),
            ),
        ),
        only_left={"Interaction": 1},
    ),
    "Ballot definition: with and without MagicDraw's extensions": Set(
        "magicdraw/BallotDefinition.xml",
        "magicdraw/BallotDefinition-noext.xml",
        has_snapshots=False,
        at_least=1034,
        reasons=(
            Reason(
                "only the extension says that the id in MagicDraw's own library is Real's",
                4,
                lambda d: (
                    d.left.name in ("Latitude", "Longitude") and d.aspect in ("-> typed-by", "role")
                ),
            ),
        ),
    ),
    "Ballot definition: MagicDraw, and its Eclipse export": Set(
        "magicdraw/BallotDefinition.xml",
        "md-eclipse-export/BallotDefinition.uml",
        has_snapshots=False,
        at_least=1028,
        reasons=(
            Reason(
                "Eclipse applies the profiles of all used projects", 1, of("Data", "-> applies")
            ),
            Reason(
                "Eclipse drops the blank in the name of a tag, MagicDraw writes an underscore",
                18,
                tag(
                    *("Table_Name", "Segment_Name", "Datatype_Name", "Message_Name"),
                    *("TableName", "SegmentName", "DatatypeName", "MessageName"),
                    *("Default_Value", "DefaultValue"),
                ),
            ),
            Reason(
                "Eclipse leaves out tags that have their default",
                7,
                lambda d: tag("Repeatable", "Required", "Mappable")(d) and d.before == "false",
            ),
        ),
        # Applications of stereotypes whose names or profiles the export changes: XML Schema has
        # a blank, and «prim» is applied to elements of a package that the export includes.
        only_left={"Application": 6},
        only_right={"Import": 2, "Package": 3, "Application": 1},
    ),
}


def graph(corpus, name, has_snapshots=True):
    path = corpus / "xmi" / name
    sources = load(path, path.name)
    made, sink = Graph(), Sink()
    FRONTEND.read(
        sources if has_snapshots else split_file_parts(sources)[0], made, sink, Coverage()
    )
    pipeline.build_pipeline(("resolve", "classify")).run(made, sink)
    return made


@pytest.mark.parametrize("one", SETS.values(), ids=SETS)
def test_two_files_of_one_model_agree(corpus, one):
    names = (one.left, one.right)
    agreement = Agreement(*(graph(corpus, name, one.has_snapshots) for name in names))
    counts, unexplained = agreement.explained(
        (reason.why, lambda _, d, fits=reason.fits: fits(d)) for reason in one.reasons
    )
    assert unexplained == []
    assert counts == {reason.why: reason.count for reason in one.reasons}
    assert agreement.shared() >= one.at_least
    assert agreement.equal() >= 0.99
    assert agreement.only_left() == Counter(one.only_left)
    assert agreement.only_right() == Counter(one.only_right)


SYSML = {
    # 1.7 renames FlowDirection and FeatureDirection, and types texts by its own String.
    "Property -> typed-by": 11,
    "Property default_instance": 2,
    # 1.7 turns stereotypes that had one base each into ones of Abstraction, Class or Property,
    # and takes others out of the tree of ElementPropertyPath.
    "Stereotype -> extends": 7,
    "Stereotype -> specializes": 3,
    # 1.7 derives ElementGroup and Stakeholder from comments the other way round.
    "Property derived": 2,
    "Property multiplicity": 2,
    # 1.7 has value properties where MagicDraw exports composite ones, public ones where it has
    # private ones, and the effect of parameters.
    "Property aggregation": 6,
    "Property visibility": 4,
    "Parameter effect": 13,
    # Requirement became AbstractRequirement.
    "Parameter -> typed-by": 4,
    # The primitive value types specialise the primitive types of UML.
    "DataType -> specializes": 4,
    # Where the profile is kept and what it applies.
    "Profile -> applies": 1,
    "Profile uri": 1,
}
"""Differences of SysML 1.5, as MagicDraw exports it to Eclipse, and OMG's 1.7: the standard's."""


def test_the_profile_of_sysml_as_magicdraw_exports_it_and_as_omg_publishes_it(corpus):
    """They share no ids and are two versions apart: compared by qualified name, without texts."""
    names = ("md-eclipse-export/SysML.profile.uml", "omg/SysML-1.7-ptc-24-01-02.xmi")
    agreement = Agreement(*(graph(corpus, name) for name in names))
    pairs = [agreement.left[left] for left in agreement.right_of]
    assert Counter(e.kind for e in pairs)["Stereotype"] >= 45
    told = (d for d in agreement.differences if d.left.kind not in ("Comment", "Application"))
    assert Counter(f"{d.left.kind} {d.aspect}" for d in told) == Counter(SYSML)
