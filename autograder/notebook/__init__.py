"""Notebooks: built from text, read from a submission, run in the sandbox, marked."""
