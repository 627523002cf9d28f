"""Composition of the contracts of parts by connectors, bindings and flows of their block."""
