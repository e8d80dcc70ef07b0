"""Dependencies listed by exported FMUs: complete by differences of every pair, and sparse."""
import os
import re
import unittest

import h5py
import numpy as np

from embed_test import ARM
from fmu_case import CHAIN, DRIVEN, SLIDE, FmuCase, with_integrator


class FmuDependenciesTest(FmuCase):
    def list_channels(self, system):
        """--channel for all that the results of a system contain."""
        with open(self.path(system), encoding="utf-8") as f:
            text = re.sub(r"^output_(from|until) .*\n", "", f.read(), flags=re.MULTILINE)
        text = with_integrator(text, 'integrator = "rk4"\nstep = 1e-5\n', 2e-5, 1e-5)
        self.bough("run", self.write(os.path.join(os.path.dirname(system), "short.toml"), text), "-o", "channels.h5")
        paths = []
        with h5py.File(self.path("channels.h5")) as f:
            f.visititems(lambda name, item: paths.append("/" + name) if isinstance(item, h5py.Dataset) else None)
        groups = ("/sensors/", "/controllers/", "/actuators/", "/hinges/", "/bodies/", "/energy/", "/momentum/", "/forces/")
        return [word for path in paths if path.startswith(groups) for word in ("--channel", path)]

    def check_dependencies(self, fmu):
        """No known with an effect is missing. Returns the share of pairs that are not listed."""
        instance, x, random = self.start_me(fmu)
        unknowns = fmu.list("output") + fmu.derivatives
        inputs = {name: value for name, value in zip(fmu.list("input"), instance.get(fmu.list("input")) + random.standard_normal())}
        knowns = fmu.states + list(inputs)
        missing, total = 0, 0
        for j, known in enumerate(knowns):
            direction = np.zeros(len(knowns))
            direction[j] = 1
            h = 1e-4
            change, size = self.difference(instance, float(fmu.root.find("DefaultExperiment").get("startTime")), x, unknowns, direction[:len(x)], inputs, direction[len(x):], h)
            for unknown, value, large in zip(unknowns, change, size):
                listed = fmu.dependencies[unknown]
                total += 1
                if listed is not None and known not in listed:
                    missing += 1
                    self.assertLess(abs(value) * h, 1e-12 * max(1, large), f"d({unknown})/d({known})")
        return missing / max(1, total)

    def test_dependencies_contain_all_that_has_an_effect(self):
        self.write("arm.toml", ARM)
        self.write("slide.toml", SLIDE)
        self.write("chain.toml", CHAIN)
        self.write("driven.toml", DRIVEN)
        sparse = {}
        for system in ["arm.toml", "slide.toml", "chain.toml", "driven.toml", *self.prepare_examples()]:
            with self.subTest(system=system):
                for version in (3,) if system.startswith("ex") else (2, 3):
                    sparse[system] = self.check_dependencies(self.export(system, version, *self.list_channels(system)))
        self.assertGreater(min(sparse.values()), 0.2, sparse)

    def test_dependencies_are_sparse(self):
        self.write("slide.toml", SLIDE)
        self.write("chain.toml", CHAIN)
        for version in (2, 3):
            time = {"time"} if version == 3 else set()
            fmu = self.export("slide.toml", version, "--channel", "x:x", "--channel", "/energy/work")
            q, u, work, _ = fmu.states
            self.assertEqual(fmu.dependencies["x:x"], {q} | time)
            self.assertEqual(fmu.dependencies["/energy/work"], {work})
            self.assertEqual(fmu.dependencies["der(" + q + ")"], {q, u})
            self.assertEqual(fmu.dependencies["der(" + u + ")"], {q, u, "push"} | time)
            fmu = self.export("chain.toml", version)
            q1, q2, u1, u2 = fmu.states[:4]
            lag, slow = "sensor 'slow' (state 1)", "controller 'lag' (state 1)"
            self.assertEqual(fmu.dependencies["upper"], {q1} | time)  # the position of the first joint
            self.assertEqual(fmu.dependencies["rate"], {q2, u2} | time)
            self.assertEqual(fmu.dependencies["slow"], {lag} | time)
            self.assertEqual(fmu.dependencies["shake:x"], {q1, q2, u1, u2, slow, "torque"} | time)  # an acceleration
            self.assertEqual(fmu.dependencies["der(" + lag + ")"], {lag, q2} | time)
            self.assertEqual(fmu.dependencies["der(" + slow + ")"], {slow, q1, "target"} | time)
            self.assertEqual(fmu.dependencies["tip:x"], {q1, q2} | time)

    def test_dependencies_of_every_kind_of_block(self):
        self.write("driven.toml", DRIVEN)
        fmu = self.export("driven.toml", 3, *(word for name in (
            "spin", "held", "attitude", "seen", "far", "felt", "push", "/controllers/held_law", "/controllers/late", "/controllers/slow",
            "/controllers/turns", "/controllers/mixed", "/actuators/wheel", "/actuators/motor") for word in ("--channel", name)))
        inputs = {name: {i for i in of or () if i in fmu.list("input")} for name, of in fmu.dependencies.items()}
        loads = {"i3", "i4", "i7", "i9"}  # what accelerates at once: neither sampled, switched nor behind a lag
        rate = next(name for name in fmu.derivatives if "hinge rate" in name)
        expected = {"spin:x": set(), "held:x": set(), "attitude:w": set(), "seen:x": set(), "far": set(), "push:x": set(),
                    "/controllers/held_law": set(), "/controllers/turns": set(), "/controllers/slow": set(), "/controllers/mixed": {"i3"},
                    "/controllers/late": loads, "felt:x": loads, rate: loads, "/actuators/wheel:1": {"i4"},
                    "/actuators/motor:1": set(), "der(controller 'slow' (state 1))": loads}
        self.assertEqual({name: inputs[name] for name in expected}, expected)
        for name in fmu.list("output") + fmu.derivatives:
            self.assertFalse(inputs[name] & {"i1", "i2", "i8", "i10"}, name)  # sampled, switched, unused
        self.assertEqual({name: inputs[name] for name in fmu.indicators if inputs[name]},
                         {"controller 'turns': switch 1": {"i2"}, "controller 'turns': switch 2": {"i2"}, "actuator 'jet': switch": {"i8"},
                          **{f"actuator 'wheel': switch {i}": {"i4"} for i in (1, 2, 3)}})
        self.assertEqual(inputs["event 'near'"], set())


if __name__ == "__main__":
    unittest.main()
