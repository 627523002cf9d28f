"""Hostile and spoilt input: a guard that runs sysmlc within limits, and a fuzzer on top of it."""
