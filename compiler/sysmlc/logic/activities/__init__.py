"""Activities as token graphs: played, and derived to contracts."""
