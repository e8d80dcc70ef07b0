"""On one thread every verb gives the same bits each time: what it prints and every number and word that it writes."""
import os
import unittest

import h5py
import numpy as np

from support import BEAM, VERBS, ProgramTest
from toml_text import section, table, toml

# Values that differ from call to call: times of computing.
TIMES = {"wall_time", "seconds"}
STATIC = BEAM.replace("METHOD = 1", "LOAD = 2").replace("SOL 103", "SOL 101").replace(
    "ENDDATA", "FORCE,2,3,,1.,0.,-100.,10.\nENDDATA")
DRIVEN = BEAM.replace("SOL 103", "SOL {sol}").replace(
    "METHOD = 1", "METHOD = 1\nDLOAD = 4\n{case}\nSDAMPING = 6\nDISPLACEMENT = ALL").replace(
    "ENDDATA", "DAREA,3,3,2,1.\n{load},4,3,,,7\nTABLED1,7\n,0.,1.,1000.,1.,ENDT\n{card}\n"
    "TABDMP1,6,CRIT\n,0.,.02,1000.,.02,ENDT\nENDDATA")
SYSTEM = toml(
    table("body", "beam", file="body.h5"),
    table("hinge", "root", "revolute", parent="ground", child="beam", axis=[0.0, 0.0, 1.0], rate=1.0, stiffness=50.0,
          damping=2.0),
    table("force", "push", body="beam", node=3, force=[0.0, 1.0, 0.0], function="push"),
    table("function", "push", "sine", amplitude=0.1, frequency_hz=1.3),
    table("sensor", "tip", "deflection", body="beam", node=3),
    section("simulation", duration=0.5, output_step=0.01, integrator="{integrator}"),
    "{step}\n")
CAMPAIGN = toml(
    section("campaign", steps=["modes beam.bdf -o modes.h5"]),
    table("parameter", "E", file="beam.bdf", card="MAT1", id=1, field="E", values=[6e10, 7e10]),
    table("collect", "f", file="modes.h5", dataset="/modes/frequency_hz", take="first"))


def read_file(path):
    """The content, without times."""
    if not path.endswith(".h5"):
        with open(path, "rb") as f:
            return f.read()
    found = {}

    def put(name, item):
        for key, value in item.attrs.items():
            if key == "DIMENSION_LIST":  # places in memory: the scales that they lead to
                found[f"{name}@{key}"] = str([[f[scale].name for scale in scales] for scales in value])
                continue
            if key == "REFERENCE_LIST":
                found[f"{name}@{key}"] = str([f[entry[0]].name for entry in value])
                continue
            found[f"{name}@{key}"] = np.asarray(value).tobytes() if np.asarray(value).dtype.kind != "O" else str(value)
        if isinstance(item, h5py.Dataset) and not any(word in name for word in TIMES):
            value = np.asarray(item[()])
            found[name] = str(value.tolist()) if value.dtype.kind == "O" else (value.shape, value.tobytes())

    with h5py.File(path) as f:
        put("", f)
        f.visititems(put)
    return {key: value for key, value in found.items() if key.split("@")[-1] not in TIMES}


class ReproducibleTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("beam.bdf", BEAM)
        self.write("static.bdf", STATIC)
        self.write("buckling.bdf", STATIC.replace("SOL 101", "SOL 105").replace("-100.,10.", "0.,0.").replace(
            "1.,0.,0.,0.", "1.,-1.,0.,0."))
        self.write("frequency.bdf", DRIVEN.format(sol=111, case="FREQUENCY = 5", load="RLOAD1", card="FREQ1,5,1.,5.,20"))
        self.write("transient.bdf", DRIVEN.format(sol=112, case="TSTEP = 5", load="TLOAD1", card="TSTEP,5,50,.001,1"))
        self.write("body.toml", toml(
            section("body", name="beam", deck="beam.bdf", interface=[3]),
            section("body.modes", number=2)))
        for integrator, step in (("adams", ""), ("bdf", ""), ("rk", ""), ("rk4", "step = 0.001"),
                                 ("implicit", "step = 0.001")):
            self.write(integrator + ".toml", SYSTEM.format(integrator=integrator, step=step))
        self.write("rest.toml", SYSTEM.format(integrator="rk", step="").replace("rate = 1.0", "position = 0.2"))
        self.write("campaign.toml", CAMPAIGN)

    def look(self, folder):
        found = {}
        for where, _, names in os.walk(folder):
            for name in names:
                path = os.path.join(where, name)
                found[os.path.relpath(path, folder)] = read_file(path)
        return found

    def digest(self, folder, output, *arguments):
        """Twice, from the same files: what is printed, and what is written to `output`."""
        answers = []
        for _ in range(2):
            path = self.path(folder)
            if os.path.isdir(path):
                for name in os.listdir(path):
                    os.remove(os.path.join(path, name))
            os.makedirs(path, exist_ok=True)
            more = ["-o", f"{folder}/{output}"] if output else []
            done = self.bough(*arguments, *more)
            said = "\n".join(line for line in done.stdout.splitlines() if not line.startswith("completed at"))
            answers.append((said, self.look(path)))
        self.assertTrue(answers[0][0] or answers[0][1], arguments)
        self.assertEqual(answers[0], answers[1], " ".join(arguments))
        if output:
            os.replace(os.path.join(self.path(folder), output), self.path(output))

    def test_every_verb_gives_the_same_bits_twice(self):
        calls = [
            ("check.txt", "check", "beam.bdf"), ("modes.h5", "modes", "beam.bdf"),
            ("factors.h5", "modes", "buckling.bdf", "--buckling", "-n", "2"), ("static.h5", "static", "static.bdf"),
            ("frequency.h5", "frequency", "frequency.bdf"), ("transient.h5", "transient", "transient.bdf"),
            ("matrices.h5", "matrices", "beam.bdf"), ("body.h5", "reduce", "body.toml"),
            ("body.flx", "flx", "body.h5"), ("compared.h5", "compare", "body.h5", "body.h5"),
            *((integrator + ".h5", "run", integrator + ".toml") for integrator in
              ("adams", "bdf", "rk", "rk4", "implicit")),
            ("rest.h5", "equilibrium", "rest.toml"), ("linear.h5", "linearize", "adams.toml"),
            ("gains.h5", "response", "linear.h5"), ("selected.h5", "select", "body.h5", "-n", "1"),
            ("body.sid", "export", "body.h5", "--to", "sid"), ("body.flat", "export", "body.h5", "--to", "flat"), ("body.vtu", "export", "body.h5", "--to", "vtu"),
            ("run.csv", "export", "rk4.h5", "--to", "csv"), ("run.svg", "plot", "rk4.h5", "--sensor", "tip"),
            ("page.html", "report", "rk4.h5", "body.h5"), ("info.txt", "info", "body.h5"),
            ("other.bdf", "convert", "beam.bdf", "--units", "m-kg-s:mm-N-tonne"),
        ]
        for output, *arguments in calls:
            with self.subTest(arguments):
                self.digest("now", output, *arguments)
        # Not here: `integrals` below, `init` copies files, cli.edit and cli.studio have their own, `batch` and `split` below.
        left = set(VERBS) - {arguments[0] for _, *arguments in calls}
        self.assertEqual(left, {"integrals", "init", "edit", "batch", "studio", "split"})

    def test_a_campaign(self):
        answers = []
        for _ in range(2):
            self.bough("batch", "campaign.toml", "-j", "1", "--restart", "-o", "campaign")
            with open(self.path("campaign/outcomes.csv")) as f:
                heads, *rows = [line.rstrip("\n").split(",") for line in f if not line.startswith("#")]
            timed = [k for k, head in enumerate(heads) if "seconds" in head]
            answers.append([[x for k, x in enumerate(row) if k not in timed] for row in rows])
        self.assertEqual(answers[0], answers[1])

    def test_parts_of_a_deck(self):
        answers = []
        for _ in range(2):
            self.bough("split", "beam.bdf", "--parts", "2", "-o", "parts")
            answers.append(self.look(self.path("parts")))
        self.assertGreater(len(answers[0]), 5)
        self.assertEqual(answers[0], answers[1])

    def test_integrals_of_given_matrices(self):
        source = os.path.join(os.environ["BOUGH_SOURCE_DIR"], "data", "integrals")
        for name in os.listdir(source):
            with open(os.path.join(source, name)) as f:
                self.write(name, f.read())
        self.digest("now", "body.FLX", "integrals", "test.inp", "test.mat")


if __name__ == "__main__":
    unittest.main()
