"""Every option of a command is an option of its function in Python, or in the table of those that are not, with why."""
import ast
import os
import re
import subprocess
import unittest

import bough

PROGRAM = os.environ["BOUGH_PROGRAM"]
# Options that set how a command prints and where it writes.
PRINTING = {"help", "output", "no-clobber", "force", "json", "quiet", "verbose"}
# In Python under another name.
NAMES = {"load": "loads", "sensor": "sensors", "channel": "channels", "grid": "grids", "body-id": "body_ids",
         "label": "labels", "set": "parameters", "from": "from_hz", "to": "to_hz", "plane": "planes", "body": "bodies",
         "fi": "inertial_loads", "no-check": "check", "loop": "loop", "number": "number", "budget": "budget",
         "integrals-report": "a FlexBody in compare()"}
# Not in Python, with the reason.
LACKING = {
    "check": {"gpwg": "a table of the terminal", "diagram": "a picture of the program"},
    "modes": {"sensitivities": "not done", "compare": "compare()", "vtu": "export(..., \"vtu\")"},
    "static": {"full": "a listing of the terminal", "cd": "a listing of the terminal", "vtu": "export(..., \"vtu\")"},
    "frequency": {"full": "a listing of the terminal", "limit": "not done", "psd-limit": "not done", "notch": "not done",
                  "notch-csv": "not done"},
    "transient": {"full": "a listing of the terminal"},
    "matrices": {"to": "scipy.io writes them"},
    "reduce": {"force-outside": "no file is chosen by the body file"},
    "integrals": {"layout": "a layout of text"},
    "flx": {"read": "read_flx()", "int": "a layout of text", "int-first": "a layout of text", "layout": "a layout of text"},
    "response": {"csv": "arrays"},
    "select": {"stiffening": "a listing of the terminal", "response": "a picture"},
    "plot": {"term": "the terminal", "csv": "the member csv"},
    "init": {"list": "files of data/examples"},
    "batch": {"merge": "not done", "force-outside": "not done", "dry-run": "not done"},
    "convert": {"from": "units=\"FROM:TO\"", "to": "units=\"FROM:TO\""},
}
# Functions of bough.System, and a page.
ELSEWHERE = {"linearize", "studio"}


def list_keywords():
    """{function: its options} of the stub of the package."""
    with open(os.path.join(os.path.dirname(bough.__file__), "__init__.pyi"), encoding="utf-8") as f:
        tree = ast.parse(f.read())
    return {node.name: {arg.arg for arg in [*node.args.args, *node.args.kwonlyargs]}
            for node in tree.body if isinstance(node, ast.FunctionDef)}


class Choices(unittest.TestCase):
    def test_options_of_the_commands(self):
        functions = list_keywords()
        for command in bough.verbs():
            if command in ELSEWHERE:
                continue
            text = subprocess.run([PROGRAM, command, "--help"], capture_output=True, text=True, check=True).stdout
            lacking = set(LACKING.get(command, {}))
            for names in re.findall(r"(?m)^  (?:-\w,)?((?:--[\w-]+,?)+)", text):
                names = [name.lstrip("-") for name in names.strip(",").split(",")]
                if PRINTING & set(names):
                    continue
                with self.subTest(f"{command} --{names[-1]}"):
                    known = {name.replace("-", "_") for name in names} | {NAMES.get(name, "") for name in names}
                    is_given = bool(known & functions[command]) or any(" " in name for name in known)
                    self.assertNotEqual(is_given, bool(set(names) & lacking), "in Python or in LACKING, and not in both")
                lacking -= set(names)
            self.assertEqual(lacking, set(), f"{command} has no such option")


if __name__ == "__main__":
    unittest.main()
