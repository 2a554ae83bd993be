"""Reads the VTK files of a run with VTK and compares them with the tables of the run.

    python scripts/check_vtk.py RUN_DIR

The run has units of D and E. `plica export RUN_DIR --linear --hdf`, with or without --state, must precede.
"""

import csv
import sys
from pathlib import Path

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

sys.path.insert(0, str(Path(__file__).parent.parent / "docs"))
import evaluate_state

GAUSS = 6  # points in each direction; the volume of a cubic map takes five


def read(path):
    """Reads a grid or a surface."""
    kinds = {".vtu": vtk.vtkXMLUnstructuredGridReader, ".vtp": vtk.vtkXMLPolyDataReader}
    reader = kinds[path.suffix]()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0, path
    read = reader.GetOutput()
    for data in (read.GetPointData(), read.GetCellData(), read.GetFieldData()):
        for i in range(data.GetNumberOfArrays()):
            assert np.isfinite(vtk_to_numpy(data.GetArray(i))).all(), (path, data.GetArrayName(i))
    return read


def field(data, name):
    array = data.GetPointData().GetArray(name)
    assert array is not None, f"no field {name}"
    return vtk_to_numpy(array).astype(float)


def functions(cell, places):
    """Returns values and gradients of a cell's shape functions at points, from VTK."""
    nodes = cell.GetNumberOfPoints()
    # VTK orders derivatives by direction in linear cells, and by node in others.
    linear = cell.GetCellType() == vtk.VTK_HEXAHEDRON
    values, slopes = [], []
    for place in places:
        n, d = [0.0] * nodes, [0.0] * (3 * nodes)
        cell.InterpolateFunctions(list(place), n)
        cell.InterpolateDerivs(list(place), d)
        values.append(n)
        slopes.append(np.reshape(d, (3, nodes)) if linear else np.reshape(d, (nodes, 3)).T)
    return np.array(values), np.array(slopes)


def gauss():
    at, weights = np.polynomial.legendre.leggauss(GAUSS)
    at, weights = 0.5 * (at + 1), 0.5 * weights
    places = np.stack(np.meshgrid(at, at, at, indexing="ij"), axis=-1).reshape(-1, 3)
    return places, np.einsum("i,j,k->ijk", weights, weights, weights).ravel()


def cells_of(grid):
    cells = grid.GetNumberOfCells()
    connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(cells, -1)
    return np.array_split(connectivity, max(1, cells // 2000))


def volume_of(grid, positions):
    """Returns the volume of a grid with points at `positions`, by the shape functions of VTK."""
    places, weights = gauss()
    _, slopes = functions(grid.GetCell(0), places)
    volume, smallest = 0.0, np.inf
    for some in cells_of(grid):
        jacobian = np.linalg.det(np.einsum("qan,cni->cqai", slopes, positions[some]))
        smallest = min(smallest, jacobian.min())
        volume += np.einsum("cq,q->", jacobian, weights)
    assert smallest > 0, "inverted cell"
    return volume


def mechanics(rest, now, slopes, values, some, theta):
    """Evaluates the model at points of cells from the map of VTK."""
    of_rest = np.einsum("qan,cni->cqia", slopes, rest[some])
    of_now = np.einsum("qan,cni->cqia", slopes, now[some])
    f = of_now @ np.linalg.inv(of_rest)
    # Axial, radial and circumferential directions at the reference point.
    x = np.einsum("qn,cni->cqi", values, rest[some])
    outwards = x[..., :2] / np.linalg.norm(x[..., :2], axis=-1, keepdims=True)
    zero = np.zeros(x.shape[:-1])
    axes = np.stack(
        [
            np.stack([zero, zero, zero + 1], -1),
            np.stack([outwards[..., 0], outwards[..., 1], zero], -1),
            np.stack([-outwards[..., 1], outwards[..., 0], zero], -1),
        ],
        axis=-1,
    )
    columns = f @ axes
    along, around = (np.einsum("qn,cn->cq", values, t[some]) for t in theta)
    elastic = columns / np.stack([along, zero + 1, around], -1)[..., None, :]
    jacobian = np.linalg.det(elastic)
    nu = 0.495
    mu, lame = 1 / (2 * (1 + nu)), nu / ((1 + nu) * (1 - 2 * nu))
    first = (elastic**2).sum(axis=(-1, -2))
    energy = 0.5 * mu * (first - 3) - mu * np.log(jacobian) + 0.5 * lame * np.log(jacobian) ** 2
    left = elastic @ np.swapaxes(elastic, -1, -2)
    stress = (mu * (left - np.eye(3)) + lame * np.log(jacobian)[..., None, None] * np.eye(3)) / jacobian[..., None, None]
    strain = 0.5 * (np.swapaxes(columns, -1, -2) @ columns - np.eye(3))
    return np.linalg.det(of_rest), along * around, jacobian, energy, stress, strain


def close(what, found, expected, tolerance):
    error = abs(found - expected) / abs(expected)
    print(f"{what:<58} {found:.8e}  {expected:.8e}  error {error:.0e}, tolerance {tolerance:.0e}")
    assert error <= tolerance, what


def meridian(grid, normal):
    """Returns the points in which VTK cuts a grid by a plane through the axis."""
    plane = vtk.vtkPlane()
    plane.SetNormal(*normal)
    cutter = vtk.vtkCutter()
    cutter.SetCutFunction(plane)
    cutter.SetInputData(grid)
    cutter.Update()
    points = vtk_to_numpy(cutter.GetOutput().GetPoints().GetData()).astype(float)
    return points


def check_walls(rest, now, linear, profile):
    """Compares the walls of an axisymmetric state with its profile."""
    # Points on the outer and inner wall lie on the profile.
    z, r = now[:, 2], np.hypot(now[:, 0], now[:, 1])
    outside, inside = rest[:, 0] ** 2 + rest[:, 1] ** 2 > 0.4999**2, rest[:, 0] ** 2 + rest[:, 1] ** 2 < 0.4401**2
    for name, of in [("outer", outside), ("inner", inside)]:
        at = {round(float(p["reference_z"]), 9): (float(p[f"{name}_z"]), float(p[f"{name}_r"])) for p in profile}
        seen = 0
        for point in np.flatnonzero(of):
            known = at.get(round(float(rest[point, 2]), 9))
            if known:
                seen += 1
                assert np.hypot(z[point] - known[0], r[point] - known[1]) < 1e-6, (name, point)
        print(f"{name} wall: {seen} points lie on the profile")
        assert seen > 10

    # A slice of the linear cells lies between the walls of the profile.
    cut = meridian(linear, (0.3, 1.0, 0.0))
    radii = np.hypot(cut[:, 0], cut[:, 1])
    lowest = min(float(p["inner_r"]) for p in profile)
    highest = max(float(p["outer_r"]) for p in profile)
    assert lowest - 2e-3 < radii.min() and radii.max() < highest + 2e-3
    print(f"slice: {len(cut)} points, radii {radii.min():.4f} to {radii.max():.4f}")


def check_state(run, number, row, profile):
    print(f"state {number}")
    grid = read(run / "vtk" / "volume" / f"state-{number:04}.vtu")
    assert grid.GetCellType(0) == vtk.VTK_LAGRANGE_HEXAHEDRON
    now = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    rest = now - field(grid, "displacement")
    theta = [field(grid, "theta_zeta"), field(grid, "theta_eta")]
    volume = volume_of(grid, now)
    # A periodic spline with 60 control points approximates a circle to 1e-7.
    close("reference volume of the hollow cylinder", volume_of(grid, rest), np.pi * (0.25 - 0.44**2) * 3, 1e-5)

    # The energy of the map of VTK, by the formulas of the model.
    places, weights = gauss()
    values, slopes = functions(grid.GetCell(0), places)
    energy = swollen = 0.0
    for some in cells_of(grid):
        size, grown, j, w, _, _ = mechanics(rest, now, slopes, values, some, theta)
        energy += np.einsum("cq,q->", size * grown * w, weights)
        swollen += np.einsum("cq,q->", size * grown * j, weights)
    close("volume, and integral of det F over the reference volume", volume, swollen, 1e-5)
    if float(row["energy"]) > 1e-8:
        close("energy of the map of VTK, and W of history.csv", energy, float(row["energy"]), 1e-3)

    # Every field at every node.
    corners = np.array(grid.GetCell(0).GetParametricCoords()).reshape(-1, 3)
    values, slopes = functions(grid.GetCell(0), corners)
    names = ["det_Fe", "strain_energy_density", "cauchy_stress", "green_lagrange_strain"]
    fields = [field(grid, name) for name in names]
    worst = np.zeros(4)
    for some in cells_of(grid):
        _, _, j, w, stress, strain = mechanics(rest, now, slopes, values, some, theta)
        six = lambda t, order: np.stack([t[..., a, b] for a, b in order], -1)
        stress = six(stress, [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)])
        # Axes: axial, radial, circumferential.
        strain = six(strain, [(0, 0), (2, 2), (1, 1), (0, 2), (2, 1), (0, 1)])
        for i, (found, of) in enumerate(zip([j, w, stress, strain], fields)):
            worst[i] = max(worst[i], abs(found - of[some]).max() / max(1e-3, abs(of).max()))
    for name, error in zip(names, worst):
        print(f"{name}: largest error at a node {error:.0e} of the largest value")
        assert error < 1e-3, name

    # The linear cells have the same points and nearly the same volume.
    linear = read(run / "vtk" / "linear" / f"state-{number:04}.vtu")
    assert linear.GetCellType(0) == vtk.VTK_HEXAHEDRON
    assert np.array_equal(vtk_to_numpy(linear.GetPoints().GetData()), now)
    close("volume of linear cells", volume_of(linear, now), volume, 1e-2)

    if int(row["asymmetry_mode"]) == 0:
        check_walls(rest, now, linear, profile)

    # Stretches and directions are consistent.
    stretch, j = field(grid, "elastic_stretch"), field(grid, "det_Fe")
    assert np.allclose(stretch.prod(axis=1), j, rtol=1e-5)
    assert (np.diff(stretch, axis=1) <= 1e-6).all()
    directions = [field(grid, f"elastic_direction_{i}") for i in (1, 2, 3)]
    for a, direction in enumerate(directions):
        for b, other in enumerate(directions):
            assert np.allclose((direction * other).sum(axis=1), float(a == b), atol=1e-5)
    # Principal Cauchy stresses follow from the stretches by the neo-Hookean law.
    nu = 0.495
    mu, lame = 1 / (2 * (1 + nu)), nu / ((1 + nu) * (1 - 2 * nu))
    principal = (mu * (stretch**2 - 1) + (lame * np.log(j))[:, None]) / j[:, None]
    s = field(grid, "cauchy_stress")
    tensor = np.stack([s[:, [0, 3, 5]], s[:, [3, 1, 4]], s[:, [5, 4, 2]]], axis=1)
    for i, direction in enumerate(directions):
        along = np.einsum("ni,nij,nj->n", direction, tensor, direction)
        assert np.allclose(along, principal[:, i], atol=2e-5 * max(1.0, abs(principal).max())), i
    deviator = principal - principal.mean(axis=1, keepdims=True)
    mises = np.sqrt(1.5 * (deviator**2).sum(axis=1))
    assert np.allclose(field(grid, "von_mises_stress"), mises, atol=2e-5 * max(1.0, mises.max()))

    # The Green-Lagrange strain of the total deformation gives det F.
    e = field(grid, "green_lagrange_strain")
    c = 2 * np.stack([e[:, [0, 3, 5]], e[:, [3, 1, 4]], e[:, [5, 4, 2]]], axis=1) + np.eye(3)
    assert np.allclose(np.sqrt(np.linalg.det(c)), j * theta[0] * theta[1], rtol=1e-4)

    # The surface is closed, has outward normals, and encloses the same volume.
    walls = read(run / "vtk" / "walls" / f"state-{number:04}.vtp")
    edges = vtk.vtkFeatureEdges()
    edges.SetInputData(walls)
    edges.BoundaryEdgesOn()
    edges.NonManifoldEdgesOn()
    edges.FeatureEdgesOff()
    edges.ManifoldEdgesOff()
    edges.Update()
    assert edges.GetOutput().GetNumberOfCells() == 0, "the surface has holes"
    points = vtk_to_numpy(walls.GetPoints().GetData())
    quads = vtk_to_numpy(walls.GetPolys().GetConnectivityArray()).reshape(-1, 4)
    a, b, c, d = (points[quads[:, i]] for i in range(4))
    six = np.einsum("ni,ni->n", a, np.cross(b, c)) + np.einsum("ni,ni->n", a, np.cross(c, d))
    close("volume enclosed by the surface", six.sum() / 6, volume, 1e-2)


def check_series(run, number):
    """Compares the file of all states with the surface of one state."""
    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(run / "vtk" / "walls.vtkhdf"))
    reader.UpdateInformation()
    key = vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS()
    times = list(reader.GetOutputInformation(0).Get(key))
    saved = sorted(int(path.stem.split("-")[1]) for path in (run / "states").glob("state-*"))
    assert times == saved, (times, saved)
    reader.UpdateTimeStep(number)
    series, walls = reader.GetOutputDataObject(0), read(run / "vtk" / "walls" / f"state-{number:04}.vtp")
    points = [vtk_to_numpy(mesh.GetPoints().GetData()) for mesh in (series, walls)]
    assert np.abs(points[0] - points[1]).max() < 1e-6
    quads = [vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()) for mesh in (series, walls)]
    assert np.array_equal(*quads)
    names = [walls.GetPointData().GetArrayName(i) for i in range(walls.GetPointData().GetNumberOfArrays())]
    for name in names:
        assert np.array_equal(field(series, name), field(walls, name)), name
    faces = [vtk_to_numpy(mesh.GetCellData().GetArray("face")) for mesh in (series, walls)]
    assert np.array_equal(*faces) and set(faces[0]) == {0, 1, 2, 3}
    for name in ["state", "length_ratio", "diameter_ratio", "energy"]:
        values = [mesh.GetFieldData().GetArray(name) for mesh in (series, walls)]
        assert [value.GetNumberOfTuples() for value in values] == [1, 1], name
        assert values[0].GetValue(0) == values[1].GetValue(0), name
    print(f"file of all states: {len(times)} states; {len(names)} fields, faces and field data equal those of state {number}")


def parameters(state, x, y):
    """Returns the parameters r and phi of a point of the tube at rest, whose circles are splines."""
    degree, rings = state[0]["mesh"]["degree"], state[0]["mesh"]["around"]

    def circle(phi):
        s = phi * rings / (2 * np.pi) + 0.5
        values = evaluate_state.bsplines(np.arange(-degree, degree + 2.0), degree, s - np.floor(s))
        angles = (np.floor(s) + np.arange(degree + 1) - degree / 2) * 2 * np.pi / rings
        return values @ np.exp(1j * angles)

    # The control radius of the circle nearest to the unit circle; it repeats from element to element.
    some = (np.arange(64) + 0.5) / 64 * 2 * np.pi / rings
    control = sum((np.conj(circle(p)) * np.exp(1j * p)).real for p in some) / sum(abs(circle(p)) ** 2 for p in some)
    phi = np.arctan2(y, x)
    for _ in range(4):
        phi += np.angle((x + 1j * y) / circle(phi))
    return np.hypot(x, y) / (control * abs(circle(phi))), phi


def check_spline(run, number):
    """Compares the nodes of a state with its spline, evaluated from knots and control points, and reads its meridian."""
    volume = read(run / "vtk" / "volume" / f"state-{number:04}.vtu")
    now = vtk_to_numpy(volume.GetPoints().GetData())
    rest = now - field(volume, "displacement")
    state = evaluate_state.read(run / "states" / f"state-{number:04}.safetensors")
    some = np.linspace(0, len(now) - 1, 150).astype(int)
    inner, outer = 0.5 - state[0]["tube"]["thickness"], 0.5
    at = [(np.clip(z, 0, state[0]["tube"]["length"]), *parameters(state, x, y)) for x, y, z in rest[some]]
    at = [(z, np.clip(r, inner, outer), phi) for z, r, phi in at]
    spline = np.array([evaluate_state.position(state, *place) for place in at])
    error = np.abs(spline - now[some]).max()
    assert error < 1e-6, error
    print(f"nodes from knots and control points: largest error {error:.0e}")
    path = run / "vtk" / "meridian" / f"state-{number:04}.vtp"
    assert path.exists() == (state[0]["rings"] == 1), path
    if path.exists():
        meridian = read(path)
        points = vtk_to_numpy(meridian.GetPoints().GetData())
        assert meridian.GetNumberOfCells() > 0 and field(meridian, "cauchy_stress").shape == (len(points), 6)
        print(f"meridian: {len(points)} points, {path.stat().st_size} bytes")


def main():
    run = Path(sys.argv[1])
    rows = {int(row["step"]): row for row in csv.DictReader(open(run / "history.csv"))}
    volumes = sorted((run / "vtk" / "volume").glob("state-*.vtu"))
    assert volumes, "no volumes"
    for path in volumes:
        number = int(path.stem.split("-")[1])
        profile = list(csv.DictReader(open(run / "profiles" / f"{path.stem}.csv")))
        check_state(run, number, rows[number], profile)
        check_series(run, number)
        check_spline(run, number)
    for name in ["walls", "volume", "linear"]:
        text = (run / "vtk" / f"{name}.pvd").read_text()
        named = [run / "vtk" / part.split('"')[0] for part in text.split('file="')[1:]]
        assert named and all(path.exists() for path in named), name
        print(f"{name}.pvd names {len(named)} files")


main()
