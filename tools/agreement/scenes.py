"""Meshes and where their held vertices go."""

import json
import struct
import tarfile
from pathlib import Path

import numpy as np

SAMPLES = Path(__file__).resolve().parents[2] / "assets"
# Meshes from scans and modelers that come with the headers of CGAL.
CGAL_DATA = Path("/usr/share/doc/libcgal-dev/data.tar.gz")
FROM_CGAL = ("elephant", "camel")


class Scene:
    """A mesh, its held vertices and their targets."""

    def __init__(self, name, points, faces, held, targets):
        self.name, self.points, self.faces = name, points, faces
        self.held, self.targets = np.array(held, dtype=np.int32), np.array(targets)

    def write(self, folder):
        """Paths of an OBJ file and one of handles, with all digits."""
        mesh, handles = Path(folder) / "mesh.obj", Path(folder) / "handles.json"
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in self.points.tolist()]
        lines += [f"f {a} {b} {c}" for a, b, c in (self.faces + 1).tolist()]
        mesh.write_text("\n".join(lines) + "\n")
        moved = [{"vertex": v, "to": to} for v, to in zip(self.held.tolist(), self.targets.tolist())]
        handles.write_text(json.dumps({"moved": moved}))
        return mesh, handles


def sample(name):
    """One of the project's own."""
    points, faces = read_glb(SAMPLES / f"{name}.glb")
    wish = json.loads((SAMPLES / f"{name}.handles.json").read_text())
    held = list(wish.get("fixed", []))
    targets = [points[held]] if held else []
    for moved in wish.get("moved", []):
        held.append(moved["vertex"])
        targets.append([moved["to"]])
    for group in wish.get("groups", []):
        matrix = np.array(group["matrix"]).reshape(4, 4).T
        held += group["vertices"]
        targets.append(points[group["vertices"]] @ matrix[:3, :3].T + matrix[:3, 3])
    return Scene(name, points, faces, held, np.concatenate(targets))


def bent(name, points, faces, degrees=60.0):
    """Any mesh: along its longest side the first tenth stays, and the last tenth turns about the middle."""
    used = np.zeros(len(points), dtype=bool)
    used[faces] = True
    size = points[used].max(0) - points[used].min(0)
    along, about = np.argsort(size)[[2, 0]]
    way = (points[:, along] - points[used][:, along].min()) / size[along]
    first, last = np.flatnonzero(used & (way < 0.1)), np.flatnonzero(used & (way > 0.9))
    middle, angle = 0.5 * (points[used].max(0) + points[used].min(0)), np.radians(degrees)
    a, b = (about + 1) % 3, (about + 2) % 3
    turn = np.eye(3)
    turn[a, a] = turn[b, b] = np.cos(angle)
    turn[a, b], turn[b, a] = -np.sin(angle), np.sin(angle)
    targets = np.concatenate([points[first], (points[last] - middle) @ turn.T + middle])
    return Scene(name, points, faces, np.concatenate([first, last]), targets)


def read_glb(path):
    """Positions and triangles of a file of one mesh and one primitive."""
    data = path.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    told, binary = json.loads(data[20 : 20 + length]), data[28 + length :]

    def numbers(accessor):
        accessor = told["accessors"][accessor]
        view = told["bufferViews"][accessor["bufferView"]]
        kind = {5123: np.uint16, 5125: np.uint32, 5126: np.float32}[accessor["componentType"]]
        at = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        count = accessor["count"] * {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
        return np.frombuffer(binary, kind, count, at).reshape(-1, 3)

    (primitive,) = told["meshes"][0]["primitives"]
    return numbers(primitive["attributes"]["POSITION"]).astype(float), numbers(primitive["indices"]).astype(np.int64)


def read_off(text):
    """Positions and triangles of an OFF file."""
    lines = (line.split("#")[0].split() for line in text.splitlines())
    lines = [line for line in lines if line]
    if lines[0][0] not in ("OFF", "COFF"):
        raise ValueError("the file does not begin with OFF")
    n, m = int(lines[1][0]), int(lines[1][1])
    faces = [line[:4] for line in lines[2 + n : 2 + n + m]]
    if any(face[0] != "3" for face in faces):
        raise ValueError("the file has faces that are no triangles")
    points = np.array([line[:3] for line in lines[2 : 2 + n]], dtype=float)
    return points, np.array([face[1:] for face in faces], dtype=np.int64)


def from_cgal(name):
    """A mesh that comes with CGAL, or none."""
    if not CGAL_DATA.is_file():
        return None
    with tarfile.open(CGAL_DATA) as data:
        file = data.extractfile(f"data/meshes/{name}.off")
        return bent(name, *read_off(file.read().decode()))
