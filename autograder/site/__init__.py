"""The walkthroughs as a static site: pages that need no Python, no server and no network.

run     executes a chapter once, with one solution of every gap and a mark typed into every guess
page    the pages: prose, formulas, code, figures, guesses whose answers wait, solutions folded away
build   the folder: built beside and put in its place whole
"""

from autograder.site.build import Built, Site, build

__all__ = ["Built", "Site", "build"]
