"""The known forms about the z axis, each as the formula of the lecture and as a sweep."""

from __future__ import annotations

from math import pi

from directrix import checks
from directrix.basis import linear
from directrix.checks import Array
from directrix.curves.arc import Arc, Circle
from directrix.curves.line import Line
from directrix.errors import ConversionError, NumberError
from directrix.quadric import Quadric
from directrix.surfaces.grids import components
from directrix.surfaces.revolution import CircularSweep
from directrix.surfaces.surface import Surface
from directrix.transform import turn

MINUS_Y = (0.0, -1.0, 0.0)  # normal of a circle in the xz-plane that rises from +x towards +z


class Cylinder(Surface):
    """A cylinder about z: S(u, w) = (r cos 2 pi u, r sin 2 pi u, h w).

    u goes once round from +x towards +y, w from z = 0 to z = h. A radius, a height and an axis do not say where on the axis
    the cylinder stands: here it stands on z = 0, upwards for h > 0. Normals point outward for h > 0, inward for h < 0;
    k1 = 0 and k2 = -1/r with the outward normal. (Piegl & Tiller, The NURBS Book, 2nd ed., section 8.3.)

    Parameters
    ----------
    radius : length, > 0
    height : length, not 0; negative stands below z = 0

    Raises
    ------
    NumberError
        If the radius is not above 0, or the height is 0.

    Examples
    --------
    >>> Cylinder(2, 5)(0.25, 0.5)
    array([0. , 2. , 2.5])
    >>> Cylinder(2, 5).normal(0.25, 0.5)
    array([0., 1., 0.])
    """

    radius: float
    height: float

    def __init__(self, radius: float, height: float) -> None:
        self._hold(radius=checks.positive("radius", radius), height=checks.not_zero("height", height))

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        return _turned(linear(w, self.radius, self.radius, nw), linear(w, 0.0, self.height, nw), u, nu)

    def swept(self) -> CircularSweep:
        """The same surface as a line turned about z: u and w exchange their roles, cylinder(u, w) = swept(w, u)."""
        return CircularSweep(Line((self.radius, 0, 0), (self.radius, 0, self.height)))

    def implicit(self) -> Quadric:
        """x^2 + y^2 - r^2 = 0, without ends."""
        return Quadric(1, 1, 0, 0, 0, 0, 0, 0, 0, -(self.radius**2))


class Cone(Surface):
    """A cone or frustum about z: S(u, w) = (rho cos 2 pi u, rho sin 2 pi u, h w), rho = r1 + (r2 - r1) w.

    A circle of radius r1 in z = 0, of radius r2 in z = h, joined by straight lines; u goes once round from +x towards +y.
    h is measured along the axis, not along the slant. A radius of 0 makes an apex: S_u = 0 all along that edge; the normal
    there is the limit along each ruling, and the curvature NaN. Normals point outward. (Piegl & Tiller, The NURBS
    Book, 2nd ed., section 8.4.)

    Parameters
    ----------
    r1, r2 : lengths, >= 0, not both 0
    height : length, > 0

    Raises
    ------
    NumberError
        If a radius is negative, both are 0, or the height is not above 0.

    Examples
    --------
    >>> Cone(3, 1, 4)(0.25, 0.5)
    array([0., 2., 2.])
    """

    r1: float
    r2: float
    height: float

    def __init__(self, r1: float, r2: float, height: float) -> None:
        r1, r2 = checks.not_negative("r1", r1), checks.not_negative("r2", r2)
        if r1 == r2 == 0:
            raise NumberError("r1 and r2 must not both be 0: that is a line. Give 0 to one of them for a cone with an apex.")
        self._hold(r1=r1, r2=r2, height=checks.positive("height", height))

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        return _turned(linear(w, self.r1, self.r2, nw), linear(w, 0.0, self.height, nw), u, nu)

    def swept(self) -> CircularSweep:
        """The same surface as a line turned about z: u and w exchange their roles, cone(u, w) = swept(w, u)."""
        return CircularSweep(Line((self.r1, 0, 0), (self.r2, 0, self.height)))

    def implicit(self) -> Quadric:
        """x^2 + y^2 - (r1 + (r2 - r1) z / h)^2 = 0, without ends and with the other half of the cone."""
        slope = (self.r2 - self.r1) / self.height
        return Quadric(1, 1, -(slope**2), 0, 0, 0, 0, 0, -2 * self.r1 * slope, -(self.r1**2))


class Sphere(Surface):
    """A sphere about the origin: S = r (cos phi cos theta, cos phi sin theta, sin phi), phi = pi (u - 1/2), theta = 2 pi w.

    A semicircle in the xz-plane (x >= 0), run through by u from the south to the north pole, is turned about z by w. Both
    edges u = 0 and u = 1 collapse to poles; the normal there is the limit. Normals point inward, so k1 = k2 = 1/r. Area
    4 pi r^2. (do Carmo, Differential Geometry of Curves and Surfaces, section 2-2, with the colatitude pi/2 - phi.)

    Parameters
    ----------
    radius : length, > 0

    Raises
    ------
    NumberError
        If the radius is not above 0.

    Examples
    --------
    >>> Sphere(2)([0.0, 0.5, 1.0], 0.25).tolist()
    [[0.0, 0.0, -2.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]
    >>> Sphere(2).normal(1.0, 0.0)
    array([ 0.,  0., -1.])
    """

    radius: float

    def __init__(self, radius: float) -> None:
        self._hold(radius=checks.positive("radius", radius))

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        cos, sin = turn((u - 0.5) / 2, nu)
        scale = self.radius * 0.5**nu
        return _turned(scale * cos, scale * sin, w, nw)

    def swept(self) -> CircularSweep:
        """The same map as a sweep: a semicircle in the xz-plane turned about z."""
        return CircularSweep(Arc((0, 0, 0), self.radius, -pi / 2, pi / 2, MINUS_Y))

    def implicit(self) -> Quadric:
        """x^2 + y^2 + z^2 - r^2 = 0."""
        return Quadric(1, 1, 1, 0, 0, 0, 0, 0, 0, -(self.radius**2))


class Torus(Surface):
    """A torus about z: S = ((R + r cos phi) cos theta, (R + r cos phi) sin theta, r sin phi), phi = 2 pi u, theta = 2 pi w.

    A circle of radius r (the tube) with centre (R, 0, 0) in the xz-plane, run through by u from its outermost point upwards,
    is turned about z by w. R > r is a ring (genus 1), R = r a horn (pinched in one point), 0 < R < r a spindle (it crosses
    itself on the axis), R = 0 a sphere covered twice (genus 0). With R measured to the centre of the tube, equal radii make a
    horn, not a sphere; that needs equal centres. Normals point into the tube where R + r cos phi > 0. Area 4 pi^2 R r for
    R >= r. (do Carmo, Differential Geometry of Curves and Surfaces, section 2-5.)

    Parameters
    ----------
    R : length, >= 0, from the axis to the centre of the tube
    r : length, > 0, radius of the tube

    Raises
    ------
    NumberError
        If R is negative, or r not above 0.

    Examples
    --------
    >>> Torus(3, 1)([0.0, 0.25, 0.5], 0.25).tolist()
    [[0.0, 4.0, 0.0], [0.0, 3.0, 1.0], [0.0, 2.0, 0.0]]
    """

    R: float
    r: float

    def __init__(self, R: float, r: float) -> None:
        self._hold(R=checks.not_negative("R", R), r=checks.positive("r", r))

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        cos, sin = turn(u, nu)
        rho = self.r * cos + (self.R if nu == 0 else 0.0)
        return _turned(rho, self.r * sin, w, nw)

    @property
    def kind(self) -> str:
        """'ring', 'horn', 'spindle' or 'sphere'."""
        if self.R == 0:
            return "sphere"
        return "ring" if self.r < self.R else "horn" if self.r == self.R else "spindle"

    def swept(self) -> CircularSweep:
        """The same map as a sweep: a circle in the xz-plane turned about z."""
        return CircularSweep(Circle((self.R, 0, 0), self.r, MINUS_Y))

    def implicit(self) -> Quadric:
        """The sphere x^2 + y^2 + z^2 - r^2 = 0 where R = 0; any other torus is of degree four.

        Raises
        ------
        ConversionError
            Unless R = 0.
        """
        if self.R:
            raise ConversionError(
                f"a torus with R = {self.R:g} is no quadric but a surface of degree four, "
                "(x^2 + y^2 + z^2 + R^2 - r^2)^2 = 4 R^2 (x^2 + y^2); only R = 0, the sphere, is one."
            )
        return Sphere(self.r).implicit()


def _turned(rho: Array, height: Array, t: Array, n: int) -> Array:
    """(rho cos 2 pi t, rho sin 2 pi t, height), n times differentiated by t; the height does not depend on t."""
    cos, sin = turn(t, n)
    return components(rho * cos, rho * sin, height if n == 0 else 0.0)
