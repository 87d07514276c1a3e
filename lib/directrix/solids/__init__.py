"""Solids: three parameters u, v, w in [0, 1], a bounded piece of space with six boundary patches."""
