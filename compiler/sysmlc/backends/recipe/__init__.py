"""The back end ``recipe``: one JSON file a recipe, for schedulers and service executors."""

from sysmlc.backends.recipe.backend import RecipeBackend

BACKEND = RecipeBackend()

__all__ = ["BACKEND", "RecipeBackend"]
