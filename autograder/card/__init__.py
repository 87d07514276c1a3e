"""The verdict card: what a learner reads in a notebook and in the feedback, as HTML and as plain text, and the figure below it.

The HTML is a fragment without script, link, class or id, styled inline, so that JupyterLab's sanitiser and nh3 leave it whole
(``STYLE_PROPERTIES`` names all it uses). Its ground is translucent and its text inherits the page's colour, so it reads on a
light page and on a dark one; the outcome is said by a word and a sign as well. The text alone suffices. No points stand on a
card: a mark given later by hand would contradict it.

content    what it says: outcome, parts, and the table of data sets, in words
rendering  these as HTML and as plain text
drawing    the figure of both surfaces
"""

from autograder.card.content import LETTERS as LETTERS
from autograder.card.content import LONGEST as LONGEST
from autograder.card.content import LONGEST_NOTE as LONGEST_NOTE
from autograder.card.content import OUTCOMES as OUTCOMES
from autograder.card.content import SIGNS as SIGNS
from autograder.card.content import Card as Card
from autograder.card.content import of as of
from autograder.card.content import with_parts as with_parts
from autograder.card.content import word_of as word_of
from autograder.card.content import worth as worth
from autograder.card.drawing import FIGURE_KINDS as FIGURE_KINDS
from autograder.card.drawing import FIGURE_NUMBERS as FIGURE_NUMBERS
from autograder.card.drawing import PLOTLY as PLOTLY
from autograder.card.drawing import figure as figure
from autograder.card.drawing import figure_bundle as figure_bundle
from autograder.card.drawing import validated as validated
from autograder.card.rendering import SHORT as SHORT
from autograder.card.rendering import STYLE_PROPERTIES as STYLE_PROPERTIES
from autograder.card.rendering import bundle as bundle
from autograder.card.rendering import html as html
from autograder.card.rendering import text as text
