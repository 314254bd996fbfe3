"""SR-ARAP of Pliant beside that of Open3D and of CGAL, run until none of them moves; prints a section in Markdown.

    pip install numpy scipy open3d
    apt install g++ libcgal-dev libeigen3-dev
    python tools/agreement target/release/pliant --page docs/methods.md

All are judged by one formula (`energy.py`): the least energy that their positions allow. Besides the project's own
samples there are two meshes that come with CGAL; `--mesh FILE.off` adds others, bent between their two ends.
A program that is not there is left out and named.
"""

import argparse
import os
import re
import sys
import tempfile
from pathlib import Path

try:
    from energy import Energy
    import programs
    import scenes
except ImportError as error:
    sys.exit(f"{error}: pip install numpy scipy")

# A program has settled when twice as many iterations lower its energy by no more than this part.
SETTLED = 1e-4
# Near enough to the end, as the table has it.
NEAR = 1.001


def down(program, scene, alpha, formula, folder, most):
    """Stations of a program as (iterations, seconds, energy), until it has settled."""
    path = []
    for iterations, seconds, points in program.stations(scene, program.factor * alpha, folder, most):
        path.append((iterations, seconds, formula.of(points)))
        print(f"  {program.name}: {iterations} iterations, {seconds:.2f} s, E = {path[-1][2]:.6g}", file=sys.stderr)
        is_twice = len(path) > 1 and iterations == 2 * path[-2][0]
        if is_twice and path[-2][2] - path[-1][2] <= SETTLED * path[-1][2]:
            break
    return path


def compare(scene, alpha, running, folder, most):
    """Rows of the table, and how far the energy that the first program tells is from the formula's."""
    formula, rows, first = Energy(scene.points, scene.faces, alpha), [], None
    print(f"{scene.name}, alpha = {alpha}, {formula.negative:.1%} of weights below 0", file=sys.stderr)
    for program in running:
        path = down(program, scene, alpha, formula, folder, most)
        last = path[-1][2]
        off = f"{100.0 * (last / first - 1.0):+.2f} %" if first else ""
        first = first or last
        near = next(station for station in path if station[2] <= NEAR * last)
        # Pliant tells every iteration's energy; of the others only the stations are known.
        upper = "" if isinstance(program, programs.Pliant) else "≤ "
        name = program.name if program.factor == 1.0 else f"{program.name}, its α = {program.factor * alpha:g}"
        mesh = [scene.name, f"{len(scene.points):,}", str(len(scene.held)), f"{alpha:g}"]
        rows.append([*mesh, name, f"{last:.5g}", off, str(path[-1][0]), f"{upper}{near[0]}", f"{near[1]:.3g}"])
    return rows, abs(running[0].told[-1] / first - 1.0)


def run(all_scenes, pliant, peers, folder, most):
    """After every scene: the table's rows so far, and the largest part by which Pliant's own energy is off."""
    rows, off = [], 0.0
    # What Pliant is at its default, and what CGAL is at its own.
    halved = [pliant[0], *(peer for peer in peers if peer.factor != 1.0)]
    for scene in all_scenes:
        for alpha, running in ((0.02, [*pliant, *peers]), (0.01, halved)):
            if alpha == 0.02 or len(running) > 1:
                more, own = compare(scene, alpha, running, folder, most)
                rows, off = rows + more, max(off, own)
        yield rows, off


MESHES = ["bar", "elephant", "gecko", "camel", "creature"]
HEADER = ["mesh", "vertices", "held", "α", "program", "E", "against Pliant", "iterations", "to 0.1 %", "s"]


def section(rows, off, peers, notes):
    """The text between the marks."""
    versions = " and ".join(f"{peer.name} {peer.version}" for peer in peers)
    lines = [f"Made by `python tools/agreement`, beside {versions or 'nobody'}. The energy that Pliant tells is the"]
    lines += [f"formula's to within {100.0 * max(off, 1e-6):.1g} %."]
    lines += [*notes, "", "| " + " | ".join(HEADER) + " |", "|" + "---|" + "---:|" * 3 + "---|" + "---:|" * 5]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


MARKS = re.compile(r"(<!-- agreement -->\n).*?(<!-- end of agreement -->)", re.S)


def put(page, text):
    """The page with the table between its two marks exchanged."""
    page.write_text(MARKS.sub(lambda marks: marks[1] + text + marks[2], page.read_text()))


def others(folder, eigen):
    """The programs to compare with that are here, and a line about each that is not."""
    found, notes = [], []
    for make in (programs.Open3D, lambda: programs.Cgal(folder, eigen)):
        try:
            found.append(make())
        except programs.Missing as missing:
            notes.append(f"Left out: {missing}")
    return found, notes


def wanted(given):
    """The scenes, one after the other."""
    for name in given.meshes:
        if name not in scenes.FROM_CGAL:
            yield scenes.sample(name)
        elif scene := scenes.from_cgal(name):
            yield scene
        else:
            print(f"{scenes.CGAL_DATA} is missing: apt install libcgal-dev", file=sys.stderr)
    for path in given.mesh:
        yield scenes.bent(path.stem, *scenes.read_off(path.read_text()))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=os.path.abspath, help="the pliant program")
    parser.add_argument("--meshes", nargs="*", default=MESHES, help="samples of the folder assets, elephant, camel")
    parser.add_argument("--mesh", type=Path, nargs="*", default=[], help="other meshes (OFF, triangles)")
    parser.add_argument("--most-iterations", type=int, default=6400)
    parser.add_argument("--eigen", help="where the headers of Eigen are")
    parser.add_argument("--page", type=Path, help="a page to put the table on, between its marks")
    given = parser.parse_args()
    if given.page and not MARKS.search(given.page.read_text()):
        sys.exit(f"{given.page} has no marks <!-- agreement --> and <!-- end of agreement -->")
    with tempfile.TemporaryDirectory() as folder:
        peers, notes = others(folder, given.eigen)
        pliant = [programs.Pliant(given.program, *how) for how in (("lbfgs", "auto"), ("local-global", "rest"))]
        text = ""
        for rows, off in run(wanted(given), pliant, peers, folder, given.most_iterations):
            text = section(rows, off, peers, notes)
            if given.page:
                put(given.page, text)
    if not given.page:
        print(text)


main()
