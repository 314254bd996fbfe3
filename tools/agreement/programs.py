"""The programs that are compared. Each yields stations of its way down: iterations, seconds with set-up, positions."""

import json
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

# The headers of Eigen, which CGAL needs, where packages put them.
EIGEN = [Path("/usr/include/eigen3"), Path("/usr/local/include/eigen3")]


class Missing(Exception):
    """Something has to be installed; the text says what."""


class Pliant:
    """The command line, by one of its two ways to minimize."""

    # By when either has settled on all of these meshes.
    ITERATIONS = {"lbfgs": 400, "local-global": 1000}
    factor = 1.0

    def __init__(self, program, solver, start):
        self.program, self.solver, self.start = program, solver, start
        self.name = f"Pliant, {solver} from {start}"
        # Energies as the program tells them, to be held against the formula: one for every scene.
        self.told = []

    def run(self, scene, alpha, iterations, folder):
        """The report, and the positions."""
        mesh, handles = scene.write(folder)
        out, report = Path(folder) / "out.obj", Path(folder) / "report.json"
        command = [self.program, "deform", mesh, "--handles", handles, "-o", out, "--report", report, "--quiet"]
        command += ["--method", "sr-arap", "--alpha", str(alpha), "--solver", self.solver, "--start", self.start]
        command += ["--weld", "never", "--tolerance", "0", "--max-iterations", str(iterations)]
        subprocess.run([str(part) for part in command], check=True)
        rows = (line.split() for line in out.read_text().splitlines() if line.startswith("v "))
        return json.loads(report.read_text()), np.array([row[1:4] for row in rows], dtype=float)

    def stations(self, scene, alpha, folder, most):
        """The last one, and before it the first that is within a thousandth of its energy as the program tells it."""
        most = min(most, self.ITERATIONS[self.solver])
        report, last = self.run(scene, alpha, most, folder)
        energies = report["energies"]
        self.told.append(energies[-1])
        near = next(k for k, energy in enumerate(energies, 1) if energy <= 1.001 * energies[-1])
        shorter, points = self.run(scene, alpha, near, folder)
        yield near, seconds(shorter), points
        yield len(energies), seconds(report), last


def seconds(report):
    times = report["times_ms"]
    return sum(times[stage] for stage in ("neighborhoods", "order", "factorize", "iterate")) / 1e3


class Open3D:
    """Its `Smoothed` energy. It sets up anew with every call and always begins at rest."""

    name = "Open3D"
    # Its alpha for the alpha of the formula, see docs/methods.md.
    factor = 1.0

    def __init__(self):
        try:
            import open3d
        except Exception as error:  # A missing system library is no ImportError everywhere.
            raise Missing(f"Open3D: pip install open3d ({error})") from error
        self.o3d, self.version = open3d, open3d.__version__

    def stations(self, scene, alpha, _folder, most):
        vector = self.o3d.utility
        points, faces = vector.Vector3dVector(scene.points), vector.Vector3iVector(scene.faces)
        mesh = self.o3d.geometry.TriangleMesh(points, faces)
        held, targets = vector.IntVector(scene.held), vector.Vector3dVector(scene.targets)
        kind = self.o3d.geometry.DeformAsRigidAsPossibleEnergy.Smoothed
        for until in marks(most):
            begun = time.perf_counter()
            bent = mesh.deform_as_rigid_as_possible(held, targets, until, energy=kind, smoothed_alpha=alpha)
            yield until, time.perf_counter() - begun, np.asarray(bent.vertices)


class Cgal:
    """`Surface_mesh_deformation` with `SRE_ARAP`, by a small program that is compiled here."""

    name = "CGAL"
    factor = 2.0

    def __init__(self, folder, eigen=None):
        folders = [Path(eigen)] if eigen else [*EIGEN, Path(sys.prefix) / "include", *map(Path, sys.path)]
        eigen = next((folder for folder in folders if (folder / "Eigen" / "Sparse").is_file()), None)
        eigen = eigen or next((f / "include" for f in folders if (f / "include" / "Eigen" / "Sparse").is_file()), None)
        compiler = shutil.which("c++") or shutil.which("g++")
        if not (compiler and eigen):
            raise Missing("CGAL: apt install g++ libcgal-dev libeigen3-dev (--eigen FOLDER where Eigen is elsewhere)")
        self.program = Path(folder) / "sr_arap"
        command = [compiler, "-std=c++17", "-O2", "-DNDEBUG", "-DCGAL_EIGEN3_ENABLED", f"-I{eigen}"]
        source = Path(__file__).with_name("sr_arap.cpp")
        made = subprocess.run([*command, source, "-o", self.program], capture_output=True, text=True)
        if made.returncode:
            raise Missing(f"CGAL: apt install libcgal-dev ({made.stderr.splitlines()[0]})")
        self.version = subprocess.run([self.program, "--version"], capture_output=True, text=True).stdout.strip()

    def stations(self, scene, alpha, _folder, most):
        n = len(scene.points)
        row = lambda numbers: " ".join(map(repr, numbers)) + "\n"
        text = [row([n, len(scene.faces), len(scene.held)])]
        text += map(row, scene.points.tolist() + scene.faces.tolist())
        text += [row([v, *to]) for v, to in zip(scene.held.tolist(), scene.targets.tolist())]
        with subprocess.Popen(self.program, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as running:
            running.stdin.write("".join(text) + f"{alpha!r}\n")
            try:
                for until in marks(most):
                    running.stdin.write(f"{until}\n")
                    running.stdin.flush()
                    taken = running.stdout.readline()
                    if not taken:
                        raise RuntimeError(f"CGAL does not take {scene.name}")
                    rows = [running.stdout.readline().split() for _ in range(n)]
                    yield until, float(taken), np.array(rows, dtype=float)
            finally:
                running.kill()


def marks(most):
    """Twice as many iterations every time."""
    until = 25
    while until < most:
        yield until
        until *= 2
    yield most
