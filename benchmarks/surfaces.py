"""The reference library against the libraries people use, side by side in one process: python benchmarks/surfaces.py

Prints nanoseconds a point, or microseconds a call, each peer's ratio to ours (above 1: we are faster), and for each target
whether the ratios just measured meet it. Every round times each way once, in turn, so that a busy moment of the machine hits
all of them; a figure is the median over the rounds. All run on one thread, as the peers do. Peers that are not installed are
left out and named. What the figures mean and where we are behind: docs/speed.md.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
import tracemalloc
from importlib import import_module

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read when numpy is loaded

import directrix as dx
import numpy as np
from directrix.knots import open_knots


def optional(name):
    try:
        return import_module(name)
    except ImportError:
        return None


def seconds(calls, budget):
    """Median time of each call. In every round each has its turn, about 10 ms long, so that other work hits all of them.

    A turn of quick calls begins with one that is not counted: it finds the caches as the peer before left them.
    """
    times, turns = {}, {}
    for name, call in calls.items():
        call()
        start = time.perf_counter()
        call()
        times[name], turns[name] = [], round(0.01 / (time.perf_counter() - start))
    until = time.perf_counter() + budget * len(calls)
    rounds = 0
    while rounds < 3 or (time.perf_counter() < until and rounds < 100):
        rounds += 1
        for name, call in calls.items():
            for turn in range(turns[name] + 1):
                start = time.perf_counter()
                call()
                if turn or not turns[name]:
                    times[name].append(time.perf_counter() - start)
    return {name: float(np.median(found)) for name, found in times.items()}


class Case:
    """One line of the table: the same values by several libraries."""

    def __init__(self, title, count, unit="ns a point"):
        self.title, self.count, self.unit = title, count, unit
        self.ways = {}

    def add(self, name, call, share=1.0):
        """A way to do it; ``share`` says which part of the work the call does, for peers too slow to do it all."""
        self.ways[name] = (call, share)

    def run(self, budget):
        spent = seconds({name: call for name, (call, _) in self.ways.items()}, budget)
        if self.unit == "µs a call":
            return {name: found * 1e6 for name, found in spent.items()}
        return {name: found / (self.count * self.ways[name][1]) * 1e9 for name, found in spent.items()}


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


def occ_patch(patch):
    """OpenCASCADE's surface, made as the STEP writer makes it; its binding evaluates one point a call."""
    from directrix.export import step

    return step._geom(step._Modules(), patch)


def by_occ(surface, u, w):
    """Its points at parameters of the knots' own domain."""
    found = [surface.Value(a, b) for a, b in zip(u, w, strict=True)]
    return [(p.X(), p.Y(), p.Z()) for p in found]


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
    if optional("OCP") and size <= 20:
        cad, some = occ_patch(patch), [(x[:2000] * (size - 3)).tolist() for x in (u, w)]
        agreed(patch(u[:2000], w[:2000]), by_occ(cad, *some))
        case.add("OpenCASCADE (OCP)", lambda: by_occ(cad, *some), share=2000 / count)
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
    if optional("OCP"):
        cad = occ_patch(patch)
        case.add("OpenCASCADE (OCP)", lambda: by_occ(cad, [0.3 * (size - 3)], [0.4 * (size - 3)]))
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


def growth(rng, count=100_000):
    """The same points on nets of 20 x 20 and 200 x 200, in turn: what the net costs a point."""
    case = Case(f"bicubic NURBS, {count} scattered points, by the size of the net", count)
    u, w = rng.random((2, count))
    for size in (20, 200):
        patch = dx.NurbsPatch(rng.random((size, size, 3)), rng.uniform(0.5, 1.5, (size, size)), 4, 4)
        case.add("directrix" if size == 20 else "directrix, 200 x 200", lambda patch=patch: patch(u, w))
    return case


def memory(rng):
    """Peak bytes a scattered point, the answer's 24 among them, for 50k, 200k and 800k points: linear if they do not grow."""
    patch = dx.NurbsPatch(rng.random((20, 20, 3)), rng.uniform(0.5, 1.5, (20, 20)), 4, 4)
    patch(*rng.random((2, 5000)))
    found = {}
    for count in (50_000, 200_000, 800_000):
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


def targets(cases, memory, imports):
    """What is asked, and how much of what is allowed is used: above 1 we are behind. A peer that is missing asks nothing."""
    bezier, nurbs, normals, scattered, _, net, point, _ = cases

    def against(found, peer, share, text):
        """We take at most ``share`` of the peer's time."""
        if peer in found:
            yield text, found["directrix"] / (share * found[peer])

    for title, found in (("Bezier grid", bezier), ("NURBS grid", nurbs)):
        yield from against(found, "splipy", 1, f"{title}: no slower than splipy")
        yield from against(found, "scipy BSpline twice", 1, f"{title}: no slower than scipy")
        yield from against(found, "two bare products", 1.5, f"{title}: within 1.5x of two bare products")
    yield from against(normals, "bare products S, Su, Sw", 1.5, "normals: within 1.5x of the bare products for S, S_u, S_w")
    yield from against(scattered, "scipy NdBSpline", 1, "scattered: no slower than scipy's NdBSpline")
    yield from against(scattered, "splinepy", 1 / 3, "scattered: 3x splinepy")
    yield from against(scattered, "geomdl", 1 / 100, "scattered: 100x geomdl")
    yield "scattered: cost does not grow from 20 x 20 to 200 x 200 (5%)", net["directrix, 200 x 200"] / net["directrix"] / 1.05
    yield from against(point, "geomdl", 1, "one point: no slower than geomdl")
    yield "memory: bytes a point do not grow with the points (5%)", memory[800_000] / memory[50_000] / 1.05
    yield "import: at most 1.3x numpy and scipy.interpolate", imports["directrix"] / (1.3 * imports["numpy, scipy.interpolate"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=1.0, help="time spent on each way (default 1)")
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")
    options = parser.parse_args()
    rng = np.random.default_rng(20)
    makers = [
        bezier_grid,
        nurbs_grid,
        normals_grid,
        nurbs_scattered,
        lambda r: nurbs_scattered(r, 200),
        growth,
        one_point,
        coons_grid,
    ]
    missing = [name for name in ("splipy", "geomdl", "splinepy", "OCP") if optional(name) is None]
    result, cases = {"not installed": missing, "cases": {}}, []
    for make in makers:
        case = make(rng)
        cases.append(case.run(options.seconds))
        result["cases"][case.title] = {"unit": case.unit, **cases[-1]}
        if not options.json:
            print(f"\n{case.title} ({case.unit})")
            for name, value in cases[-1].items():
                print(f"  {name:26}{value:12.1f}{value / cases[-1]['directrix']:10.2f}x")
    result["bytes a scattered point"] = memory(rng)
    result["import seconds"] = import_times()
    result["targets"] = dict(targets(cases, result["bytes a scattered point"], result["import seconds"]))
    if options.json:
        print(json.dumps(result))
        return
    print("\npeak memory, bytes a scattered point:", {n: round(b) for n, b in result["bytes a scattered point"].items()})
    print("import, seconds:", {name: round(value, 3) for name, value in result["import seconds"].items()})
    print("\ntargets, and how much of what is allowed is used:")
    for text, used in result["targets"].items():
        print(f"  {'met' if used <= 1 else 'behind':8}{used:6.2f}  {text}")
    if missing:
        print("not installed, so not compared:", ", ".join(missing))


if __name__ == "__main__":
    main()
