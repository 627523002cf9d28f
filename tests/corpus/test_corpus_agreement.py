"""A model has the same graph whichever tool saved it; every difference has a reason.

The tables are exact: a difference without a reason fails, and so does a reason that explains
another number of differences than it states.
"""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field

import pytest
from graph_agreement import Agreement, Difference
from reading_corpus import load_files, lower

from sysmlc.frontends.xmi.snapshots.libraries import split_file_parts

pytestmark = pytest.mark.corpus

Predicate = Callable[[Difference], bool]


@dataclass(frozen=True)
class Reason:
    """Why files differ, how often, and a predicate for these differences."""

    why: str
    count: int
    fits: Predicate


@dataclass(frozen=True)
class FilePair:
    """Two files with one model, and the reasons for their differences."""

    left: str
    right: str
    min_pairs: int
    """Number of pairs; readers may add more."""
    reasons: tuple[Reason, ...] = ()
    only_left: dict[str, int] = field(default_factory=dict)
    only_right: dict[str, int] = field(default_factory=dict)
    has_snapshots: bool = True
    """Whether to read the snapshots of profiles and libraries in a file.

    Only files that both have snapshots agree about the meaning of propair.
    """


def differs_in(name: str, *aspects: str) -> Predicate:
    return lambda d: d.left.name == name and d.aspect in aspects


def differs_in_tag(*names: str) -> Predicate:
    return lambda d: d.aspect.removeprefix("tag.") in names


FILE_PAIRS = {
    "fUML tests: MagicDraw, and its Eclipse export": FilePair(
        "magicdraw/fUML-Tests.mdxml",
        "papyrus/fUML-Tests.uml",
        min_pairs=1389,
        reasons=(
            Reason("MagicDraw calls the root Data, Eclipse Model", 1, differs_in("Data", "name")),
            Reason(
                "the mdxml is later: a pin has a new name",
                1,
                differs_in("Value(888).result", "name"),
            ),
            Reason(
                "the mdxml is later: an end belongs to a class now",
                1,
                differs_in("TestAssociation", "-> end"),
            ),
            Reason(
                "the mdxml is later: a flow leaves another action",
                1,
                lambda d: d.left.kind == "ObjectFlow" and d.aspect == "-> flow-source",
            ),
        ),
        # The mdxml is later: nine activities on streaming with a class, a package and an
        # association, and additions to the activities that test classes with two ends.
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
        # The earlier end of the association, and an import of the library of primitive types.
        only_right={"Import": 1, "Property": 1},
    ),
    "Tank control: project, and plain XML of a near revision": FilePair(
        "magicdraw/Tank_control_2.mdzip",
        "magicdraw/Tank_control_2.xml",
        min_pairs=1993,
        reasons=(
            Reason(
                "the project has a sequence diagram that the XML does not have yet",
                1,
                differs_in("TankControl-LocalCloud_DesignDescription", "-> classifier-behavior"),
            ),
        ),
        only_left={"Interaction": 1},
    ),
    "Ballot definition: with and without MagicDraw's extensions": FilePair(
        "magicdraw/BallotDefinition.xml",
        "magicdraw/BallotDefinition-noext.xml",
        has_snapshots=False,
        min_pairs=1034,
        reasons=(
            Reason(
                "only the extension identifies Real by its id in MagicDraw's own library",
                4,
                lambda d: (
                    d.left.name in ("Latitude", "Longitude") and d.aspect in ("-> typed-by", "role")
                ),
            ),
        ),
    ),
    "Ballot definition: MagicDraw, and its Eclipse export": FilePair(
        "magicdraw/BallotDefinition.xml",
        "md-eclipse-export/BallotDefinition.uml",
        has_snapshots=False,
        min_pairs=1028,
        reasons=(
            Reason(
                "Eclipse applies the profiles of all used projects",
                1,
                differs_in("Data", "-> applies"),
            ),
            Reason(
                "Eclipse drops the blank in the name of a tag, MagicDraw writes an underscore",
                18,
                differs_in_tag(
                    *("Table_Name", "Segment_Name", "Datatype_Name", "Message_Name"),
                    *("TableName", "SegmentName", "DatatypeName", "MessageName"),
                    *("Default_Value", "DefaultValue"),
                ),
            ),
            Reason(
                "Eclipse omits tags with their default value",
                7,
                lambda d: (
                    differs_in_tag("Repeatable", "Required", "Mappable")(d) and d.before == "false"
                ),
            ),
        ),
        # Applications of stereotypes whose names or profiles the export changes: XML Schema has
        # a blank, and «prim» is applied to elements of a package that the export includes.
        only_left={"Application": 6},
        only_right={"Import": 2, "Package": 3, "Application": 1},
    ),
}


def read_graph(corpus, name, has_snapshots=True):
    sources = load_files(corpus / "xmi" / name)
    if not has_snapshots:
        sources = split_file_parts(sources)[0]
    return lower(sources, ("resolve", "classify"))[0]


@pytest.mark.parametrize("pair", FILE_PAIRS.values(), ids=FILE_PAIRS)
def test_differences_of_two_files_with_one_model_have_reasons(corpus, pair):
    names = (pair.left, pair.right)
    agreement = Agreement(*(read_graph(corpus, name, pair.has_snapshots) for name in names))
    counts, unexplained = agreement.explain((reason.why, reason.fits) for reason in pair.reasons)
    assert unexplained == []
    assert counts == {reason.why: reason.count for reason in pair.reasons}
    assert agreement.count_pairs() >= pair.min_pairs
    assert agreement.measure_agreement() >= 0.99
    assert agreement.count_only_left() == Counter(pair.only_left)
    assert agreement.count_only_right() == Counter(pair.only_right)


SYSML_DIFFERENCES = {
    # 1.7 renames FlowDirection and FeatureDirection, and types texts by its own String.
    "Property -> typed-by": 11,
    "Property default_instance": 2,
    # 1.7 replaces the single bases of stereotypes by Abstraction, Class or Property, and removes
    # stereotypes from the tree of ElementPropertyPath.
    "Stereotype -> extends": 7,
    "Stereotype -> specializes": 3,
    # 1.7 inverts the derivation of ElementGroup and Stakeholder from comments.
    "Property derived": 2,
    "Property multiplicity": 2,
    # 1.7 has value properties instead of MagicDraw's composite ones, public properties instead of
    # private ones, and the effect of parameters.
    "Property aggregation": 6,
    "Property visibility": 4,
    "Parameter effect": 13,
    # Requirement became AbstractRequirement.
    "Parameter -> typed-by": 4,
    # The primitive value types specialise the primitive types of UML.
    "DataType -> specializes": 4,
    # The location of the profile and the profiles that it applies.
    "Profile -> applies": 1,
    "Profile uri": 1,
}
"""Differences between SysML 1.5, as MagicDraw exports it to Eclipse, and OMG's SysML 1.7."""


def test_magicdraws_and_omgs_profile_of_sysml_differ_as_the_standard_changed(corpus):
    """They share no ids and are two versions apart: elements are paired by name, without texts."""
    names = ("md-eclipse-export/SysML.profile.uml", "omg/SysML-1.7-ptc-24-01-02.xmi")
    agreement = Agreement(*(read_graph(corpus, name) for name in names))
    pairs = [agreement.left[left] for left in agreement.right_of]
    assert Counter(e.kind for e in pairs)["Stereotype"] >= 45
    differences = (
        d for d in agreement.differences if d.left.kind not in ("Comment", "Application")
    )
    assert Counter(f"{d.left.kind} {d.aspect}" for d in differences) == Counter(SYSML_DIFFERENCES)
