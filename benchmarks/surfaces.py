"""The reference library against the libraries people use, side by side in one process: python benchmarks/surfaces.py

Prints nanoseconds a point, or microseconds a call, and each peer's ratio to ours (above 1: we are faster). Peers that are not
installed are left out and named. Times are medians after a warm-up; run it twice on a quiet machine before believing a digit,
and with OPENBLAS_NUM_THREADS=1 to compare like with like: the peers use one thread.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
import tracemalloc
from importlib import import_module

import directrix as dx
import numpy as np
from directrix.knots import open_knots


def optional(name):
    try:
        return import_module(name)
    except ImportError:
        return None


def seconds(call, budget):
    """Median time of a call: repeated until the budget is spent, at least three times."""
    call()
    times = []
    until = time.perf_counter() + budget
    while len(times) < 3 or time.perf_counter() < until:
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
        if len(times) >= 200:
            break
    return float(np.median(times))


class Case:
    """One line of the table: the same values by several libraries."""

    def __init__(self, title, count, unit="ns a point"):
        self.title, self.count, self.unit = title, count, unit
        self.ways = {}

    def add(self, name, call, share=1.0):
        """A way to do it; ``share`` says which part of the work the call does, for peers too slow to do it all."""
        self.ways[name] = (call, share)

    def run(self, budget):
        found = {}
        for name, (call, share) in self.ways.items():
            spent = seconds(call, budget)
            found[name] = spent * 1e6 if self.unit == "µs a call" else spent / (self.count * share) * 1e9
        return found


def agreed(reference, other, tolerance=1e-9):
    """The peers must do the same work: their points are compared before they are timed."""
    assert np.abs(np.asarray(reference) - np.asarray(other)).max() < tolerance


def lifted(net, weights):
    return np.concatenate([net * weights[..., None], weights[..., None]], axis=2)


def splipy_patch(net, weights, k):
    splipy = optional("splipy")
    m, n = net.shape[:2]
    bases = [splipy.BSplineBasis(k, open_knots(c, k) / (c - k + 1)) for c in (m, n)]
    return splipy.Surface(*bases, lifted(net, weights).transpose(1, 0, 2).reshape(-1, 4), rational=True)


def geomdl_patch(net, weights, k):
    nurbs = import_module("geomdl.NURBS")
    m, n = net.shape[:2]
    peer = nurbs.Surface()
    peer.degree_u = peer.degree_v = k - 1
    peer.set_ctrlpts(lifted(net, weights).reshape(-1, 4).tolist(), m, n)
    peer.knotvector_u, peer.knotvector_v = (open_knots(c, k).tolist() for c in (m, n))
    return peer


def splinepy_patch(net, weights, k):
    splinepy = optional("splinepy")
    m, n = net.shape[:2]
    knots = [open_knots(c, k) / (c - k + 1) for c in (m, n)]
    points, h = net.transpose(1, 0, 2).reshape(-1, 3), weights.T.reshape(-1, 1)
    return splinepy.NURBS(degrees=[k - 1, k - 1], knot_vectors=knots, control_points=points, weights=h)


def bezier_grid(rng):
    from scipy.interpolate import BSpline

    net, t = rng.random((4, 4, 3)), np.linspace(0, 1, 200)
    patch, case = dx.BezierPatch(net), Case("bicubic Bezier, grid 200 x 200", 40_000)
    u, w = t[:, None], t[None]
    from directrix.basis import bernstein

    planes, rows = np.ascontiguousarray(np.moveaxis(net, -1, 0)), bernstein(3, t)
    case.add("directrix", lambda: patch(u, w))
    case.add("two bare products", lambda: (rows @ planes) @ rows.T)
    knots = open_knots(4, 4)
    once = lambda: BSpline(knots, np.moveaxis(BSpline(knots, net, 3)(t), 1, 0), 3)(t)  # noqa: E731
    agreed(patch(u, w), np.swapaxes(once(), 0, 1))
    case.add("scipy BSpline twice", once)
    if optional("splipy"):
        peer = splipy_patch(net, np.ones((4, 4)), 4)
        agreed(patch(u, w), peer(t, t))
        case.add("splipy", lambda: peer(t, t))
    if optional("geomdl"):
        peer_g, few = geomdl_patch(net, np.ones((4, 4)), 4), [(a, b) for a in t[::20] for b in t[::20]]
        case.add("geomdl", lambda: peer_g.evaluate_list(few), share=len(few) / 40_000)
    return case


def nurbs_grid(rng, size=20):
    from scipy.interpolate import BSpline

    net, weights, t = rng.random((size, size, 3)), rng.uniform(0.5, 1.5, (size, size)), np.linspace(0, 1, 200)
    patch, case = dx.NurbsPatch(net, weights, 4, 4), Case(f"bicubic NURBS, net {size} x {size}, grid 200 x 200", 40_000)
    u, w = t[:, None], t[None]
    case.add("directrix", lambda: patch(u, w))
    knots, net4 = open_knots(size, 4), lifted(net, weights)
    stretched = t * (size - 3)
    rows = BSpline(knots, np.eye(size), 3)(stretched)
    planes = np.ascontiguousarray(np.moveaxis(net4, -1, 0))
    case.add("two bare products", lambda: (rows @ planes) @ rows.T)

    def twice():
        value = BSpline(knots, np.moveaxis(BSpline(knots, net4, 3)(stretched), 1, 0), 3)(stretched)
        return np.swapaxes(value[..., :3] / value[..., 3:], 0, 1)

    agreed(patch(u, w), twice())
    case.add("scipy BSpline twice", twice)
    if optional("splipy"):
        peer = splipy_patch(net, weights, 4)
        agreed(patch(u, w), peer(t, t))
        case.add("splipy", lambda: peer(t, t))
    if optional("splinepy"):
        peer_s, grid = splinepy_patch(net, weights, 4), np.stack([a.ravel() for a in np.meshgrid(t, t, indexing="ij")], axis=1)
        agreed(patch(u, w).reshape(-1, 3), peer_s.evaluate(grid))
        case.add("splinepy", lambda: peer_s.evaluate(grid))
    return case


def normals_grid(rng, size=20):
    net, weights, t = rng.random((size, size, 3)), rng.uniform(0.5, 1.5, (size, size)), np.linspace(0, 1, 200)
    patch, case = dx.NurbsPatch(net, weights, 4, 4), Case("the same with normals", 40_000)
    u, w = t[:, None], t[None]
    from scipy.interpolate import BSpline

    basis = BSpline(open_knots(size, 4), np.eye(size), 3)
    rows, slopes = basis(t * (size - 3)), basis(t * (size - 3), 1)
    planes = np.ascontiguousarray(np.moveaxis(lifted(net, weights), -1, 0))
    case.add("directrix", lambda: patch.normal(u, w))

    def bare():
        half, other = rows @ planes, slopes @ planes
        return half @ rows.T, other @ rows.T, half @ slopes.T

    case.add("bare products S, Su, Sw", bare)
    if optional("splipy"):
        peer = splipy_patch(net, weights, 4)
        agreed(np.abs(patch.normal(u, w)), np.abs(peer.normal(t, t)), 1e-7)
        case.add("splipy", lambda: peer.normal(t, t))
    return case


def nurbs_scattered(rng, size=20, count=100_000):
    from scipy.interpolate import NdBSpline

    net, weights = rng.random((size, size, 3)), rng.uniform(0.5, 1.5, (size, size))
    patch = dx.NurbsPatch(net, weights, 4, 4)
    case = Case(f"bicubic NURBS, net {size} x {size}, {count} scattered points", count)
    u, w = rng.random((2, count))
    case.add("directrix", lambda: patch(u, w))
    knots = open_knots(size, 4)
    compiled = NdBSpline((knots, knots), lifted(net, weights), 3)

    def scipy_way():
        value = compiled(np.stack([u * (size - 3), w * (size - 3)], axis=-1))
        return value[:, :3] / value[:, 3:]

    agreed(patch(u, w), scipy_way())
    case.add("scipy NdBSpline", scipy_way)
    if optional("splinepy") and size <= 20:
        peer, at = splinepy_patch(net, weights, 4), np.stack([u, w], axis=1)
        agreed(patch(u, w), peer.evaluate(at))
        case.add("splinepy", lambda: peer.evaluate(at))
    if optional("geomdl") and size <= 20:
        slow, few = geomdl_patch(net, weights, 4), list(zip(u[:200].tolist(), w[:200].tolist(), strict=True))
        agreed(patch(u[:200], w[:200]), slow.evaluate_list(few))
        case.add("geomdl", lambda: slow.evaluate_list(few), share=200 / count)
    if optional("splipy") and size <= 20:
        other = splipy_patch(net, weights, 4)
        case.add("splipy", lambda: other(u[:2000], w[:2000], tensor=False), share=2000 / count)
    return case


def one_point(rng, size=20):
    net, weights = rng.random((size, size, 3)), rng.uniform(0.5, 1.5, (size, size))
    patch, case = dx.NurbsPatch(net, weights, 4, 4), Case("one point of that NURBS", 1, "µs a call")
    case.add("directrix", lambda: patch(0.3, 0.4))
    if optional("geomdl"):
        slow = geomdl_patch(net, weights, 4)
        agreed(patch(0.3, 0.4), slow.evaluate_single((0.3, 0.4)))
        case.add("geomdl", lambda: slow.evaluate_single((0.3, 0.4)))
    if optional("splinepy"):
        peer, at = splinepy_patch(net, weights, 4), np.array([[0.3, 0.4]])
        case.add("splinepy", lambda: peer.evaluate(at))
    if optional("splipy"):
        other = splipy_patch(net, weights, 4)
        case.add("splipy", lambda: other(0.3, 0.4))
    return case


def coons_grid(rng):
    t = np.linspace(0, 1, 200)
    p = rng.random((2, 2, 3))
    ends = [(p[0, 0], p[1, 0]), (p[0, 1], p[1, 1]), (p[0, 0], p[0, 1]), (p[1, 0], p[1, 1])]
    polygons = [np.array([a, *rng.random((2, 3)), b]) for a, b in ends]
    patch, case = dx.Coons(*(dx.BezierCurve(q) for q in polygons)), Case("Coons patch of Bezier cubics, grid 200 x 200", 40_000)
    case.add("directrix", lambda: patch(t[:, None], t[None]))
    bezier = dx.to_bezier(patch)
    case.add("directrix, as Bezier", lambda: bezier(t[:, None], t[None]))
    if optional("splipy"):
        splipy, factory = optional("splipy"), import_module("splipy.surface_factory")
        bottom, top, left, right = (splipy.Curve(splipy.BSplineBasis(4), q) for q in polygons)
        peer = factory.edge_curves(bottom, right, top, left)
        agreed(patch(t[:, None], t[None]), peer(t, t))
        case.add("splipy", lambda: peer(t, t))
    return case


def memory(rng):
    """Peak bytes a scattered point, for 50k and 200k points: linear if they agree."""
    patch = dx.NurbsPatch(rng.random((20, 20, 3)), rng.uniform(0.5, 1.5, (20, 20)), 4, 4)
    patch([0.5], [0.5])
    found = {}
    for count in (50_000, 200_000):
        u, w = rng.random((2, count))
        tracemalloc.start()
        patch(u, w)
        found[count] = tracemalloc.get_traced_memory()[1] / count
        tracemalloc.stop()
    return found


def import_times():
    """Wall time of fresh interpreters, best of seven, less that of an empty one."""

    def best(statement):
        times = []
        for _ in range(7):
            start = time.perf_counter()
            subprocess.run([sys.executable, "-c", statement], check=True)
            times.append(time.perf_counter() - start)
        return min(times)

    empty = best("pass")
    found = {name: best(f"import {name}") - empty for name in ("numpy, scipy.interpolate", "directrix")}
    every = "import directrix as dx; [getattr(dx, name) for name in dx.__all__]"
    return {**found, "every name of directrix": best(every) - empty}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=1.0, help="time spent on each way (default 1)")
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")
    options = parser.parse_args()
    rng = np.random.default_rng(20)
    makers = [bezier_grid, nurbs_grid, normals_grid, nurbs_scattered, lambda r: nurbs_scattered(r, 200), one_point, coons_grid]
    missing = [name for name in ("splipy", "geomdl", "splinepy") if optional(name) is None]
    result = {"not installed": missing, "cases": {}}
    for make in makers:
        case = make(rng)
        found = case.run(options.seconds)
        result["cases"][case.title] = {"unit": case.unit, **found}
        if not options.json:
            print(f"\n{case.title} ({case.unit})")
            for name, value in found.items():
                print(f"  {name:26}{value:12.1f}{value / found['directrix']:10.2f}x")
    result["bytes a scattered point"] = memory(rng)
    result["import seconds"] = import_times()
    if options.json:
        print(json.dumps(result))
        return
    print("\npeak memory, bytes a scattered point:", {n: round(b) for n, b in result["bytes a scattered point"].items()})
    print("import, seconds:", {name: round(value, 3) for name, value in result["import seconds"].items()})
    if missing:
        print("not installed, so not compared:", ", ".join(missing))


if __name__ == "__main__":
    main()
