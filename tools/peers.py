"""Pliant beside libigl and Open3D on the same meshes and handles, in one run; prints Markdown tables.

    pip install libigl open3d numpy
    python tools/peers.py target/release/pliant NAME.obj NAME.handles.json [NAME.obj NAME.handles.json ...]

`cargo xtask bench --peers` makes the meshes and calls this. A package that cannot be loaded is left out and named.

Energies of all programs are evaluated here by one formula, sum over k of the sum over the edges at k of
w |e' - R e|^2 with w = (cot a + cot b) / 2 and the best R for every vertex, outside of the time that is taken. That is
the same energy for all only where no weight is negative, as on the bodies that `cargo xtask bench` makes.
"""

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

try:
    import numpy as np
except ImportError:
    sys.exit("numpy is missing: pip install numpy libigl")

# An iteration's time is taken between these two numbers of them, so that nothing else counts.
FEW, MANY = 30, 130
# Repetitions, of which the median is told.
REPETITIONS = 3


class Scene:
    """A mesh and where its held vertices go."""

    def __init__(self, mesh, handles):
        self.mesh, self.handles = Path(mesh), Path(handles)
        lines = [line.split() for line in self.mesh.read_text().splitlines() if line[:2] in ("v ", "f ")]
        self.points = np.array([line[1:4] for line in lines if line[0] == "v"], dtype=float)
        corners = [[corner.split("/")[0] for corner in line[1:4]] for line in lines if line[0] == "f"]
        self.faces = np.array(corners, dtype=np.int64) - 1
        wish = json.loads(self.handles.read_text())
        self.held = list(wish.get("fixed", []))
        targets = [self.points[self.held]]
        for moved in wish.get("moved", []):
            self.held.append(moved["vertex"])
            targets.append(np.array([moved["to"]]))
        for group in wish.get("groups", []):
            matrix = np.array(group["matrix"]).reshape(4, 4).T
            self.held += group["vertices"]
            targets.append(self.points[group["vertices"]] @ matrix[:3, :3].T + matrix[:3, 3])
        self.held = np.array(self.held, dtype=np.int32)
        self.targets = np.concatenate(targets)
        self._weigh()

    def _weigh(self):
        """Edges with their weights."""
        n, ends, weights = len(self.points), [], []
        for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            a, b, c = self.faces[:, a], self.faces[:, b], self.faces[:, c]
            u, v = self.points[b] - self.points[a], self.points[c] - self.points[a]
            weights.append(0.5 * np.einsum("ij,ij->i", u, v) / np.linalg.norm(np.cross(u, v), axis=1))
            ends.append(np.minimum(b, c) * n + np.maximum(b, c))
        keys, edge = np.unique(np.concatenate(ends), return_inverse=True)
        self.i, self.j = keys // n, keys % n
        self.weight = np.bincount(edge, np.concatenate(weights))
        self.rest = self.points[self.i] - self.points[self.j]

    def energy(self, points):
        """The energy of r = 1 with the best rotations."""
        n, now = len(points), points[self.i] - points[self.j]
        terms = self.weight[:, None, None] * now[:, :, None] * self.rest[:, None, :]
        sums = np.empty((n, 3, 3))
        for a in range(3):
            for b in range(3):
                sums[:, a, b] = np.bincount(self.i, terms[:, a, b], n) + np.bincount(self.j, terms[:, a, b], n)
        values = np.linalg.svd(sums, compute_uv=False)
        values[:, 2] *= np.sign(np.linalg.det(sums))
        squares = (now**2).sum(1) + (self.rest**2).sum(1)
        return 2.0 * (self.weight @ squares) - 2.0 * values.sum()


class Libigl:
    """libigl's spokes: as often as asked, from where it stands."""

    name = "libigl"

    def __init__(self, scene):
        import igl

        self.igl, self.scene, self.now = igl, scene, scene.points.copy()
        self.data = igl.ARAPData()
        self.data.energy = igl.ARAP_ENERGY_TYPE_SPOKES
        begun = time.perf_counter()
        igl.arap_precomputation(scene.points, scene.faces, 3, scene.held, self.data)
        self.setup = time.perf_counter() - begun

    def iterate(self, n):
        """Seconds for n iterations."""
        self.data.max_iter = n
        begun = time.perf_counter()
        self.now = self.igl.arap_solve(self.scene.targets, self.data, self.now)
        return time.perf_counter() - begun


class Open3D:
    """Open3D's spokes; it sets up anew with every call and always begins at rest."""

    name = "Open3D"

    def __init__(self, scene):
        import open3d

        self.o3d = open3d
        self.mesh = open3d.geometry.TriangleMesh(
            open3d.utility.Vector3dVector(scene.points), open3d.utility.Vector3iVector(scene.faces)
        )
        self.held = open3d.utility.IntVector(scene.held)
        self.targets = open3d.utility.Vector3dVector(scene.targets)
        self.setup = None

    def iterate(self, n):
        """Seconds for n iterations and the set-up before them."""
        kind = self.o3d.geometry.DeformAsRigidAsPossibleEnergy.Spokes
        begun = time.perf_counter()
        self.mesh.deform_as_rigid_as_possible(self.held, self.targets, n, energy=kind)
        return time.perf_counter() - begun


class Pliant:
    """The command line."""

    def __init__(self, program, scene, folder):
        self.command = [program, "deform", str(scene.mesh), "--handles", str(scene.handles), "--quiet"]
        self.folder = Path(folder)

    def run(self, iterations, *options):
        """Seconds of the whole process, its report, and the positions it wrote."""
        out, report = self.folder / "out.obj", self.folder / "report.json"
        command = [*self.command, "-o", str(out), "--report", str(report), "--tolerance", "0"]
        begun = time.perf_counter()
        subprocess.run([*command, "--max-iterations", str(iterations), *options], check=True)
        seconds = time.perf_counter() - begun
        rows = (line.split() for line in out.read_text().splitlines() if line.startswith("v "))
        return seconds, json.loads(report.read_text()), lambda: np.array([row[1:4] for row in rows], dtype=float)

    def iteration(self, r):
        """Seconds of one iteration of the paper's method, seen from outside."""
        options = ("--rigidity", str(r), "--solver", "local-global", "--start", "rest")
        return (self.run(MANY, *options)[0] - self.run(FEW, *options)[0]) / (MANY - FEW)


def in_turn(tasks):
    """Runs all tasks in turn, several times; the median of each."""
    taken = {name: [] for name in tasks}
    for _ in range(REPETITIONS):
        for name, task in tasks.items():
            taken[name].append(task())
    return {name: statistics.median(values) for name, values in taken.items()}


def iterations(scene, pliant, peers):
    """Milliseconds of an iteration of every program."""
    tasks = {f"Pliant r = {r}": lambda r=r: pliant.iteration(r) for r in (1, 10, 20)}
    for peer in peers:
        # Fresh ones, so that both times begin at rest.
        tasks[peer.name] = lambda peer=peer: (peer(scene).iterate(MANY) - peer(scene).iterate(FEW)) / (MANY - FEW)
    return {name: 1e3 * seconds for name, seconds in in_turn(tasks).items()}


def setups(scene, pliant):
    """Milliseconds until the first iteration can begin."""
    times = lambda r: pliant.run(1, "--rigidity", str(r))[1]["times_ms"]
    order_and_factor = lambda: (lambda t: t["order"] + t["factorize"])(times(1))
    tasks = {
        "order + factor, r = 1": order_and_factor,
        "neighborhoods, r = 10": lambda: times(10)["neighborhoods"],
        "libigl": lambda: 1e3 * Libigl(scene).setup,
    }
    return in_turn(tasks)


def libigl_path(scene, most):
    """(iterations, seconds with set-up, energy) of libigl from rest, at iterations 5 % apart."""
    solver, done, path = Libigl(scene), 0, []
    seconds = solver.setup
    marks = sorted({min(most, max(k, int(1.05**k))) for k in range(1, 400)})
    for mark in marks:
        seconds += solver.iterate(mark - done)
        done = mark
        path.append((done, seconds, scene.energy(solver.now)))
    return path


def reached(path, goal):
    """Iterations and seconds of the first of a path's stations whose energy is at most the goal; no iterations, and the
    seconds of all, if there is none."""
    station = next((station for station in path if station[2] <= goal), None)
    return station[:2] if station else (None, path[-1][1])


def to_one_percent(scene, pliant, most):
    """Iterations and seconds from rest to within 1 % of the lowest energy that either reaches."""
    path = libigl_path(scene, most)
    _, report, positions = pliant.run(most, "--rigidity", "1")
    own = report["energies"]
    # Our own energies are in the units of the formula above up to one factor.
    unit = scene.energy(positions()) / own[-1]
    goal = 1.01 * min(path[-1][2], own[-1] * unit)
    theirs = reached(path, goal)
    ours = next((k for k, energy in enumerate(own, 1) if energy * unit <= goal), None)
    if ours is None:
        return theirs, (None, float("inf")), (path[-1][2], own[-1] * unit)
    stages = ("neighborhoods", "order", "factorize", "iterate")
    seconds = lambda: sum(pliant.run(ours, "--rigidity", "1")[1]["times_ms"][stage] for stage in stages) / 1e3
    return theirs, (ours, statistics.median(seconds() for _ in range(REPETITIONS))), (path[-1][2], own[-1] * unit)


def available():
    """The packages that load, and a line about each that does not."""
    found, notes = [], []
    for peer, package in ((Libigl, "igl"), (Open3D, "open3d")):
        try:
            __import__(package)
            found.append(peer)
        except Exception as error:  # A missing system library is no ImportError everywhere.
            notes.append(f"{peer.name} is left out: {error}".replace("\n", " "))
    return found, notes


def table(header, rows):
    """A Markdown table."""
    print("| " + " | ".join(header) + " |")
    print("|" + "|".join(["---"] + ["---:"] * (len(header) - 1)) + "|")
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print(flush=True)


def digits(value):
    """Three significant digits."""
    return f"{value:.{max(0, 2 - int(np.floor(np.log10(abs(value)))))}f}" if np.isfinite(value) and value else str(value)


def iteration_table(all_scenes, peers, program, folder):
    rows = []
    for scene in all_scenes:
        ms = iterations(scene, Pliant(program, scene, folder), peers)
        ours = ms["Pliant r = 1"]
        for name, value in ms.items():
            times = [digits(ms[peer.name] / value) for peer in peers]
            rows.append([f"{len(scene.points):,}", name, digits(value), digits(value / ours), *times])
    print("Milliseconds of an iteration, and how many of them the others' takes.\n")
    table(["vertices", "program", "ms", "/ Pliant r = 1", *(f"{p.name} / this" for p in peers)], rows)


def setup_table(all_scenes, program, folder):
    rows = []
    for scene in all_scenes:
        ms = setups(scene, Pliant(program, scene, folder))
        for name, value in ms.items():
            rows.append([f"{len(scene.points):,}", name, digits(value), digits(ms["libigl"] / value)])
    print("Milliseconds of set-up.\n")
    table(["vertices", "what", "ms", "libigl / this"], rows)


def goal_table(all_scenes, program, folder, most):
    rows = []
    for scene in all_scenes:
        theirs, ours, lowest = to_one_percent(scene, Pliant(program, scene, folder), most)
        n, more = f"{len(scene.points):,}", "" if theirs[0] else "> "
        steps = [str(done or f"> {most}") for done, _ in (theirs, ours)]
        rows.append([n, "libigl", digits(lowest[0]), steps[0], more + digits(theirs[1]), "1"])
        rows.append([n, "Pliant", digits(lowest[1]), steps[1], digits(ours[1]), more + digits(theirs[1] / ours[1])])
    print(f"From rest, set-up included, to within 1 % of the lowest energy that either reaches in {most} iterations.\n")
    table(["vertices", "program", "lowest E", "iterations", "s", "libigl / this"], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the pliant program")
    parser.add_argument("files", nargs="+", help="MESH.obj HANDLES.json, as often as wanted")
    parser.add_argument("--most-iterations", type=int, default=2000)
    given = parser.parse_args()
    peers, notes = available()
    for note in notes:
        print(note + "\n")
    if Libigl not in peers:
        return
    all_scenes = [Scene(*pair) for pair in zip(given.files[::2], given.files[1::2])]
    with tempfile.TemporaryDirectory() as folder:
        iteration_table(all_scenes, peers, given.program, folder)
        setup_table(all_scenes, given.program, folder)
        goal_table(all_scenes, given.program, folder, given.most_iterations)


main()
