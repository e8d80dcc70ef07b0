"""Values, files and outputs that a function of Python rejects, with the ids of the command line."""
import math
import os
import shutil
import unittest

import numpy as np

import bough
from module_test import EXAMPLES, EXPRESSION, LIBRARY, PENDULUM, InFolder

NAN, INF = math.nan, math.inf


class Refusals(InFolder):
    def setUp(self):
        super().setUp()
        for name in ("boom.bdf", "boom.toml", "spinup.toml"):
            shutil.copy(os.path.join(EXAMPLES, "ex01-spinup", name), self.folder)

    def rejects(self, error, call, *words, **options):
        with self.subTest(call=getattr(call, "__name__", str(call)), words=words, options=options):
            with self.assertRaises(bough.InputError) as caught:
                call(*words, **options)
            self.assertIn(error, [message.id for message in caught.exception.messages])
            return str(caught.exception)

    def keeps(self, file, call, *words, **options):
        """The call is rejected, and the file is as before."""
        with open(file, "rb") as f:
            before = f.read()
        self.rejects("cli.output-is-input", call, *words, **options)
        with open(file, "rb") as f:
            self.assertEqual(f.read(), before, file)

    def make_run(self):
        bough.reduce("boom.toml").save("boom.h5")
        bough.run("spinup.toml", "run.h5")


class Values(Refusals):
    def test_numbers_of_files(self):
        bough.reduce("boom.toml").save("boom.h5")
        for files, refinement in (([], False), (["boom.h5"] * 3, False), (["boom.h5"] * 2, True),
                                  (["boom.h5"] * 4, True)):
            self.rejects("cli.bad-option", bough.compare, *files, refinement=refinement)
        self.rejects("cli.bad-option", bough.report, [])
        self.rejects("cli.bad-option", bough.plot, [], "tip_deflection")
        self.rejects("cli.body-ids", bough.flx, [])

    def test_plot_and_export(self):
        self.make_run()
        text = self.rejects("cli.bad-option", bough.plot, "run.h5", "tip_deflection", srs="x")
        self.assertIn("pseudo-velocity", text)
        self.rejects("cli.bad-option", bough.plot, "run.h5", kind="x")
        self.rejects("cli.plot-option", bough.plot, "run.h5", "tip_deflection:y", psd=True, spectrum=True)
        for every in (0, -1):
            self.rejects("cli.bad-range", bough.export, "run.h5", "gltf", every=every)
        for window in ([0, 1, 2], [0], [1, 0], [NAN, 1]):
            self.rejects("cli.bad-range", bough.export, "run.h5", "gltf", window=window)
        self.rejects("cli.bad-range", bough.export, "run.h5", "gltf", scale=NAN)
        self.rejects("cli.bad-option", bough.export, "boom.bdf", "bdf", fields="x")
        self.rejects("cli.bad-option", bough.export, "spinup.toml", "fmu", "x.fmu", fmi=5)
        self.rejects("cli.bad-range", bough.export, "boom.h5", "extseout", "x", id=-1)

    def test_bodies(self):
        bough.reduce("boom.toml").save("boom.h5")
        for digits in (0, 1, 18):
            self.rejects("cli.bad-range", bough.flx, "boom.h5", digits=digits)
        for modopt in (-1, 3):
            self.rejects("cli.bad-range", bough.flx, "boom.h5", modopt=modopt)
        self.rejects("cli.bad-option", bough.flx, "boom.h5", integrals="x")
        self.rejects("cli.bad-range", bough.flx, "boom.h5", body_ids=0)
        for damping in (NAN, -0.1, INF):
            self.rejects("cli.bad-range", bough.reduce, "boom.toml", damping=damping)
        self.rejects("cli.bad-range", bough.reduce, "boom.toml", origin=[0, NAN, 0])
        self.rejects("cli.bad-range", bough.reduce, "boom.toml", max_hz=INF)
        self.rejects("cli.bad-option", bough.reduce, "boom.toml", integrals="x")
        with self.assertRaises(ValueError):
            bough.reduce("boom.toml", max_hz=NAN)
        for options in ({"number": -1}, {"tolerance": -0.1}, {"tolerance": NAN}, {"below": NAN}, {"below": -1},
                        {"damping": 0}, {"damping": NAN}):
            self.rejects("cli.bad-range", bough.select, "boom.h5", **options)

    def test_solutions(self):
        for increments in (0, -1):
            self.rejects("cli.bad-range", bough.static, "boom.bdf", increments=increments)
        for name in ("min_hz", "max_hz"):
            self.rejects("cli.bad-range", bough.modes, "boom.bdf", 2, **{name: NAN})
        system = bough.System.from_text(PENDULUM.format(law=EXPRESSION))
        system.linearize().save("linear.h5")
        for options in ({"points": -1}, {"points": 10**6}, {"from_hz": -1}, {"from_hz": NAN}, {"to_hz": INF},
                        {"to_hz": -1}):
            self.rejects("cli.bad-range", bough.response, "linear.h5", **options)
        self.assertGreater(len(bough.response("linear.h5", points=0)["frequency_hz"]), 10)  # 0: as many as usual
        for at in (NAN, INF):
            self.rejects("cli.bad-range", system.linearize, at=at)

    def test_batch(self):
        shutil.copytree(os.path.join(EXAMPLES, "ex06-campaign"), "study")
        for options in ({"jobs": -1}, {"time_limit": -1}, {"time_limit": NAN}):
            self.rejects("cli.bad-range", bough.batch, "study/campaign.toml", "cases", **options)

    def test_bodies_that_no_body_names(self):
        body = bough.reduce("boom.toml")
        text = self.rejects("cli.bad-option", bough.System, "spinup.toml", bodies={"bom.h5": body, "boom.h5": body})
        self.assertRegex(text, "the files are .*boom.h5")
        self.assertTrue(bough.System("spinup.toml", bodies={"./boom.h5": body}).bodies)
        self.rejects("cli.bad-option", bough.System.from_text, PENDULUM.format(law=EXPRESSION), bodies={"x.h5": body})


class Outputs(Refusals):
    def test_functions(self):
        self.make_run()
        self.keeps("run.h5", bough.export, "run.h5", "csv", "run.h5")
        self.keeps("boom.bdf", bough.export, "boom.bdf", "bdf", "boom.bdf")
        self.keeps("boom.h5", bough.export, "boom.h5", "mat", "boom.h5")
        self.keeps("boom.h5", bough.flx, "boom.h5", "boom.h5")
        self.keeps("run.h5", bough.report, "run.h5", "run.h5")
        self.keeps("run.h5", bough.plot, "run.h5", "tip_deflection", output="run.h5")
        os.symlink("run.h5", "link.h5")
        self.keeps("run.h5", bough.report, "run.h5", "link.h5")
        bough.report("run.h5", "page.html")
        bough.report("run.h5", "page.html")  # its own output of an earlier call is no input

    def test_systems_and_records(self):
        self.make_run()
        system = bough.System("spinup.toml")
        self.keeps("boom.h5", system.run, "boom.h5")
        self.keeps("spinup.toml", system.run, "spinup.toml")
        model = system.linearize(open=True)
        self.keeps("spinup.toml", model.save, "spinup.toml")
        self.keeps("boom.h5", model.save, "boom.h5")
        body = bough.reduce("boom.toml")
        self.keeps("boom.bdf", body.save, "boom.bdf")
        self.keeps("boom.toml", body.save, "boom.toml")
        for _ in range(2):
            body.save("boom.h5")
            model.save("linear.h5")
            system.run("out.h5")
        bough.read_flex_body("boom.h5").save("boom.h5")


class Interrupts(InFolder):
    def test_come_out_as_themselves(self):
        class Exit(BaseException):
            pass

        for kind in (KeyboardInterrupt, SystemExit, Exit):
            def control(t, u):
                if t > 0.2:
                    raise kind("now")
                return 0.0

            text = PENDULUM.format(law=LIBRARY)
            system = bough.System.from_text(text, controllers=dict(law=control))
            with self.assertRaises(kind) as caught:
                system.run()
            self.assertEqual(caught.exception.args, ("now",))
            with self.assertRaises(kind):
                bough.Simulation(system).advance_to(1.0)
        with self.assertRaisesRegex(bough.InputError, "none.toml"):  # the next failure is its own
            bough.System("none.toml")

        def fails(t, u):
            raise ValueError("no")

        with self.assertRaisesRegex(bough.ComputationError, "no"):
            bough.System.from_text(text, controllers=dict(law=fails)).run()


class Uncertain(InFolder):
    def test_is_of_the_system_that_was_loaded(self):
        text = "[parameters]\nk = 40.0\n" + PENDULUM.format(
            law='type = "pid"\ninputs = ["angle"]\nkp = "$k"').replace("gravity = [0.0, 0.0, -9.81]", "")
        self.write("arm.toml", text)
        system = bough.System("arm.toml")
        expected = system.linearize(uncertain={"k": (30, 50)}).A
        self.write("arm.toml", text.replace("mass = 2.0", "mass = 4.0"))
        np.testing.assert_array_equal(system.linearize(uncertain={"k": (30, 50)}).A, expected)
        os.remove("arm.toml")
        with self.assertRaises(bough.InputError):
            bough.System("arm.toml")


class Words(Refusals):
    def test_one_alone_and_arrays(self):
        bough.reduce("boom.toml").save("boom.h5")
        node = bough.read_flex_body("boom.h5").interface_nodes[-1]
        expected = bough.reduce("boom.bdf", modes=2, interface=[node], origin=[0.1, 0.0, 0.0])
        for interface in (node, np.array([node]), np.int64(node)):
            body = bough.reduce("boom.bdf", modes=2, interface=interface, origin=np.array([0.1, 0.0, 0.0]))
            np.testing.assert_array_equal(body.modal_stiffness, expected.modal_stiffness)
            self.assertEqual(body.interface_nodes, expected.interface_nodes)
        system = bough.System.from_text(PENDULUM.format(law=EXPRESSION))
        one = system.linearize(inputs="motor", outputs="rate", open=True)
        self.assertEqual((one.B.shape[1], one.C.shape[0]), (1, 1))

    def test_paths(self):
        from pathlib import Path
        body = bough.reduce(Path("boom.toml"))
        body.save(Path("boom.h5"))
        self.assertEqual(bough.read_flex_body(Path("boom.h5")).num_modes, body.num_modes)
        system = bough.System("spinup.toml", bodies={Path("boom.h5"): body})
        system.linearize(open=True).save(Path("linear.h5"))
        self.assertGreater(bough.read_linear_model(Path("linear.h5")).A.size, 0)
        self.assertIsInstance(bough.export("boom.h5", "flat"), bytes)


if __name__ == "__main__":
    unittest.main()
