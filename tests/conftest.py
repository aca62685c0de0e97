"""Settings of all tests."""

from hypothesis.internal.conjecture import providers

# Hypothesis mixes constants of whatever local modules are imported into its examples. Then the examples of a test would
# depend on the tests that ran before it in the same process, and on lines that have nothing to do with it.
providers.is_local_module_file = lambda path: False
