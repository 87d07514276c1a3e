"""Surfaces: two parameters u, w in [0, 1], points of the shape that u and w broadcast to, and (3,)."""
