"""Relations and operations of contracts: refinement, composition, consistency."""
