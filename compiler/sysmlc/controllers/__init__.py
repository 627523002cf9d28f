"""Values that react to steps: Mealy machines, tables, counter-strategies and monitors.

``synthesis`` builds them, and programs in other languages are printed from them.
"""
