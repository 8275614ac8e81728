"""Settings of the whole suite."""

import logging

import pytest
from hypothesis import settings

# Times vary with the machine; a slow example is no failure. Fixed examples make a red run repeatable.
settings.register_profile("rodloop", deadline=None, derandomize=True)
settings.load_profile("rodloop")


@pytest.fixture(autouse=True)
def _verbosity_ends_with_the_test():
    """The command line sets the level of the package's logger for its process; here that is the next test's too."""
    logger = logging.getLogger("rodloop_cli")
    level, handlers = logger.level, logger.handlers
    yield
    logger.setLevel(level)
    logger.handlers = handlers
