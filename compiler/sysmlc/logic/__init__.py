"""Logic: formulas, contracts, the expression grammar and the semantics of behaviour."""
