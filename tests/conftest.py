"""Settings of the whole suite."""

from hypothesis import settings

# Times vary with the machine; a slow example is no failure. Fixed examples make a red run repeatable.
settings.register_profile("rodloop", deadline=None, derandomize=True)
settings.load_profile("rodloop")
