"""KerML and SysML v2: text and interchange files as trees, names resolved, rules checked."""
