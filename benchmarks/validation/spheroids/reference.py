#!/usr/bin/env python3
"""Drag of spheres and spheroids by finite elements, on a mesh that fits the body:
reference.py [SHAPE...] [--size H] [--width W] [--reynolds NUMBER...]

Steady flow past one of a square array of bodies, W diameters of the sphere of the same volume apart, 6 as in
towed.yaml: the Navier-Stokes equations with quadratic velocities and linear pressures (Taylor and Hood) on a quarter of
the box, whose other sides are planes of symmetry, from a uniform stream six diameters before the body to an open end
nine behind it. The force is the reaction at the body. Prints the drag coefficient, with the area of the sphere of the
same volume, at Reynolds numbers of 10, 50 and 100, or those given, which must rise in steps small enough for Newton's
method. SHAPE: sphere, or prolate or oblate followed by _along or _across (all of them without any). H: size of the
elements at the body, in diameters. Needs DOLFIN and gmsh, on Debian the packages python3-dolfin and gmsh, and three
minutes a shape.
"""
import argparse
import math
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import numpy as np

BEFORE, BEHIND = 6.0, 9.0                            # diameters
REYNOLDS_NUMBERS = (10.0, 50.0, 100.0)
LONG, SHORT = 0.5 * 2.0 ** (1.0 / 3.0), 0.25 * 2.0 ** (1.0 / 3.0)    # half axes of the oblate spheroid
SHAPES = {
    "sphere": (0.5, 0.5, 0.5),
    "prolate_along": (2.0 ** (2.0 / 3.0) / 2.0, 2.0 ** (-1.0 / 3.0) / 2.0, 2.0 ** (-1.0 / 3.0) / 2.0),
    "prolate_across": (2.0 ** (-1.0 / 3.0) / 2.0, 2.0 ** (2.0 / 3.0) / 2.0, 2.0 ** (-1.0 / 3.0) / 2.0),
    "oblate_along": (SHORT, LONG, LONG),
    "oblate_across": (LONG, SHORT, LONG),
}

GEOMETRY = """
SetFactory("OpenCASCADE");
Sphere(1) = {{0, 0, 0, 1}};
Dilate {{ {{0, 0, 0}}, {{{a}, {b}, {c}}} }} {{ Volume{{1}}; }}
Box(2) = {{{start}, 0, 0, {length}, {half}, {half}}};
BooleanDifference(3) = {{ Volume{{2}}; Delete; }}{{ Volume{{1}}; Delete; }};
Physical Volume(1) = {{3}};
Field[1] = MathEval;
Field[1].F = "{size} + 0.14*max(0, sqrt((x/{a})^2 + (y/{b})^2 + (z/{c})^2) - 1)";
Field[2] = MathEval;
Field[2].F = "0.75";
Field[3] = Box;
Field[3].VIn = 0.16; Field[3].VOut = 0.75; Field[3].Thickness = 2;
Field[3].XMin = -0.8; Field[3].XMax = 3.5;
Field[3].YMin = 0; Field[3].YMax = 0.9;
Field[3].ZMin = 0; Field[3].ZMax = 0.9;
Field[4] = Min; Field[4].FieldsList = {{1, 2, 3}};
Background Field = 4;
Mesh.CharacteristicLengthExtendFromBoundary = 0;
Mesh.CharacteristicLengthFromPoints = 0;
Mesh.CharacteristicLengthFromCurvature = 0;
"""


def section(lines, name):
    """The rows of a section of a mesh file of gmsh, format 2, as lists of words."""
    start = lines.index(f"${name}")
    return [line.split() for line in lines[start + 2:start + 2 + int(lines[start + 1])]]


def mesh_around(half_axes, size, half_width):
    import dolfin
    a, b, c = half_axes
    with tempfile.TemporaryDirectory() as folder:
        geometry, mesh_file = Path(folder, "box.geo"), Path(folder, "box.msh")
        text = GEOMETRY.format(a=a, b=b, c=c, size=size, start=-BEFORE, length=BEFORE + BEHIND, half=half_width)
        geometry.write_text(text, encoding="utf-8")
        command = ["gmsh", "-3", "-format", "msh2", geometry, "-o", mesh_file]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        lines = mesh_file.read_text(encoding="utf-8").split("\n")
    points = np.array([[float(word) for word in row[1:4]] for row in section(lines, "Nodes")])
    corners = np.array([[int(word) - 1 for word in row[-4:]] for row in section(lines, "Elements") if row[1] == "4"])
    used, corners = np.unique(corners, return_inverse=True)
    corners = corners.reshape(-1, 4)
    mesh, editor = dolfin.Mesh(), dolfin.MeshEditor()
    begin = editor.open     # no file
    begin(mesh, "tetrahedron", 3, 3)
    editor.init_vertices(len(used))
    editor.init_cells(len(corners))
    for number, point in enumerate(points[used]):
        editor.add_vertex(number, point)
    for number, cell in enumerate(corners):
        editor.add_cell(number, cell)
    editor.close()
    return mesh


def drag_coefficients(half_axes, size, half_width, reynolds_numbers):
    """By Reynolds number; each flow begins with that of the one before."""
    import dolfin as fe
    fe.set_log_level(40)
    fe.parameters["form_compiler"]["quadrature_degree"] = 4
    mesh = mesh_around(half_axes, size, half_width)
    space = fe.FunctionSpace(mesh, fe.MixedElement([fe.VectorElement("P", mesh.ufl_cell(), 2),
                                                    fe.FiniteElement("P", mesh.ufl_cell(), 1)]))
    inlet = fe.CompiledSubDomain("on_boundary && x[0] < start + 1e-6", start=-BEFORE)
    body = fe.CompiledSubDomain("on_boundary && pow(x[0]/a, 2) + pow(x[1]/b, 2) + pow(x[2]/c, 2) < 1.004",
                                a=half_axes[0], b=half_axes[1], c=half_axes[2])
    conditions = [fe.DirichletBC(space.sub(0), fe.Constant((1.0, 0.0, 0.0)), inlet)]
    for axis in (1, 2):
        plane = fe.CompiledSubDomain(f"on_boundary && (x[{axis}] < 1e-6 || x[{axis}] > half - 1e-6)", half=half_width)
        conditions.append(fe.DirichletBC(space.sub(0).sub(axis), 0.0, plane))
    conditions.append(fe.DirichletBC(space.sub(0), fe.Constant((0.0, 0.0, 0.0)), body))
    state, viscosity = fe.Function(space), fe.Constant(1.0)
    velocity, pressure = fe.split(state)
    v, q = fe.TestFunctions(space)
    residual = (viscosity * fe.inner(fe.grad(velocity), fe.grad(v)) + fe.inner(fe.dot(fe.grad(velocity), velocity), v)
                - pressure * fe.div(v) - q * fe.div(velocity)) * fe.dx
    at_body = fe.Function(space)        # 1 along the stream at the body, 0 elsewhere
    fe.DirichletBC(space.sub(0).sub(0), 1.0, body).apply(at_body.vector())
    found = {}
    newton = {"linear_solver": "mumps", "relative_tolerance": 1e-6, "absolute_tolerance": 1e-7, "maximum_iterations": 12}
    for reynolds in reynolds_numbers:
        viscosity.assign(1.0 / reynolds)
        fe.solve(residual == 0, state, conditions, solver_parameters={"newton_solver": newton})
        force = -4.0 * fe.assemble(residual).inner(at_body.vector())      # of the four quarters
        found[reynolds] = force / (0.5 * math.pi / 4.0)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shapes", nargs="*", metavar="SHAPE", help=", ".join(SHAPES))
    parser.add_argument("--size", type=float, default=0.07, metavar="H")
    parser.add_argument("--width", type=float, default=6.0, metavar="W")
    parser.add_argument("--reynolds", type=float, nargs="+", default=REYNOLDS_NUMBERS, metavar="NUMBER")
    arguments = parser.parse_args()
    for shape in arguments.shapes or SHAPES:
        found = drag_coefficients(SHAPES[shape], arguments.size, 0.5 * arguments.width, arguments.reynolds)
        for reynolds, value in found.items():
            print(f"{shape},{reynolds:g},{value:.4f}", flush=True)


if __name__ == "__main__":
    main()
