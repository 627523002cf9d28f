"""Hostile and mutated input: a fork server that runs sysmlc within limits, and a fuzzer."""
