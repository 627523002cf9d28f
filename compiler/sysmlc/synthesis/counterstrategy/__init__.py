"""Why a contract cannot be kept, shown: how the environment wins, whatever the system does."""
