#include "tests/formats/toml/toml_cases.hpp"

#include <gtest/gtest.h>

namespace bough::test {

const char* const kGoodSystem = R"(name = "crane"

[[body]]
name = "tower"
file = "tower.h5"
stiffening = false
eta = [0.1, 0.0]
eta_dot = [0, 0.5]
damping = 0.01
modes = 2

[[body]]
name = "hook"
mass = 12
cg = [0.0, 0.0, -0.5]
inertia = [1.0, 2.0, 3.0, 0.1, 0.2, 0.3]
nodes = [{id = 1, position = [0.0, 0.0, -1.0]}]

[[hinge]]
name = "base"
type = "fixed"
child = "tower"

[[hinge]]
name = "swivel"
type = "universal"
parent = "tower"
child = "hook"
parent_node = 41
parent_position = [0.0, 0.0, 1.5]
parent_rotation_deg = [90.0, 0.0, 0.0]
axis = [1.0, 0.0, 0.0]
axis2 = [0.0, 1.0, 0.0]
stiffness = 100.0
damping = [1.0, 2.0]
position_deg = [30.0, -45.0]
rate = [0.0, 0.1]

[[function]]
name = "wave"
type = "sine"
amplitude_deg = 180.0
omega = 2.0

[[function]]
name = "profile"
type = "table"
x = [0.0, 1.0]
y = [0.0, 2.0]
interpolation = "cubic"

[[force]]
name = "wind"
body = "hook"
node = 1
force = [1.0, 0.0, 0.0]
frame = "inertial"
function = "wave"

[[sensor]]
name = "tip"
type = "deflection"
body = "tower"
node = 41

[[sensor]]
name = "where"
type = "position"
body = "hook"
frame = "tower"
relative_to = "tower"

[[sensor]]
name = "angle"
type = "hinge_angle"
hinge = "swivel"
coordinate = 1

[simulation]
duration = 10.0
integrator = "bdf"
gravity = [0.0, 0.0, -9.81]
)";

const char* const kGoodBody = R"([body]
name = "boom"
deck = "decks/boom.bdf"
subcase = 2
frame = "free"
interface = [1, 41]
support = [1]
origin = [0.0, 1.0, 2.0]
mass = "lumped"
integrals = "consistent"
ignore = ["PLOTEL"]

[body.modes]
number = 6
max_frequency = 100.0
select = [1, 2, 4]

[body.stiffening]
inertial = ["ax", "wz2"]

[[body.load]]
name = "tip"
node = 41
direction = ["x", 5]

[[body.load]]
name = "thrust"
load_set = 7

[[body.load]]
name = "sun"
temperature_set = 8

[body.preload]
load_set = 5
temperature_set = 6
spin = [0.0, 0.5, 2.0]

[body.damping]
ratios = [0.01, 0.02, 0.03]

[body.output]
file = "out/boom.h5"
nodes = [1, 41]
full = true
)";

std::vector<BadDocument> get_bad_systems() {
  return {
      {"toml.syntax", "duration = 10.0", "duration = ", "not TOML"},
      {"toml.unknown-key", "stiffness = 100.0", "stifness = 100.0", "did you mean 'stiffness'?"},
      {"toml.unknown-key", "name = \"crane\"", "title = \"crane\"", "unknown key 'title'"},
      {"toml.unknown-key", "interpolation = \"cubic\"", "interpolate = \"cubic\"", "did you mean 'interpolation'?"},
      {"toml.unknown-table", "[simulation]", "[[hinges]]\nname = \"x\"\n[simulation]", "did you mean 'hinge'?"},
      {"toml.unknown-parameter", "[simulation]", "[parameters]\nspan = 1\n[simulation]\nstep = \"$spam\"", "$span"},
      {"toml.missing-key", "[simulation]", "[[controller]]\nname = \"x\"\n[simulation]", "'type'"},
      {"toml.missing-key", "[simulation]", "[[connect]]\nfrom = \"x\"\n[simulation]", "'to'"},
      {"toml.missing-key", "duration = 10.0", "duration = 10.0\nstiffening = \"lagged\"", "'stiffening_step'", false},
      {"toml.conflicting-keys", "duration = 10.0", "duration = 10.0\nstiffening_step = 0.1", "is not lagged", false},
      {"toml.motion-of-signal", "rate = [0.0, 0.1]", "motion = [\"angle\", \"\"]", "drive the hinge by an actuator",
       false},
      {"toml.missing-key", "[simulation]",
       "[[event]]\nname = \"x\"\ntime = 1\naction = \"switch\"\ninput = 1\n[simulation]", "'controller'", false},
      {"toml.conflicting-keys", "[simulation]", "[[event]]\nname = \"x\"\ntime = 1\ncontroller = \"law\"\n[simulation]",
       "'controller' has no meaning", false},
      {"toml.wrong-type", "[simulation]",
       "[[controller]]\nname = \"x\"\ntype = \"gain\"\ninputs = \"a\"\ngain = [[1, 2], [3]]\n[simulation]",
       "rows of one", false},
      {"toml.wrong-type", "mass = 12", "mass = \"heavy\"", "mass is a string, expected a number"},
      {"toml.wrong-type", "stiffening = false", "stiffening = 0", "is an integer, expected true or false"},
      {"toml.wrong-type", "damping = [1.0, 2.0]", "damping = [1.0, \"two\"]", "damping[2] is a string"},
      {"toml.wrong-type", "duration = 10.0", "duration = 1979-05-27", "is a date or time, expected a number"},
      {"toml.wrong-type", "node = 1\n", "node = 1.5\n", "node is a number, expected an integer"},
      {"toml.wrong-length", "axis = [1.0, 0.0, 0.0]", "axis = [1.0, 0.0]", "has 2 entries, expected 3"},
      {"toml.wrong-length", "damping = [1.0, 2.0]", "damping = [1.0]", "expected 2 for a universal hinge", false},
      {"toml.wrong-length", "rate = [0.0, 0.1]", "rate = 0.1", "rate has 1 entries, expected 2", false},
      {"toml.wrong-length", "rate = [0.0, 0.1]", "motion = [\"wave\"]", "motion has 1 entries, expected 2", false},
      {"toml.wrong-length", "y = [0.0, 2.0]", "y = [0.0, 2.0, 3.0]", "y has 3 entries, expected 2 as x", false},
      {"toml.wrong-length", "inertia = [1.0, 2.0, 3.0, 0.1, 0.2, 0.3]", "inertia = [1.0, 2.0, 3.0, 0.1]",
       "neither three moments nor six components", false},
      {"toml.bad-value", "type = \"universal\"", "type = \"univrsal\"", "did you mean 'universal'?"},
      {"toml.bad-value", "integrator = \"bdf\"", "integrator = \"bfd\"", "expected one of adams, bdf, rk, radau, rk4"},
      {"toml.bad-value", "inertia = [1.0, 2.0, 3.0, 0.1, 0.2, 0.3]", "inertia = [0.1, 0.1, 5.0, 0.0, 0.0, 0.0]",
       "more than twice the sum of the others", false},
      {"toml.bad-value", "inertia = [1.0, 2.0, 3.0, 0.1, 0.2, 0.3]",
       "inertia = [[1.0, 0, 0], [0.5, 1.0, 0], [0, 0, 1]]", "inertia is not symmetric", false},
      {"toml.bad-name", "name = \"wind\"", "name = \"wind/x\"", "without a slash"},
      {"toml.bad-name", "name = \"wind\"", "name = \"..\"", "without a slash"},
      {"toml.bad-name", "name = \"wind\"", "name = \"wind\\u0000x\"", "control characters"},
      {"toml.bad-name", "name = \"wind\"", "name = \"" + std::string(40000, 'w') + "\"", "has 40000 letters"},
      {"toml.out-of-range", "mass = 12", "mass = -12.5", "is -12.5, expected at least 0"},
      {"toml.out-of-range", "duration = 10.0", "duration = 0", "is 0, expected more than 0"},
      {"toml.missing-key", "child = \"hook\"\n", "", "missing key 'child' in hinge 'swivel'"},
      {"toml.missing-key", "mass = 12\n", "", "expected one of 'file', 'mass'"},
      {"toml.missing-key", "hinge = \"swivel\"\n", "", "missing key 'hinge' in sensor 'angle'", false},
      {"toml.missing-key", "y = [0.0, 2.0]\n", "", "missing key 'y' in function 'profile'", false},
      {"toml.missing-key", "integrator = \"bdf\"", "integrator = \"rk4\"", "missing key 'step'", false},
      {"toml.missing-table", "[simulation]\nduration = 10.0\nintegrator = \"bdf\"\ngravity = [0.0, 0.0, -9.81]\n", "",
       "missing table 'simulation'"},
      {"toml.conflicting-keys", "rate = [0.0, 0.1]", "position = [0.0, 0.1]", "'position' and 'position_deg'"},
      {"toml.conflicting-keys", "force = [1.0, 0.0, 0.0]", "force = [1.0, 0.0, 0.0]\nmoment = [1.0, 0.0, 0.0]",
       "'force' and 'moment' stand together"},
      {"toml.conflicting-keys", "omega = 2.0", "omega = 2.0\namplitude = 1.0", "'amplitude' and 'amplitude_deg'",
       false},
      {"toml.conflicting-keys", "modes = 2", "modes = 2\ncg = [0, 0, 1]", "'cg' has no meaning", false},
      {"toml.conflicting-keys", "mass = 12", "mass = 12\neta = [0.1]", "which is rigid", false},
      {"toml.conflicting-keys", "hinge = \"swivel\"", "hinge = \"swivel\"\nbody = \"hook\"", "'body' has no meaning",
       false},
      {"toml.conflicting-keys", "omega = 2.0", "omega = 2.0\nx = [0.0, 1.0]", "whose type is sine", false},
      {"toml.no-angle", "type = \"fixed\"\nchild = \"tower\"",
       "type = \"prismatic\"\nchild = \"tower\"\nposition_deg = 3.0", "of type prismatic has no angle in position",
       false},
      {"toml.duplicate-name", "[simulation]",
       "[[force]]\nname = \"wind\"\nbody = \"hook\"\nmoment = [0, 0, 1]\n[simulation]",
       "force 'wind' was already given in line 52", false},
      {"toml.duplicate-name", "nodes = [{id = 1, position = [0.0, 0.0, -1.0]}]",
       "nodes = [{id = 1, position = [0, 0, 1]}, {id = 1, position = [0, 0, 2]}]", "node 1 of body 'hook'", false},
      {"toml.reserved-name", "[[hinge]]\nname = \"base\"",
       "[[body]]\nname = \"ground\"\nmass = 1\n[[hinge]]\nname = \"base\"", "a body is called 'ground'", false},
      {"toml.unknown-name", "parent = \"tower\"", "parent = \"towr\"", "did you mean 'tower'?", false},
      {"toml.unknown-name", "function = \"wave\"", "function = \"waves\"", "the function 'waves'", false},
      {"toml.unknown-name", "rate = [0.0, 0.1]", "motion = [\"wave\", \"nothing\"]", "the function 'nothing'", false},
      {"toml.unknown-name", "frame = \"tower\"", "frame = \"towers\"", "the frame 'towers'", false},
      {"toml.unknown-name", "relative_to = \"tower\"", "relative_to = \"nobody\"", "the body 'nobody'", false},
      {"toml.unknown-name", "hinge = \"swivel\"", "hinge = \"swivle\"", "did you mean 'swivel'?", false},
      {"toml.nan", "y = [0.0, 2.0]", "y = [0.0, nan]", "y[2] is not a finite number", false},
      {"toml.nan", "duration = 10.0", "duration = inf", "is not a finite number", false},
      {"toml.nan", "omega = 2.0", "omega = -nan", "omega is not a finite number", false},
      {"toml.table-file", "x = [0.0, 1.0]\ny = [0.0, 2.0]", "file = \"nowhere.csv\"", "cannot be opened", false},
  };
}

std::vector<BadDocument> get_bad_bodies() {
  return {
      {"toml.unknown-key", "support = [1]", "suport = [1]", "did you mean 'support'?"},
      {"toml.unknown-table", "[body.damping]", "[body.dampng]", "did you mean 'damping'?"},
      {"toml.wrong-type", "interface = [1, 41]", "interface = 1", "is an integer, expected an array"},
      {"toml.missing-key", "deck = \"decks/boom.bdf\"\n", "",
       "missing key in body, expected one of 'deck', 'matrices'"},
      {"toml.missing-table", "[body.modes]\nnumber = 6\nmax_frequency = 100.0\nselect = [1, 2, 4]\n", "",
       "missing table 'modes'"},
      {"toml.missing-key", "number = 6\nmax_frequency = 100.0\n", "", "expected one of 'number', 'max_frequency'"},
      {"toml.bad-value", "frame = \"free\"", "frame = \"fre\"", "did you mean 'free'?"},
      {"toml.bad-value", "inertial = [\"ax\", \"wz2\"]", "inertial = [\"ax\", \"wz3\"]", "did you mean 'wz2'?"},
      {"toml.bad-value", "inertial = [\"ax\", \"wz2\"]", "inertial = \"none\"", "expected \"all\" or a list", false},
      {"toml.bad-value", "direction = [\"x\", 5]", "direction = [\"x\", 7]", "is 7, expected one of"},
      {"toml.bad-value", "direction = [\"x\", 5]", "direction = \"up\"", "direction is 'up'", false},
      {"toml.bad-value", "nodes = [1, 41]", "nodes = \"some\"", "nodes is 'some'", false},
      {"toml.wrong-length", "inertial = [\"ax\", \"wz2\"]", "inertial = []", "has 0 entries, expected at least 1"},
      {"toml.out-of-range", "select = [1, 2, 4]", "select = [1, 2, 7]", "select names mode 7", false},
      {"toml.out-of-range", "subcase = 2", "subcase = -2", "expected at least 0"},
      {"toml.conflicting-keys", "load_set = 7", "load_set = 7\nnode = 3", "'node' and 'load_set'"},
      {"toml.conflicting-keys", "load_set = 7", "load_set = 7\ndirection = 3", "'load_set' and 'direction'", false},
      {"toml.conflicting-keys", "load_set = 7", "load_set = 7\ntemperature_set = 9",
       "'load_set' and 'temperature_set'"},
      {"toml.conflicting-keys", "load_set = 5\ntemperature_set = 6", "subcase = 2\nload_set = 5",
       "'subcase' and 'load_set'", false},
      {"toml.conflicting-keys", "[body]\n", "[preload]\nsubcase = 1\n[body]\n", "[preload] stand together", false},
      {"toml.missing-key", "load_set = 5\ntemperature_set = 6\nspin = [0.0, 0.5, 2.0]\n", "",
       "expected one of 'subcase', 'load_set', 'temperature_set', 'spin'"},
      {"toml.wrong-length", "spin = [0.0, 0.5, 2.0]", "spin = [0.0, 0.5]", "has 2 entries, expected 3"},
      {"toml.conflicting-keys", "ratios = [0.01, 0.02, 0.03]", "ratios = [0.01]\nratio = 0.1", "'ratio' and 'ratios'"},
      {"toml.conflicting-keys", "frame = \"free\"", "frame = \"fixed\"", "'support' stands with frame", false},
      {"toml.duplicate-name", "name = \"thrust\"", "name = \"tip\"", "load 'tip' was already given", false},
      {"toml.nan", "max_frequency = 100.0", "max_frequency = nan", "is not a finite number", false},
  };
}

std::string make_document(const std::string& good, const BadDocument& bad) {
  const auto at = good.find(bad.old_text);
  EXPECT_NE(at, std::string::npos) << bad.old_text;
  EXPECT_EQ(good.find(bad.old_text, at + 1), std::string::npos) << bad.old_text;
  return std::string(good).replace(at, bad.old_text.size(), bad.new_text);
}

}  // namespace bough::test
