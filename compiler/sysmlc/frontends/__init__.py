"""Front ends: each reads one family of files into the graph."""
