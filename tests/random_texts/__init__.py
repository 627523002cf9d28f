"""Random models in the textual notation of SysML v2 that are valid by construction."""
