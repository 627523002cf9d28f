"""Writers of models in the dialects of the tools, and models at random, for the tests."""
