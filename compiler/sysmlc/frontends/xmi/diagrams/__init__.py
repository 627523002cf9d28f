"""Diagrams as their authors drew them, by the tool that keeps them."""
