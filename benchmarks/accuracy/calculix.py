"""Runs CalculiX on a case that export_to_calculix wrote, and reads its displacements (mm)."""

import json
import math
import pathlib
import shutil
import subprocess

# By itself CalculiX is content with a residual of 0.5 % of the mean force; too coarse here.
CONTROLS = ["*CONTROLS, PARAMETERS=FIELD", "1e-6,1e-4"]


class NotInstalled(Exception):
    pass


class CalculixError(Exception):
    pass


def find_calculix():
    program = shutil.which("ccx")
    if program is None:
        raise NotInstalled("ccx (CalculiX) is not installed: apt-get install calculix-ccx")
    return program


def version(program):
    answer = subprocess.run([program, "-v"], capture_output=True, text=True).stdout
    return answer.strip().removeprefix("This is ")


def mean(at, field):
    """Weighted mean of a nodal field: where a point of the body is, or moves to."""
    return [
        sum(weight * field[node - 1][axis] for node, weight in zip(at["nodes"], at["weights"]))
        for axis in range(3)
    ]


def fixed_cards(node):
    return ["*BOUNDARY", f"{node},1,3"]


def tie_cards(node, at):
    """The node moves like the weighted mean of others."""
    cards = []
    for axis in (1, 2, 3):
        terms = [f"{node},{axis},-1."]
        terms += [f"{n},{axis},{weight:.12g}" for n, weight in zip(at["nodes"], at["weights"])]
        cards += ["*EQUATION", str(len(terms)), *terms]
    return cards


class Case:
    """A folder with model.inp and case.json."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        record = json.loads((self.folder / "case.json").read_text())
        self.linear = record["linear"]
        self.cells = record["cells"]
        self.rest = record["rest"]
        self.softforce = record["displacement"]  # per node
        self.forces = record["forces"]
        self.cables = record["cables"]
        self.mesh = record["mesh"]
        self.loaded = record["loaded"]  # places, in the order of the loads
        self.markers = record["markers"]

    def path(self, cable, displacement):
        """Places (mm) that a cable runs through: its points on the body, then the guide.
        Without displacement: of the body at rest."""
        places = [mean(point, self.rest) for point in cable["points"]]
        if displacement is not None:
            moves = [mean(point, displacement) for point in cable["points"]]
            places = [[x + u for x, u in zip(*pair)] for pair in zip(places, moves)]
        return places + [cable["guide"]]

    def length(self, cable, displacement):
        places = self.path(cable, displacement)
        return sum(math.dist(a, b) for a, b in zip(places, places[1:]))

    def shortening(self, cable, displacement):
        return self.length(cable, None) - self.length(cable, displacement)

    def tight_cables(self):
        return [] if self.linear else [cable for cable in self.cables if cable["tension"] > 0]

    def cable_cards(self):
        """CalculiX has no cables, but springs whose force is the same at any length are just that:
        their directions follow the deformation. One for each straight piece; its ends are nodes of
        their own, tied to the mean of the patch on the body, or fixed at the guide."""
        cards = []
        node, element = len(self.rest), self.cells
        for cable in self.tight_cables():
            pull = f"{cable['tension']:.12e}"  # with a point: 2 alone would be read as an axis
            ends = []
            for place, at in zip(self.path(cable, None), cable["points"] + [None]):
                node += 1
                ends.append(node)
                cards += ["*NODE", f"{node},{place[0]:.12g},{place[1]:.12g},{place[2]:.12g}"]
                cards += fixed_cards(node) if at is None else tie_cards(node, at)
            for start, end in zip(ends, ends[1:]):
                element += 1
                cards += [f"*ELEMENT, TYPE=SPRINGA, ELSET=CABLE{element}"]
                cards += [f"{element},{start},{end}"]
                cards += [f"*SPRING, NONLINEAR, ELSET=CABLE{element}", ""]
                # Force, N; elongation, mm; temperature: slack at 0, tight at 1.
                cards += ["0.,-1000.,0.", "0.,1000.,0.", f"{pull},-1000.,1.", f"{pull},1000.,1."]
        if cards:
            cards += ["*NSET, NSET=CABLES", *(f"{n}," for n in range(len(self.rest) + 1, node + 1))]
            cards += ["*INITIAL CONDITIONS, TYPE=TEMPERATURE", "ALL,0.", "CABLES,0."]
        return cards

    def step_cards(self):
        cards = ["*STEP", "*STATIC"]
        if not self.linear:
            cards = ["*STEP, NLGEOM, INC=200", *CONTROLS, "*STATIC", "0.25,1."]
        if self.tight_cables():
            cards += ["*TEMPERATURE", "CABLES,1."]  # reached at the step's end, like all loads
        cards.append("*CLOAD")
        for node, force in enumerate(self.forces, start=1):
            cards += [f"{node},{axis},{f:.12g}" for axis, f in enumerate(force, start=1) if f != 0]
        return cards + ["*NODE PRINT, NSET=ALL, FREQUENCY=10000", "U", "*END STEP", ""]

    def solve_with_calculix(self, program):
        """Displacement of every node."""
        deck = ["*INCLUDE, INPUT=model.inp", *self.cable_cards(), *self.step_cards()]
        (self.folder / "run.inp").write_text("\n".join(deck))
        (self.folder / "run.dat").unlink(missing_ok=True)
        command = [program, "-i", "run"]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
        (self.folder / "run.log").write_text(done.stdout + done.stderr)
        if done.returncode != 0 or "Job finished" not in done.stdout:
            last = " / ".join(done.stdout.split("\n")[-20:])
            raise CalculixError(f"CalculiX failed in {self.folder} (--keep to keep it): {last}")
        return self.read_displacement()

    def read_displacement(self):
        """The last table of displacements in run.dat: rows of node, ux, uy, uz."""
        text = (self.folder / "run.dat").read_text()
        last = text.split("displacements")[-1]
        displacement = [[0.0] * 3 for _ in self.rest]
        for line in last.splitlines()[1:]:
            cells = line.split()
            if len(cells) == 4:
                displacement[int(cells[0]) - 1] = [float(cell) for cell in cells[1:]]
        return displacement
