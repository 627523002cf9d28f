"""sysmlc: a model transformation compiler for cyber-physical production systems."""

__version__ = "0.1.0"
