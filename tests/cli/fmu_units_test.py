"""Units of exported FMUs: those of the system's dimensions, with factors to SI."""
import unittest

from fmu_case import CHAIN, FmuCase


class FmuUnitsTest(FmuCase):
    def test_units_follow_from_dimensions(self):
        free = ('[[body]]\nname = "flyer"\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n[[sensor]]\nname = "attitude"\ntype = "quaternion"\n'
                'body = "flyer"\n[[sensor]]\nname = "spin"\ntype = "gyro"\nbody = "flyer"\n[simulation]')
        self.write("chain.toml", "[parameters]\nk = 3.0\n" + CHAIN.replace("[3.0]", '["$k"]').replace("[simulation]", free))
        newton, second = 0.45359237 * 9.80665, 1.0
        for version in (2, 3):
            fmu = self.export("chain.toml", version)
            q1, q2 = fmu.states[:2]
            self.assertEqual(fmu.units, {"rad": {"rad": 1}})
            self.assertEqual({name for name, unit in fmu.unit_of.items() if unit}, {q1, q2, "upper", "slow"})
            for text, length, force, time, of in [("m-kg-s", 1, 1, 1, ("m", "N", "s", "kg")),
                                                  ("mm-N-tonne", 1e-3, 1, 1, ("mm", "N", "s", "tonne")),
                                                  ("in-lbf-s", 0.0254, newton, second, ("in", "lbf", "s", "slinch")),
                                                  ("km-kg-h", 1e3, None, 3600, ("km", None, "h", "kg"))]:
                fmu = self.export("chain.toml", version, "--units", text)
                m, n, s, kg = of
                torque = f"{n}.{m}" if n else f"{kg}.{m}2/{s}2"
                work = fmu.states[-2]
                flyer = [name for name in fmu.states if "flyer" in name]
                expected = {"torque": torque, "upper": "rad", "rate": f"rad/{s}", "shake:x": f"{m}/{s}2", "tip:x": m, "k": None,
                            "target": None, "attitude:w": None, "spin:x": f"rad/{s}", q1: "rad", "der(" + q1 + ")": f"rad/{s}",
                            fmu.derivatives[fmu.states.index(flyer[-1])]: f"{m}/{s}2", flyer[0]: None, flyer[4]: m, work: torque,
                            "der(" + work + ")": f"{kg}.{m}2/{s}3"}
                self.assertEqual({name: fmu.unit_of[name] for name in expected}, expected)
                if version == 3:
                    self.assertEqual(fmu.unit_of["time"], s)
                factor = length * force if force else length ** 2 / time ** 2
                got = fmu.units[torque]
                self.assertEqual({k: v for k, v in got.items() if k != "factor"}, {"kg": 1, "m": 2, "s": -2})
                self.assertAlmostEqual(got.get("factor", 1) / factor, 1, delta=1e-12)
                self.assertEqual({k: v for k, v in fmu.units[f"rad/{s}"].items() if k != "factor"}, {"rad": 1, "s": -1})
        self.write("labelled.toml", '[units]\nlength = "mm"\nmass = "tonne"\ntime = "s"\n' + self.read("chain.toml"))
        self.assertEqual(self.export("labelled.toml", 3).unit_of["tip:x"], "mm")
        self.fails(1, "export", "labelled.toml", "--to", "fmu", "--units", "m-kg-s", "-o", "a.fmu",
                   says=["labelled.toml", 'length = "mm"'], error="cli.bad-units")
        self.fails(1, "export", "chain.toml", "--to", "fmu", "--units", "m-kg-parsec", "-o", "a.fmu", error="cli.bad-units")


if __name__ == "__main__":
    unittest.main()
