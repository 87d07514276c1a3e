"""One fixed Hypothesis profile for the library: the same examples every time, so that a failure is a failure for everyone."""

from hypothesis import settings

settings.register_profile("fixed", derandomize=True, deadline=None, max_examples=40, database=None)
settings.load_profile("fixed")
