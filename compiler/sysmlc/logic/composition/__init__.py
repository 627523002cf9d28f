"""Blocks with parts: what connectors, bindings and flows make of the contracts of their parts."""
