"""Controllers: strategies of won games, as machines or tables, and their verification."""
