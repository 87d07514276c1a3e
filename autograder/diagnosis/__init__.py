"""From compared values to what a learner reads.

ladder     the rung that each data set reaches, and the known mistake that explains all of them
places     where a map is right and where it is not, and rules for its coordinates
explain    the message: what is right, what is wrong, where, one thing to look at
wording    findings put into words
figure     the samples behind the comparison picture
"""
