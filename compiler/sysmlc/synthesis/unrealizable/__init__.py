"""Why a contract cannot be kept: the core of its guarantees, and what assumptions would help."""
