"""Compares the results that runs report with an independent evaluation of their saved states, in NumPy alone.

    python3 scripts/check_runs.py PLICA RUN_DIR...

PLICA is the program. Energies, axial forces, lumen volumes, walls and crossings are computed again from the splines of the
saved states and the case; the statements of `plica table`, `history.csv` and `manifest.json` from the rows of the history.
The evaluation covers neo-Hookean walls of one layer without patches and residual stresses, and imperfections of
the geometry alone; what it does not cover in a run is left out.
"""

import csv
import json
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np

PHI = 2 * np.pi


# -- Saved states ------------------------------------------------------------------------------------------------------


def read(path):
    raw = Path(path).read_bytes()
    end = 8 + int.from_bytes(raw[:8], "little")
    header = json.loads(raw[8:end])
    about = json.loads(header.pop("__metadata__")["plica"])

    def array(entry):
        return np.frombuffer(raw[end:], "<f8", int(np.prod(entry["shape"])), entry["data_offsets"][0]).reshape(entry["shape"])

    return about, {name: array(entry) for name, entry in header.items()}


def bsplines(knots, p, points, derivative=0):
    """Values of all B-splines (rows: points), or their first derivatives, by the recurrence of Cox and de Boor."""
    points = np.atleast_1d(np.asarray(points, float))
    last = len(knots) - 2 - p  # the last span that is not empty
    span = np.clip(np.searchsorted(knots, points, "right") - 1, p, last)
    N = np.zeros((len(points), len(knots) - 1))
    N[np.arange(len(points)), span] = 1.0

    def ratio(a, b):
        return np.divide(a, b, out=np.zeros(np.broadcast(a, b).shape), where=b > 0)

    for d in range(1, p + 1):
        width = knots[d:] - knots[:-d]
        if d == p and derivative:
            factor = ratio(float(p), width)
            return factor[:-1] * N[:, :-1] - factor[1:] * N[:, 1:]
        left = ratio(points[:, None] - knots[:-d], width[None, :])
        right = ratio(knots[d:] - points[:, None], width[None, :])
        N = left[:, :-1] * N[:, :-1] + right[:, 1:] * N[:, 1:]
    return N


class Tube:
    """The spline of a saved state. Control points are shifted so that a list of arrays gives one body or the reference."""

    def __init__(self, about, arrays):
        mesh = about["mesh"]
        self.p, self.around, self.rings = mesh["degree"], mesh["around"], about["rings"]
        self.along, self.through = arrays["knots_along"], arrays["knots_through"]
        self.length = about["tube"]["length"]
        self.thickness = about["tube"]["thickness"]
        self.points = arrays["control_points"]
        u = arrays["u"]
        beta = (np.arange(self.rings) - self.p / 2) * PHI / self.around
        move = np.empty_like(self.points)
        move[..., 0] = u[:, :, 1] * np.cos(beta) - u[:, :, 2] * np.sin(beta)
        move[..., 1] = u[:, :, 1] * np.sin(beta) + u[:, :, 2] * np.cos(beta)
        move[..., 2] = u[:, :, 0]
        self.reference = self.points - move

    def ring_weights(self, phi, derivative=0):
        """B-splines around: for each angle the indices of the rings, their weights, and the turns of their sector."""
        n, p = self.around, self.p
        s = np.atleast_1d(phi) * n / PHI + 0.5
        base = np.floor(s).astype(int)
        N = bsplines(np.arange(-p, p + 2.0), p, s - base, derivative) * (n / PHI) ** derivative
        j = (base[:, None] + np.arange(p + 1)) % n
        return j % self.rings, N, (j // self.rings) * self.rings * PHI / n

    def evaluate(self, points, z, r, phi, derivative=None):
        """x at all combinations of z, r and phi, or its derivative by z (0), r (1) or phi (2): shape (z, r, phi, 3)."""
        A = bsplines(self.along, self.p, z, int(derivative == 0))
        B = bsplines(self.through, self.p, r, int(derivative == 1))
        rings, N, turn = self.ring_weights(phi, int(derivative == 2))
        section = np.einsum("za,rc,acji->zrji", A, B, points)
        x = np.zeros((len(A), len(B), len(rings), 3))
        for b in range(self.p + 1):
            P = section[:, :, rings[:, b]]
            c, s = np.cos(turn[:, b]), np.sin(turn[:, b])
            x[..., 0] += N[:, b] * (c * P[..., 0] - s * P[..., 1])
            x[..., 1] += N[:, b] * (s * P[..., 0] + c * P[..., 1])
            x[..., 2] += N[:, b] * P[..., 2]
        return x

    def faces(self):
        return {"inner": self.through[0], "outer": self.through[-1]}

    def gauss(self):
        """Gauss points and weights along, through and around a sector, p + 1 per element; the last weights count all sectors."""
        x, w = np.polynomial.legendre.leggauss(self.p + 1)

        def rule(breaks):
            a, b = breaks[:-1, None], breaks[1:, None]
            return (0.5 * (a + b) + 0.5 * (b - a) * x).ravel(), (0.5 * (b - a) * w).ravel()

        h = PHI / self.around
        z, wz = rule(np.unique(self.along))
        r, wr = rule(np.unique(self.through))
        phi, wphi = rule((np.arange(self.rings + 1) - 0.5) * h)
        return (z, wz), (r, wr), (phi, wphi * self.around / self.rings)


# -- The model ---------------------------------------------------------------------------------------------------------


def activity(profile, x):
    inside = (x >= 0) & (x <= 1)
    if profile == "half-sine":
        s = np.sin(np.pi * x)
    elif isinstance(profile, dict) and "smooth-box" in profile:
        t = np.clip(np.minimum(x, 1 - x) / profile["smooth-box"]["edge"], 0, 1)
        s = 0.5 * (1 - np.cos(np.pi * t))
    elif isinstance(profile, dict):
        s = np.interp(x, *np.array(profile["table"]).T)
    else:
        s = 0.5 * (1 - np.cos(2 * np.pi * x))
    return np.where(inside, s, 0.0)


def growth(case, load, z, length, diameter):
    """θζ and θη at z, in diameters, for the targets of a saved state."""
    zeta, eta = np.ones_like(z), np.ones_like(z)
    ratios = {muscle["name"]: muscle["ratio"] for muscle in load["muscles"]}
    for name, muscle in case.get("muscles", {}).items():
        a, b = (end / diameter for end in muscle["zone"])
        profile = muscle.get("profile", "raised-cosine")
        fine = np.linspace(0, 1, 200001)
        shape = activity(profile, fine)
        s = activity(profile, (z - a) / (b - a))
        if muscle["direction"] == "circular":
            eta *= 1 + (ratios[name] - 1) * s / shape.max()
        else:
            zeta *= 1 + (ratios[name] - 1) * length / ((b - a) * np.trapezoid(shape, fine)) * s
    return zeta, eta


def energy_and_force(tube, rest, case, load, diameter):
    """W, ∫ w dV0, and the axial forces of both ends, in E D^3 and E D^2; the forces of pressures on the wall not included.

    rest has the control points of the shape that is free of stress."""
    law = case.get("material", {}).get("neo-hookean", {})
    nu, quadratic = law.get("poisson_ratio", 0.495), law.get("volumetric") == "quadratic"
    mu, lam = 0.5 / (1 + nu), nu / (1 + nu) / (1 - 2 * nu)
    (z, wz), (r, wr), (phi, wphi) = tube.gauss()
    perfect, X, x = (
        np.stack([tube.evaluate(points, z, r, phi, d) for d in range(3)], axis=-1)
        for points in (tube.reference, rest, tube.points)
    )
    G = np.linalg.inv(X)
    left, _, right = np.linalg.svd(X @ np.linalg.inv(perfect))
    F = x @ G
    dV = np.abs(np.linalg.det(X)) * wz[:, None, None] * wr[:, None] * wphi
    zeta, eta = growth(case, load, z, tube.length, diameter)
    # Fp has the directions z (ζ) and φ (η); its inverse is symmetric.
    at = tube.evaluate(tube.reference, z[:1], r[:1], phi)[0, 0]
    c, s = (at[:, :2] / np.hypot(at[:, 0], at[:, 1])[:, None]).T
    around = np.stack([-s, c, 0 * s], -1)
    out = np.stack([c, s, 0 * s], -1)
    axis = np.array([0.0, 0.0, 1.0])
    inverse = (
        np.einsum("z,i,j->zij", 1 / zeta, axis, axis)[:, None]
        + np.einsum("z,pi,pj->zpij", 1 / eta, around, around)
        + np.einsum("pi,pj->pij", out, out)
    )[:, None]
    # The directions of the muscles turn with the wall that is free of stress.
    inverse = (left @ right) @ inverse
    Fe = F @ inverse
    J = np.linalg.det(Fe)
    lnJ = np.log(J)
    volumetric = lam / 4 * (J**2 - 1 - 2 * lnJ) if quadratic else lam / 2 * lnJ**2
    w = mu / 2 * (np.sum(Fe**2, axis=(-1, -2)) - 3) - mu * lnJ + volumetric
    slope = lam / 2 * (J**2 - 1) if quadratic else lam * lnJ  # J dU/dJ
    P = mu * Fe + (slope - mu)[..., None, None] * np.swapaxes(np.linalg.inv(Fe), -1, -2)
    grown = (zeta * eta)[:, None, None] * dV
    first_piola = P @ np.swapaxes(inverse, -1, -2)
    # Virtual work of a displacement along the axis with the first or last B-spline along: P : ∇v = P_zj N' G_zj.
    dN = bsplines(tube.along, tube.p, z, 1)[:, [0, -1]]
    forces = np.einsum("zrpj,zrpj,zrp,ze->e", first_piola[..., 2, :], G[..., 0, :], grown, dN)
    return np.sum(w * grown), np.sum(w * dV), forces


def wall_integrals(tube, face):
    """The volume that a wall encloses, and ∫ N n_z da for the first and last B-spline along, n outward from the lumen."""
    (z, wz), _, (phi, wphi) = tube.gauss()
    r = [tube.faces()[face]]
    x, x_z, x_phi = (tube.evaluate(tube.points, z, r, phi, d)[:, 0] for d in (None, 0, 2))
    n = np.cross(x_phi, x_z) * wz[:, None, None] * wphi[:, None]
    volume = 0.5 * np.sum(x[..., 0] * n[..., 0] + x[..., 1] * n[..., 1])
    N = bsplines(tube.along, tube.p, z)[:, [0, -1]]
    return volume, np.einsum("zp,ze->e", n[..., 2], N)


def end_areas(tube, face):
    """The areas that a wall encloses at both ends."""
    _, _, (phi, wphi) = tube.gauss()
    z = [tube.along[0], tube.along[-1]]
    x, x_phi = (tube.evaluate(tube.points, z, [tube.faces()[face]], phi, d)[:, 0] for d in (None, 2))
    return 0.5 * np.sum((x[..., 0] * x_phi[..., 1] - x[..., 1] * x_phi[..., 0]) * wphi, axis=1)


# -- Geometry ----------------------------------------------------------------------------------------------------------


def meridian(tube, face, per_element=12):
    """Dense points (z, distance from the axis) of an axisymmetric wall."""
    breaks = np.unique(tube.along)
    z = np.concatenate([np.linspace(a, b, per_element, endpoint=False) for a, b in zip(breaks, breaks[1:])] + [breaks[-1:]])
    x = tube.evaluate(tube.points, z, [tube.faces()[face]], [0.0])[:, 0, 0]
    return np.stack([x[:, 2], np.hypot(x[:, 0], x[:, 1])], -1), z


def polyline_crosses(points):
    """True if a polyline crosses itself."""
    a, b = points[:-1], points[1:]
    n = len(a)

    def side(p, q, r):
        return (q[..., 0] - p[..., 0]) * (r[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (r[..., 0] - p[..., 0])

    low, high = np.minimum(a, b), np.maximum(a, b)
    for i in range(n - 2):
        j = np.arange(i + 2, n)
        j = j[np.all((low[j] <= high[i]) & (high[j] >= low[i]), axis=1)]
        if len(j) == 0:
            continue
        c, d = a[j], b[j]
        first = side(a[i], b[i], c) * side(a[i], b[i], d) < 0
        second = side(c, d, np.broadcast_to(a[i], c.shape)) * side(c, d, np.broadcast_to(b[i], c.shape)) < 0
        if np.any(first & second):
            return True
    return False


def surface(tube, face, along=3, around=4):
    """Points of a wall on a grid (along, around), the whole tube."""
    breaks = np.unique(tube.along)
    z = np.concatenate([np.linspace(a, b, along, endpoint=False) for a, b in zip(breaks, breaks[1:])] + [breaks[-1:]])
    phi = np.arange(around * tube.around) * PHI / (around * tube.around)
    return tube.evaluate(tube.points, z, [tube.faces()[face]], phi)[:, 0]


def surface_crosses(grid):
    """True if an edge of the triangles of a closed grid passes through another triangle."""
    m, n = grid.shape[:2]
    index = np.arange(m * n).reshape(m, n)
    right = np.roll(index, -1, axis=1)
    triangles = np.concatenate([
        np.stack([index[:-1], right[:-1], right[1:]], -1).reshape(-1, 3),
        np.stack([index[:-1], right[1:], index[1:]], -1).reshape(-1, 3),
    ])
    x = grid.reshape(-1, 3)
    edges = np.unique(np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1), axis=0)
    low, high = x[triangles].min(1), x[triangles].max(1)
    cell = np.median(high - low) * 4 + 1e-9
    table = {}
    for k, (a, b) in enumerate(zip(np.floor(low / cell).astype(int), np.floor(high / cell).astype(int))):
        for i in range(a[0], b[0] + 1):
            for j in range(a[1], b[1] + 1):
                for l in range(a[2], b[2] + 1):
                    table.setdefault((i, j, l), []).append(k)
    pairs = []
    elow, ehigh = x[edges].min(1), x[edges].max(1)
    for k, (a, b) in enumerate(zip(np.floor(elow / cell).astype(int), np.floor(ehigh / cell).astype(int))):
        near = set()
        for i in range(a[0], b[0] + 1):
            for j in range(a[1], b[1] + 1):
                for l in range(a[2], b[2] + 1):
                    near.update(table.get((i, j, l), ()))
        pairs.extend((k, t) for t in near)
    pairs = np.array(pairs)
    e, t = edges[pairs[:, 0]], triangles[pairs[:, 1]]
    apart = ~np.any(e[:, :, None] == t[:, None, :], axis=(1, 2))
    e, t = e[apart], t[apart]
    p, d = x[e[:, 0]], x[e[:, 1]] - x[e[:, 0]]
    a, u, v = x[t[:, 0]], x[t[:, 1]] - x[t[:, 0]], x[t[:, 2]] - x[t[:, 0]]
    normal = np.cross(u, v)
    along = np.einsum("ki,ki->k", normal, d)
    with np.errstate(divide="ignore", invalid="ignore"):
        s = np.einsum("ki,ki->k", normal, a - p) / along
        q = p + s[:, None] * d - a
        det = np.einsum("ki,ki->k", normal, normal)
        alpha = np.einsum("ki,ki->k", np.cross(q, v), normal) / det
        beta = np.einsum("ki,ki->k", np.cross(u, q), normal) / det
        inside = (s > 0) & (s < 1) & (alpha > 0) & (beta > 0) & (alpha + beta < 1)
    return bool(np.any(inside))


def wall_angle_and_overhang(points):
    """Largest angle with the axis, followed from colon to ileum, and the largest distance by which the wall runs back."""
    step = np.diff(points, axis=0)
    angle = np.unwrap(np.arctan2(step[:, 1], step[:, 0]))
    back = np.max(np.maximum.accumulate(points[:, 0]) - points[:, 0])
    return np.degrees(np.max(np.abs(angle))), back


def distance_to_obstacle(shape, at, radius, x, diameter):
    """Distance of points from an obstacle, positive outside it; the unit is the diameter."""
    ((kind, about),) = shape.items()
    rel = x - np.array(at)
    if kind == "ball":
        return np.linalg.norm(rel, axis=-1) - radius
    if kind == "sheath":
        return radius - np.hypot(rel[..., 0], rel[..., 1])
    if kind == "rod":
        beyond = np.maximum(np.abs(rel[..., 2]) - 0.5 * about.get("length", np.inf) / diameter, 0)
        return np.sqrt(rel[..., 0] ** 2 + rel[..., 1] ** 2 + beyond**2) - radius
    normal = np.array(about["normal"])
    return rel @ (normal / np.linalg.norm(normal))


# -- Statements --------------------------------------------------------------------------------------------------------


def intervals(flags):
    """Pairs of the first and last index of consecutive true flags."""
    found = []
    for i, flag in enumerate(flags):
        if flag and found and found[-1][1] == i - 1:
            found[-1][1] = i
        elif flag:
            found.append([i, i])
    return found


def extremes(rows):
    """Indices of the energy minima and maxima inside the stages."""
    w = [row["energy"] for row in rows]
    largest = max(abs(value) for value in w)
    found, first = [], 0
    while first < len(rows) - 1:
        last = first + 1
        while last + 1 < len(rows) and rows[last + 1]["stage"] == rows[first + 1]["stage"]:
            last += 1
        part = [i for i in range(first, last + 1)]
        keep = [part[0]]
        for i in part[1:]:
            if abs(w[i] - w[keep[-1]]) > 1e-6 * largest:
                keep.append(i)
        for a, b, c in zip(keep, keep[1:], keep[2:]):
            if (w[b] - w[a]) * (w[c] - w[b]) < 0:
                found.append((b, w[b] < w[a]))
        first = last
    return found


class Check:
    def __init__(self, path):
        self.path, self.failures, self.count, self.worst = path, [], 0, {}

    def that(self, condition, text):
        self.count += 1
        if not condition:
            self.failures.append(text)

    def close(self, name, state, found, expected, tolerance):
        """Compares numbers; keeps the largest error of each name, over its tolerance."""
        error = abs(found - expected)
        self.worst[name] = max(self.worst.get(name, 0.0), error / tolerance)
        self.that(error <= tolerance, f"state {state}: {name} {found:.9g}, independently {expected:.9g}")


def number(text):
    try:
        return float(text)
    except ValueError:
        return text


def covered(case):
    """True if the independent energy covers the case."""
    material = case.get("material", {})
    unknown = ("layers", "patches", "foundations", "residual", "fibres", "start")
    muscles = case.get("muscles", {}).values()
    return (
        (not material or "neo-hookean" in material and "shear_modulus" not in material["neo-hookean"])
        and not any(key in case for key in unknown)
        and not any(key in muscle for muscle in muscles for key in ("sector", "repeat", "layer", "active_stress"))
        and case.get("mesh", {}).get("volumetric_integration", "full") == "full"
        and all(i["of"] == "geometry" for i in case.get("imperfections", []))
        and not any("shift" in drive for stage in case["stages"] for drive in stage.get("drive", {}).values())
    )


def check_states(check, path, case, rows):
    units = case.get("units")
    # Without units, results are in diameters, whatever the unit of the lengths in the case.
    size = case.get("tube", {}).get("diameter", 1.0)
    D = size if units else 1.0
    law = case.get("material", {}).get("neo-hookean", {})
    E = law.get("youngs_modulus", 1.0) if units else 1.0
    W, Fo = E * D**3, E * D**2
    contact = case.get("contact", False)
    energy_is_covered = covered(case)
    ends = [name[len("axial_force_"):] for name in rows[0] if name.startswith("axial_force_")]
    largest_w = max(abs(row["energy"]) for row in rows)
    crossed = []
    rest = Tube(*read(path / "states/state-0000.safetensors")).points if energy_is_covered else None
    for file in sorted((path / "states").glob("state-*.safetensors")):
        about, arrays = read(file)
        n = about["row"]
        row = rows[n]
        tube = Tube(about, arrays)
        check.that(row["stage"] == about["stage"], f"state {n}: stage")
        volume = {face: wall_integrals(tube, face) for face in tube.faces()}
        check.close("lumen_volume", n, row["lumen_volume"] / D**3, volume["inner"][0], 1e-8 * tube.length)
        if energy_is_covered:
            w, ungrown, forces = energy_and_force(tube, rest, case, about["load"], size)
            check.close("energy", n, row["energy"] / W, w, 1e-10 * abs(largest_w / W) + 1e-15)
            check.close("energy_ungrown_volume", n, row["energy_ungrown_volume"] / W, ungrown, 1e-10 * abs(largest_w / W) + 1e-15)
            # The support holds the wall and the lids: what the stress carries, less the forces of pressures on the wall.
            touching = contact or case.get("obstacles")
            if not touching and ends and not any("dead_load" in name and row.get(name) for name in row):
                p_i, p_o = (row.get(k, 0.0) / E for k in ("inner_pressure", "outer_pressure"))
                lids = p_o * end_areas(tube, "outer") - p_i * end_areas(tube, "inner")
                wall = forces - p_i * volume["inner"][1] + p_o * volume["outer"][1]
                for k, sign in ((0, -1.0), (1, 1.0)):
                    kind = case.get("ends", {}).get(ends[k], "fixed")
                    expected = sign * wall[k] + lids[k] if kind != "free" else None
                    if expected is not None:
                        scale = max(abs(expected), 1e-3 * np.sqrt(abs(w)) * 0.1, 1e-7)
                        check.close("axial_force", n, row[f"axial_force_{ends[k]}"] / Fo, expected, 1e-5 * scale)
        if tube.rings == 1:
            outer, at = meridian(tube, "outer")
            inner, _ = meridian(tube, "inner")
            angle, back = wall_angle_and_overhang(outer)
            check.close("outer_radius_min", n, row["outer_radius_min"] / D, outer[:, 1].min(), 2e-4)
            check.close("outer_radius_max", n, row["outer_radius_max"] / D, outer[:, 1].max(), 2e-4)
            middle = np.hypot(*tube.evaluate(tube.points, [tube.length / 2], [0.5], [0.0])[0, 0, 0, :2])
            check.close("outer_radius_mid", n, row["outer_radius_mid"] / D, middle, 1e-9)
            check.close("overhang", n, row["overhang"] / D, back, 5e-4)
            check.close("max_wall_angle_deg", n, row["max_wall_angle_deg"], min(angle, 180.0), 4.0)
            lumen = 2 * inner[:, 1].min()
            if row["lumen"] > 0:
                check.close("lumen", n, row["lumen"] / D, lumen, 2e-3)
            crosses = {face: polyline_crosses(wall) for face, wall in (("outer", outer), ("inner", inner))}
            any_crosses = any(crosses.values())
        else:
            any_crosses = any(surface_crosses(surface(tube, face)) for face in tube.faces())
        if any_crosses:
            crossed.append(n)
        if contact:
            check.that(not any_crosses, f"state {n}: a wall crosses itself although it has contact")
        if contact or tube.rings == 1:
            if any_crosses != (row["gap"] == 0):
                check.that(False, f"state {n}: gap {row['gap']}, independently {'crossing' if any_crosses else 'not crossing'}")
        elif any_crosses and row["gap"] > 0:
            check.that(False, f"state {n}: gap {row['gap']}, independently crossing")
        for k, obstacle in enumerate(case.get("obstacles", [])):
            name = obstacle["name"]
            place = [row[f"{axis}_{name}"] / D for axis in "xyz"]
            for face in tube.faces():
                radius = row[f"radius_{name}"] / D
                distance = distance_to_obstacle(obstacle["shape"], place, radius, surface(tube, face), size)
                if row["equilibrium"] == "yes":
                    check.that(distance.min() > -2e-4, f"state {n}: {face} wall {-distance.min():.2e} D inside {name}")
    return crossed


def check_statements(check, path, case, rows, plica):
    table = json.loads(subprocess.run([plica, "table", str(path), "--json"], check=True, capture_output=True, text=True).stdout)
    found = table[0]["findings"]
    manifest = json.loads((path / "manifest.json").read_text())
    symmetric = [row["unstable_modes"] for row in rows]

    def same(key, flags):
        stated = [[i["first"]["state"], i["last"]["state"]] for i in found[key]]
        check.that(stated == intervals(flags), f"{key}: {stated}, from the rows {intervals(flags)}")

    same("square", [row["shape"] == "square" for row in rows])
    same("invaginated", [row["shape"] == "invaginated" for row in rows])
    same("overhanging", [row["max_wall_angle_deg"] >= 90 and row["overhang"] > 0 for row in rows])
    same("crossing", [row["gap"] == 0 for row in rows])
    same("closed", [row["lumen"] <= 0 for row in rows])
    same("out_of_equilibrium", [row["equilibrium"] == "no" for row in rows])
    same("untested", [modes == "unknown" for modes in symmetric])
    stated = [(e["at"]["state"], e["is_minimum"]) for e in found["extremes"]]
    check.that(stated == extremes(rows), f"extremes: {stated}, from the rows {extremes(rows)}")
    unstable = [m not in ("none", "unknown") for m in symmetric]
    counts = {
        "states": len(rows),
        "states_crossing": sum(row["gap"] == 0 for row in rows),
        "states_closed": sum(row["lumen"] <= 0 for row in rows),
        "states_out_of_equilibrium": sum(row["equilibrium"] == "no" for row in rows),
        "states_unstable": sum(unstable),
        "states_untested": sum(m == "unknown" for m in symmetric),
    }
    for key, value in counts.items():
        check.that(manifest[key] == value, f"manifest {key}: {manifest[key]}, from the rows {value}")
    # Stages: name, states, shape and energy of the last state.
    ends = [(rows[i]["stage"], i) for i in range(1, len(rows)) if i + 1 == len(rows) or rows[i + 1]["stage"] != rows[i]["stage"]]
    stated = [(s["name"], s["states"][1]) for s in found["stages"]]
    check.that(stated == ends, f"stages: {stated}, from the rows {ends}")
    for stage, (_, i) in zip(found["stages"], ends):
        check.that(stage["shape"] == rows[i]["shape"], f"stage {stage['name']}: shape")
        check.that(stage["energy"] == rows[i]["energy"], f"stage {stage['name']}: energy")
    # Balance of energy in every row.
    works = [name for name in rows[0] if name.startswith("work_")]
    friction = [name for name in rows[0] if name.startswith("friction_work_")]
    stored = ["energy", "foundation_energy"] + [n for n in rows[0] if n.startswith("contact_energy") and n != "contact_energy_share"]
    damping = 0.0
    scale = max(max(abs(row["energy"]) for row in rows), *(abs(row[w]) for row in rows for w in works)) if works else 1.0
    for n, row in enumerate(rows):
        damping += row["damping_work"]
        gain = sum(row.get(k, 0.0) - rows[0].get(k, 0.0) for k in stored)
        balance = sum(row[w] for w in works) - damping - sum(row[f] for f in friction) - row["released_energy"]
        check.close("energy balance", n, gain, balance, 1e-9 * scale + 1e-15)
    for name, muscle in case.get("muscles", {}).items():
        if muscle["direction"] == "circular" and f"stretch_{name}" in rows[0]:
            for n, row in enumerate(rows):
                check.close("stretch", n, row[f"stretch_{name}"], row[f"target_{name}"], 1e-12)
    # Shapes by the documented conditions that columns decide.
    for n, row in enumerate(rows):
        if row["shape"] == "invaginated":
            check.that(row["max_wall_angle_deg"] >= 90, f"state {n}: invaginated at {row['max_wall_angle_deg']}°")
        if row["shape"] == "square":
            check.that(78 <= row["max_wall_angle_deg"] < 90, f"state {n}: square at {row['max_wall_angle_deg']}°")
        if row["shape"] == "V":
            check.that(row["flatness"] < 0.5, f"state {n}: V with flatness {row['flatness']}")
        if row["shape"] == "U":
            check.that(row["flatness"] >= 0.5, f"state {n}: U with flatness {row['flatness']}")
    return found


def check_run(path, plica):
    path = Path(path)
    check = Check(path)
    case = tomllib.loads((path / "case.toml").read_text())
    with open(path / "history.csv", newline="") as file:
        rows = [{k: number(v) for k, v in row.items()} for row in csv.DictReader(file)]
    if rows:
        check_states(check, path, case, rows)
        check_statements(check, path, case, rows, plica)
    return check


def main(plica, paths):
    failed, total, worst = 0, 0, {}
    for path in paths:
        check = check_run(path, plica)
        total += check.count
        for name, ratio in check.worst.items():
            worst[name] = max(worst.get(name, 0.0), ratio)
        if check.failures:
            failed += 1
            print(f"{path}: {len(check.failures)} of {check.count} statements differ")
            for text in check.failures[:12]:
                print(f"  {text}")
    print(f"{len(paths)} runs, {total} statements, {failed} runs with differences")
    print("largest difference over tolerance:", ", ".join(f"{k} {v:.2g}" for k, v in sorted(worst.items())))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
