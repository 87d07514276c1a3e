"""Curves: one parameter u in [0, 1], points of shape u.shape + (3,)."""
