"""Evaluates the spline of a saved state, with NumPy alone: position(read(path), z, r, phi) is (x, y, z) in diameters."""
import json, sys
import numpy as np

def read(path):
    raw = open(path, "rb").read()
    end = 8 + int.from_bytes(raw[:8], "little")
    header = json.loads(raw[8:end])
    about = json.loads(header.pop("__metadata__")["plica"])
    array = lambda a: np.frombuffer(raw[end:], "<f8", int(np.prod(a["shape"])), a["data_offsets"][0]).reshape(a["shape"])
    return about, {name: array(a) for name, a in header.items()}

def bsplines(t, p, x):  # all B-splines of degree p on the knots t, at x, by the recurrence of Cox and de Boor
    ratio = lambda a, b: np.divide(a, b, where=b > 0, out=np.zeros_like(b))
    N = np.zeros(len(t) - 1)
    N[min(np.searchsorted(t, x, "right"), len(t) - 1 - p) - 1] = 1
    for d in range(1, p + 1):
        width = t[d:] - t[:-d]
        N = ratio(x - t[:-d], width)[:-1] * N[:-1] + ratio(t[d:] - x, width)[1:] * N[1:]
    return N

def position(state, z, r, phi):
    about, a = state
    p, n, rings = about["mesh"]["degree"], about["mesh"]["around"], about["rings"]
    s = phi * n / (2 * np.pi) + 0.5
    B = bsplines(np.arange(-p, p + 2.0), p, s - np.floor(s))
    N, M = bsplines(a["knots_along"], p, z), bsplines(a["knots_through"], p, r)
    P = np.einsum("a,c,acji->ji", N, M, a["control_points"])
    x = np.zeros(3)
    for b in range(p + 1):
        j = (int(np.floor(s)) + b) % n
        c, q = np.cos(j // rings * rings * 2 * np.pi / n), np.sin(j // rings * rings * 2 * np.pi / n)
        x += B[b] * np.array([[c, -q, 0], [q, c, 0], [0, 0, 1]]) @ P[j % rings]
    return x

if __name__ == "__main__":  # FILE Z R PHI
    print(*position(read(sys.argv[1]), *map(float, sys.argv[2:5])))
