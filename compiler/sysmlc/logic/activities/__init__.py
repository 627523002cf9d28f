"""Activities as token graphs: their analyses, their interpreter and their contracts."""
