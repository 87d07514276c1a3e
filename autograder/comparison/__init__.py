"""How two answers are compared, from their values at sample points only.

symmetry   the relabellings of the parameter domain: 2 for a curve, 8 for a surface, 48 for a solid
samples    the parameters at which answers are asked for, and every form in which they are handed over
answers    what came back: an array, a word, a tuple, or a reason why it is none of these
target     the reference on one data set: its values, its size, its mistakes, its relabelled selves
maps       the cheap rungs for maps of the square: identical, relabelled, other start, close
nearest    the nearest places of a black-box map
sets       the dear rungs: same set, covered several times, part, more
motion     the same map moved, turned, mirrored, scaled
moved_set  the same set moved and traced in another way
values     the rungs for numbers, nets, bases, masks and words
asking     the planned calls of a learner's function
probing    a learner's map as a black box, within a budget, for the dear rungs
gates      what stops a comparison before it starts: shapes, finite, pointwise, repeatable

Nothing here speaks to a learner: findings are keys of the message catalogue with the facts that fill them in.
"""
