"""The comment in which a saved model stores facts that its format cannot express.

The back end ``uml`` writes it, and the pass ``kept`` restores the facts.
"""

PREFIX = "sysmlc-kept/1 "
"""Start of the body; JSON follows (metamodels/sysmlc-kept.schema.json)."""
