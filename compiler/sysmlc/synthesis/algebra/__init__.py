"""What contracts say of one another: refinement, composition, consistency."""
