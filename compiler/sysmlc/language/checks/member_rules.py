"""Constraints of the specification about what may be a member of what."""

from sysmlc.language.checks.found import error

VARIANT_ELSEWHERE = error(
    "SM226",
    "variant-elsewhere",
    "'{name}' is a variant, and '{owner}' is no variation",
    "Variants are the choices of a variation (validateVariantMembershipOwningNamespace).",
    "write 'variation' before '{owner}', or leave 'variant' out",
    "part def Engine { variant part small; }\n",
    "variation part def Engine { variant part small; }\n",
)
NO_VARIANT = error(
    "SM227",
    "variation-member",
    "'{name}' is a member of the variation '{owner}' and no variant",
    "All usages in a variation are its variants (SysML 2.0, "
    "validateUsageVariationOwnedFeatureMembership).",
    "write 'variant' before '{name}'",
    "variation part def Engine { part small; }\n",
    "variation part def Engine { variant part small; }\n",
)
VARIATION_OF_VARIATION = error(
    "SM228",
    "variation-of-variation",
    "the variation '{name}' specialises another variation",
    "The choices of a variation are closed (SysML 2.0, validateUsageVariationSpecialization).",
    "specialise what is no variation",
    "variation part def Engine;\nvariation part def Big :> Engine;\n",
    "part def Engine;\nvariation part def Big :> Engine;\n",
)
VERIFY_ELSEWHERE = error(
    "SM229",
    "verify-elsewhere",
    "'{owner}' is not the objective of a verification, so it cannot verify '{name}'",
    "What a verification case verifies stands in its objective (SysML 2.0, "
    "validateRequirementVerificationMembershipOwningType).",
    "move 'verify' into the objective of a verification case",
    "requirement r;\nverification v { requirement o { verify r; } }\n",
    "requirement r;\nverification v { objective o { verify r; } }\n",
)
PARALLEL = error(
    "SM230",
    "parallel-succession",
    "'{owner}' is parallel: its states have no order",
    "The states of a parallel state are active together (SysML 2.0, "
    "validateStateUsageParallelSubactions).",
    "remove 'parallel', or the succession or transition",
    "state def Running parallel { state a; state b; transition first a then b; }\n",
    "state def Running { state a; state b; transition first a then b; }\n",
)
PORTION_ELSEWHERE = error(
    "SM231",
    "portion-elsewhere",
    "'{name}' is a portion of no occurrence",
    "Snapshots and time slices are portions of the occurrence that has them (SysML 2.0, "
    "validateOccurrenceUsageIsPortion).",
    "move it into an occurrence, item or part",
    "snapshot part broken;\n",
    "part gate { snapshot part broken; }\n",
)
END_NO_PORT = error(
    "SM232",
    "interface-end-no-port",
    "'{name}' is an end of the interface '{owner}' and no port",
    "Interfaces connect ports (SysML 2.0, validateInterfaceDefinitionEnd and ...UsageEnd).",
    "make it a port, or use a connection",
    "interface def Plug { end part a; end port b; }\n",
    "interface def Plug { end port a; end port b; }\n",
)
TOO_MANY_ENDS = error(
    "SM233",
    "flow-ends",
    "'{name}' is the third end of the flow '{owner}'",
    "A flow goes from one end to another (SysML 2.0, validateFlowDefinitionFlowEnds).",
    "keep two ends",
    "flow def Supply { end a; end b; end c; }\n",
    "flow def Supply { end a; end b; }\n",
)
ABSTRACT_METADATA = error(
    "SM234",
    "abstract-metadata",
    "metadata '{name}' has an abstract type",
    "Metadata is an instance of its type (KerML 1.0, validateMetadataFeatureMetaclassNotAbstract).",
    "use a metadata definition that is not abstract",
    "abstract metadata def M;\npart def P { @M; }\n",
    "metadata def M;\npart def P { @M; }\n",
)
ENUMERATION_AND_MORE = error(
    "SM235",
    "enumeration-and-more",
    "attribute '{name}' has an enumeration and another type",
    "The values of an enumeration are closed (SysML 2.0, validateAttributeUsageEnumerationType).",
    "keep one type",
    "enum def E { a; }\nattribute def A;\nattribute x : E, A;\n",
    "enum def E { a; }\nattribute def A;\nattribute x : E;\n",
)
