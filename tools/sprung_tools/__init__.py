"""The Python behind the commands in tools/. The order of the subpackages is in pyproject.toml: each imports only from
those below it."""
