"""The vocabulary of CAEX (IEC 62424): names, attributes and order of elements.

The reader and the writer of AutomationML share these tables, which agree with the XML schemas of
CAEX 2.15 and 3.0. CAEX 2.15 has no AttributeTypeLib, SourceDocumentInformation,
SourceObjectInformation and InterfaceIDMapping, CAEX 3.0 no InterfaceNameMapping. A MappingObject is
below an InternalElement in CAEX 2.15, and below a RoleRequirements in CAEX 3.0.
"""

NAMESPACE = "http://www.dke.de/CAEX"
"""The namespace of CAEX 3.0; elements of CAEX 2.15 have none."""

_OBJECT = frozenset({"ChangeMode"})
_NAMED = _OBJECT | {"Name", "ID"}
_CLASS = _NAMED | {"RefBaseClassPath"}
_VALUE = _NAMED | {"AttributeDataType", "RefAttributeType", "Unit"}
_NOTHING: frozenset[str] = frozenset()

ATTRIBUTES: dict[str, frozenset[str] | None] = {
    "CAEXFile": _OBJECT | {"FileName", "SchemaVersion"},
    "Description": _OBJECT,
    "Version": _OBJECT,
    "Revision": _OBJECT,
    "Copyright": _OBJECT,
    "AdditionalInformation": None,
    "SourceObjectInformation": frozenset({"OriginID", "SourceObjID"}),
    "RevisionDate": _NOTHING,
    "OldVersion": _NOTHING,
    "NewVersion": _NOTHING,
    "AuthorName": _NOTHING,
    "Comment": _NOTHING,
    "SuperiorStandardVersion": _NOTHING,
    "SourceDocumentInformation": frozenset(
        {
            "LastWritingDateTime",
            "OriginID",
            "OriginName",
            "OriginProjectID",
            "OriginProjectTitle",
            "OriginRelease",
            "OriginVendor",
            "OriginVendorURL",
            "OriginVersion",
        }
    ),
    "ExternalReference": _OBJECT | {"Alias", "Path"},
    "InstanceHierarchy": _NAMED,
    "InterfaceClassLib": _NAMED,
    "RoleClassLib": _NAMED,
    "SystemUnitClassLib": _NAMED,
    "AttributeTypeLib": _NAMED,
    "DefaultValue": None,
    "Value": None,
    "RefSemantic": _OBJECT | {"CorrespondingAttributePath"},
    "Constraint": _OBJECT | {"Name"},
    "OrdinalScaledType": _NOTHING,
    "NominalScaledType": _NOTHING,
    "UnknownType": _NOTHING,
    "RequiredMaxValue": None,
    "RequiredValue": None,
    "RequiredMinValue": None,
    "Requirements": _NOTHING,
    "Attribute": _VALUE,
    "AttributeType": _VALUE,
    "ExternalInterface": _CLASS,
    "InternalElement": _NAMED | {"RefBaseSystemUnitPath"},
    "SupportedRoleClass": _OBJECT | {"RefRoleClassPath"},
    "InternalLink": _NAMED | {"RefPartnerSideA", "RefPartnerSideB"},
    "RoleRequirements": _OBJECT | {"RefBaseRoleClassPath"},
    "MappingObject": _OBJECT,
    "AttributeNameMapping": _OBJECT | {"RoleAttributeName", "SystemUnitAttributeName"},
    "InterfaceIDMapping": _OBJECT | {"RoleInterfaceID", "SystemUnitInterfaceID"},
    "InterfaceNameMapping": _OBJECT | {"RoleInterfaceName", "SystemUnitInterfaceName"},
    "InterfaceClass": _CLASS,
    "RoleClass": _CLASS,
    "SystemUnitClass": _CLASS,
}
"""Attributes of each element; None for an element of ``xs:anyType``, which may have any.

The order of the elements agrees with every sequence of the schemas.
"""

ORDER = {tag: rank for rank, tag in enumerate(ATTRIBUTES)}
"""The rank of each element among its siblings."""

TEXTS = frozenset(
    {
        "Description",
        "Version",
        "RevisionDate",
        "OldVersion",
        "NewVersion",
        "AuthorName",
        "Comment",
        "Copyright",
        "SourceObjectInformation",
        "SuperiorStandardVersion",
        "Requirements",
        *(tag for tag, attributes in ATTRIBUTES.items() if attributes is None),
    }
)
"""Elements that hold text."""
