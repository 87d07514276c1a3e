# %% [markdown]
# # A9 · Further
#
# **Sixteen tasks, each of which stands alone: which will you take?**

# %% setup=true

# %% [markdown]
# **Task (quadric_value).** Which side of a quadric?


# %% solution="quadric_value"
def quadric_value(coeffs, X):
    """Return the value of the quadric's equation at points: 0 on the surface, of one sign inside, of the other outside."""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="quadric_value"
check(quadric_value)

# %% [markdown]
# **Task (quadric_class).** Which quadric is it?


# %% solution="quadric_class"
def quadric_class(coeffs):
    """Return the name of the surface A x² + B y² + C z² + D xy + E yz + F zx + G x + H y + J z + K = 0."""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="quadric_class"
check(quadric_class)

# %% [markdown]
# **Task (screw_sweep).** Screw sweep about x


# %% solution="screw_sweep"
def screw_sweep(u, w, curve, pitch, turns):
    """Return the points of the surface that a curve sweeps when it is screwed along the x axis."""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="screw_sweep"
check(screw_sweep)

# %% [markdown]
# **Task (corners_agree).** Do four curves bound a patch?


# %% solution="corners_agree"
def corners_agree(c0, c1, d0, d1, rtol):
    """Return True when four curves meet in four corners, so that a Coons patch can be hung between them, else False."""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="corners_agree"
check(corners_agree)

# %% [markdown]
# **Task (bezier_split).** Cut a Bezier patch in two


# %% solution="bezier_split"
def bezier_split(P, u0):
    """Return the control nets of the two pieces into which the curve u = u0 cuts a Bezier patch."""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="bezier_split"
check(bezier_split)

# %% [markdown]
# **Task (elevate_u).** One degree more


# %% solution="elevate_u"
def elevate_u(P):
    """Return the control net of the same Bezier patch with its degree in u raised by one: the same surface, one more row."""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="elevate_u"
check(elevate_u)

# %% [markdown]
# **Task (uniform_bicubic).** One piece of a uniform B-spline


# %% solution="uniform_bicubic"
def uniform_bicubic(u, w, P):
    """Return the points of one piece of a uniform bicubic B-spline surface: the piece that sixteen control points make."""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="uniform_bicubic"
check(uniform_bicubic)

# %% [markdown]
# **Task (points16_to_bezier).** From sixteen points to a Bezier net


# %% solution="points16_to_bezier"
def points16_to_bezier(P):
    """Return the control net of the bicubic Bezier patch that passes through sixteen points."""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="points16_to_bezier"
check(points16_to_bezier)

# %% [markdown]
# **Task (cubic_coons).** Coons patch with cubic blending


# %% solution="cubic_coons"
def cubic_coons(u, w, c0, c1, d0, d1):
    """Return the points of the Coons patch through four boundary curves, mixed by the cubics F1 and F2."""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="cubic_coons"
check(cubic_coons)

# %% [markdown]
# **Task (coons_bezier_net).** Net of a Coons patch


# %% solution="coons_bezier_net"
def coons_bezier_net(c0, c1, d0, d1):
    """Return the control net of the Bezier patch that is the Coons patch of four Bezier curves."""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="coons_bezier_net"
check(coons_bezier_net)

# %% [markdown]
# **Task (nurbs_revolve).** Exact surface of revolution


# %% solution="nurbs_revolve"
def nurbs_revolve(profile, h):
    """Return control net, weights and knots, (P, weights, knots), of the NURBS surface that a profile makes in one whole turn"""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="nurbs_revolve"
check(nurbs_revolve)

# %% [markdown]
# **Task (outward_normals).** Which way is out?


# %% solution="outward_normals"
def outward_normals(s, t, P):
    """Return the unit normals of the six faces of a solid, at one place of each, all pointing out of the solid."""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="outward_normals"
check(outward_normals)

# %% [markdown]
# **Task (revolved_line_kind).** What does a turning line make?


# %% solution="revolved_line_kind"
def revolved_line_kind(p, d, point, axis):
    """Return what an unlimited straight line sweeps in one whole turn about an axis: 'cylinder', 'cone', 'plane', 'hyperboloid'"""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="revolved_line_kind"
check(revolved_line_kind)

# %% [markdown]
# **Task (sphericity).** Sphericity from measured points


# %% solution="sphericity"
def sphericity(points):
    """Return the sphericity of measured points: their largest distance from the centre of the sphere that fits them best, less"""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="sphericity"
check(sphericity)

# %% [markdown]
# **Task (fmill_tangents).** Tangents for a grid of points


# %% solution="fmill_tangents"
def fmill_tangents(P):
    """Return tangents (pu, pw) for a grid of points, by the rule of FMILL, so that Ferguson patches can be laid through them."""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="fmill_tangents"
check(fmill_tangents)

# %% [markdown]
# **Task (same_surface).** Are two surfaces the same?


# %% solution="same_surface"
def same_surface(f, g):
    """Return how two surfaces are related: 'same map', 'relabelled', 'same set', 'moved' or 'different'; the first that is true."""
    ### BEGIN SOLUTION
    raise NotImplementedError
    ### END SOLUTION


# %% check="same_surface"
check(same_surface)

