"""Prints the demo's numbers against the reference and writes report.md beside the results. Exit 1 when one is off."""
import os
import sys

import spinup_numbers

LABELS = {
    "frequencies_rad_s[1]": "frequency 1 at rest [rad/s]",
    "frequencies_rad_s[2]": "frequency 2 at rest [rad/s]",
    "frequencies_rad_s[3]": "frequency 3 at rest [rad/s]",
    "minimum": "minimum of the tip deflection [m]",
    "minimum_order_3": "the same with the body of third order [m]",
    "time_of_minimum": "at time [s]",
    "at_7_5": "tip deflection at 7.5 s [m]",
    "residual_amplitude": "amplitude after 15 s [m]",
    "foreshortening": "foreshortening of the tip at the minimum [m]",
    "no_kg_at_7_5": "without geometric stiffness, at 7.5 s [m]",
    "no_kg_at_10": "without geometric stiffness, at 10 s [m]",
}


def main(folder):
    path = lambda name: os.path.join(folder, name)
    rows = spinup_numbers.compare(
        spinup_numbers.calc_numbers(path("spinup.h5"), path("spinup-no-kg.h5"), path("boom.h5"),
                                    path("spinup-order3.h5")))
    print(f"\n{'':46} {'computed':>12} {'reference':>12} {'error':>9} {'allowed':>9}")
    lines = ["# Spin-up of a boom: computed against reference", "",
             "| quantity | computed | reference | error | allowed | |", "| --- | --- | --- | --- | --- | --- |"]
    for name, value, expected, error, tolerance, passed in rows:
        verdict = "ok" if passed else "OFF"
        print(f"{LABELS[name]:46} {value:12.6g} {expected:12.6g} {100 * error:8.3f}% {100 * tolerance:8.2f}%  {verdict}")
        lines.append(f"| {LABELS[name]} | {value:.6g} | {expected:.6g} | {100 * error:.3f} % | {100 * tolerance:g} % | {verdict} |")
    lines += ["", "![tip deflection](figure5.svg)", "",
              "Results: spinup.h5, spinup-no-kg.h5, spinup-order3.h5 (sensor tip_deflection, in the boom's frame); bodies: "
              "boom.h5, boom-order3.h5.", ""]
    with open(path("report.md"), "w") as f:
        f.write("\n".join(lines))
    print(f"\nspinup.html (open it in a browser), results, figure5.svg and report.md are in {folder}")
    return 0 if all(row[-1] for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
