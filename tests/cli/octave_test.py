"""data/matlab in Octave: bough_read.m gives what h5py reads of every kind of file, bit by bit; bough_ss.m the model."""
import os
import re
import shutil
import subprocess
import unittest

import h5py
import numpy as np

from deck_response_case import ONE
from linear_test import PENDULUM
from monte_carlo_test import CAMPAIGN, SYSTEM
from response_test import AXIS
from static_test import FRAME
from support import SOURCE, ProgramTest

# Every array as a line (path, class, size, or its texts) and, numbers, as bytes in C order.
WALK = """addpath('{matlab}');
function walk(s, path, list, bytes, notes)
  for name = fieldnames(s)'
    value = s.(name{{1}}); here = [path '/' name{{1}}];
    if isstruct(value), walk(value, here, list, bytes, notes);
    elseif iscell(value), fprintf(list, '%s\\ttext\\t%s\\n', here, strrep(strrep(strjoin(value(:)', char(30)), char(10), char(31)), char(9), char(29)));
    elseif ischar(value), fprintf(list, '%s\\ttext\\t%s\\n', here, strrep(strrep(value, char(10), char(31)), char(9), char(29)));
    else
      fprintf(list, '%s\\t%s\\t%s\\n', here, class(value), sprintf('%d ', size(value)));
      fwrite(bytes, permute(value, ndims(value):-1:1), class(value));
    end
  end
end
for k = 1:numel(argv())
  name = argv(){{k}};
  [s, notes] = bough_read(name);
  list = fopen([name '.list'], 'w'); bytes = fopen([name '.bytes'], 'w');
  walk(s, '', list, bytes, notes);
  fclose(list); fclose(bytes);
  list = fopen([name '.notes'], 'w');
  for key = keys(notes)
    one = notes(key{{1}});
    if isfield(one, 'description'), fprintf(list, '%s\\t%s\\t%s\\n', key{{1}}, one.description, one.dims); end
  end
  fclose(list);
end
"""


def make_valid(name):
    name = re.sub("[^A-Za-z0-9_]", "_", name)
    return name if name[:1].isalpha() and name not in ("case", "end", "function") else "x" + name


def list_datasets(group, path=""):
    """Visits arrays by every name: one linked twice appears twice."""
    for name, item in group.items():
        if isinstance(item, h5py.Group):
            yield from list_datasets(item, path + name + "/")
        else:
            yield path + name, item


@unittest.skipUnless(shutil.which("octave"), "Octave is not installed (apt install octave); bough_read.m is not run")
class Octave(ProgramTest):
    def octave(self, script, *arguments):
        self.write("run.m", script)
        done = subprocess.run(["octave", "--no-gui", "--quiet", "--no-init-file", "run.m", *arguments], cwd=self.folder,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def check(self, name):
        """Number of arrays compared."""
        with open(self.path(name + ".list"), encoding="utf-8", newline="\n") as f:
            found = {line.split("\t")[0]: line.rstrip("\n").split("\t")[1:] for line in f}
        with open(self.path(name + ".bytes"), "rb") as f:
            data = f.read()
        with open(self.path(name + ".notes"), encoding="utf-8") as f:
            notes = {line.split("\t")[0]: line.rstrip("\n").split("\t")[1:] for line in f}
        numbers, at = {}, 0
        for path, (kind, size) in found.items():
            if kind == "text":
                continue
            shape = [int(n) for n in size.split()]
            kind = np.dtype({"double": "<f8"}.get(kind, kind))
            count = int(np.prod(shape))
            numbers[path] = np.frombuffer(data, kind, count, at).reshape(shape)
            at += count * kind.itemsize
        self.assertEqual(at, len(data))
        count = 0
        with h5py.File(self.path(name)) as f:
            self.assertEqual(found.pop("/format"), ["text", f.attrs["format"]])
            items = list(list_datasets(f))
            for path, item in items:
                where = "/" + "/".join(map(make_valid, path.split("/")))
                self.assertIn(where, found, name)
                if h5py.check_string_dtype(item.dtype):
                    texts = np.atleast_1d(item.asstr()[()]).ravel()
                    self.assertEqual(found[where], ["text", "\x1e".join(texts).replace("\n", "\x1f").replace("\t", "\x1d")],
                                     (name, path))
                else:
                    expected = item[()]
                    got = numbers[where].reshape(expected.shape)
                    self.assertEqual((got.dtype, numbers[where].size), (expected.dtype, expected.size))
                    self.assertEqual(got.tobytes(), expected.tobytes(), (name, path))
                if "description" in item.attrs:
                    self.assertEqual(notes["/" + path], [item.attrs["description"], item.attrs["dims"]])
                count += 1
        self.assertEqual(sorted(found), sorted("/" + "/".join(map(make_valid, path.split("/"))) for path, _ in items))
        return count

    def test_every_kind_of_file(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml", "--full")
        self.bough("run", "spinup.toml", "-o", "spinup.h5")
        self.bough("modes", "boom.bdf", "--ese", "-o", "modes.h5")
        self.bough("matrices", "boom.bdf", "-o", "matrices.h5")
        self.bough("reduce", "boom.bdf", "--modes", "2", "-o", "small.h5")
        self.bough("compare", "boom.h5", "small.h5", "-o", "comparison.h5")
        self.write("frame.bdf", FRAME)
        self.bough("static", "frame.bdf", "-o", "static.h5")
        self.write("axis.toml", AXIS)
        self.bough("equilibrium", "axis.toml", "-o", "rest.h5")
        self.bough("linearize", "axis.toml", "-o", "linear.h5")
        self.bough("linearize", "axis.toml", "--sweep", "kd=-3:12:4", "-o", "sweep.h5")
        self.bough("response", "linear.h5", "-o", "response.h5")
        self.write("one.bdf", ONE.format(sol=111, case="DLOAD = 7\nFREQUENCY = 5", bulk="FREQ1,5,0.1,0.1,9\n"
                   "RLOAD1,7,8,,,9\nDAREA,8,1,1,1.\nTABLED1,9\n,0.,1.,1000.,1.,ENDT"))
        self.bough("frequency", "one.bdf", "-o", "frequency.h5")
        self.write("axis.toml", SYSTEM)
        self.write("many.toml", CAMPAIGN.replace("COUNT", "3"))
        self.bough("batch", "many.toml", "-j", "1")
        shutil.copy(self.path("many/outcomes.h5"), self.path("outcomes.h5"))
        names = [name for name in sorted(os.listdir(self.folder)) if name.endswith(".h5")]
        self.assertGreaterEqual(len(names), 12)
        self.octave(WALK.format(matlab=os.path.join(SOURCE, "data", "matlab")), *names)
        counts = {name: self.check(name) for name in names}
        print(counts)
        self.assertGreater(counts["spinup.h5"], 20)

    def test_linear_model(self):
        matlab = os.path.join(SOURCE, "data", "matlab")
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.0"))
        self.bough("linearize", "pendulum.toml", "--outputs", "angle", "-o", "m.h5")
        self.write("axis.toml", AXIS.replace('kd = "$kd"\n', 'kd = "$kd"\nsample_time = 0.1\ndelay = 0.04\n'))
        self.bough("linearize", "axis.toml", "--break", "drive", "-o", "loop.h5")
        for name in ("m", "loop"):
            self.bough("response", name + ".h5", "--csv", name + ".csv")
        said = self.octave(
            f"addpath('{matlab}');\nif isempty(pkg('list', 'control')), disp('absent'); exit, end\npkg load control\n"
            "for name = {'m', 'loop'}\n  s = bough_ss([name{1} '.h5']); r = dlmread([name{1} '.csv'], ',', 1, 0);\n"
            "  H = squeeze(freqresp(s, 2 * pi * r(:, 1)))(:);\n"
            "  assert(H, r(:, 2) + 1i * r(:, 3), 1e-6 * max(abs(H)));\nend\n"
            "assert(get(s, 'tsam'), 0.1);\n"
            "s = bough_ss('m.h5'); m = bough_read('m.h5');\n"
            "assert(get(s, 'stname'), m.states.name); assert(get(s, 'outname'), m.outputs.name);\n"
            "assert(cplxpair(pole(s)), cplxpair(m.poles.real + 1i * m.poles.imag), 1e-9);\ndisp('done');\n")
        if "absent" in said:
            self.skipTest("the control package of Octave is not installed")
        self.assertIn("done", said)

    def test_what_it_cannot_read(self):
        self.write("text.h5", "no HDF5")
        with h5py.File(self.path("other.h5"), "w") as f:
            f["x"] = [1.0, 2.0]
        with h5py.File(self.path("new.h5"), "w", libver="latest") as f:
            f["x"] = [1.0]
        said = self.octave(f"addpath('{os.path.join(SOURCE, 'data', 'matlab')}');\n"
                           "for name = {'absent.h5', 'text.h5', 'other.h5', 'new.h5'}\n"
                           "  try, bough_read(name{1}); disp('read'), catch e, disp(e.message), end\nend\n")
        lines = said.splitlines()
        for line, words in zip(lines, ["absent.h5", "is no HDF5 file", "no attribute format", "not as Bough writes them"]):
            self.assertIn(words, line)
        self.assertEqual(len(lines), 4)


if __name__ == "__main__":
    unittest.main()
