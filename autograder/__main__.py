"""``python -m autograder`` is the command ``directrix``."""

from autograder.cli import main

main()
