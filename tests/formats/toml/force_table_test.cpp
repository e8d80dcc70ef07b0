// [[force]] with a type and the laws of hinge coordinates: every key arrives, and none that has no meaning.
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/toml/specs.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/toml_lines.hpp"

namespace bough::toml_files {
namespace {

using Eigen::Vector3d;
using test::TempFolder;
using testing::ElementsAre;

const std::string kStart = R"(
[[body]]
name = "lid"
mass = 1
[[hinge]]
name = "pin"
type = "cylindrical"
child = "lid"
)";
const std::string kEnd = R"(
[[function]]
name = "law"
type = "table"
x = [0, 1]
y = [0, 2]
[simulation]
duration = 1
)";

records::SystemSpec read(const std::string& text, std::string& ids) {
  const TempFolder folder;
  Diagnostics diagnostics;
  const auto spec = read_system_spec(folder.write("s.toml", kStart + text + kEnd), diagnostics);
  ids.clear();
  for (const auto& d : diagnostics.items()) ids += d.id + " ";
  return spec;
}

std::string find_errors(const std::string& text) {
  std::string ids;
  read(text, ids);
  return ids;
}

TEST(ForceTable, EveryTypeArrives) {
  std::string ids;
  const auto spec = read(test::toml_lines(R"(
[[force]]; name = "strut"; type = "spring"; body = "lid"; node = 3; position = [1, 2, 3]
to_position = [4, 5, 6]; stiffness = 7; free_length = 8; damping = 9; preload = -1; tension_only = true
damper_table = "law"; function = "law"
[[force]]; name = "mount"; type = "bushing"; body = "lid"; stiffness = [1, 2, 3, 4, 5, 6]
damping = [[1, 1, 0, 0, 0, 0], [1, 2, 0, 0, 0, 0], [0, 0, 3, 0, 0, 0],
           [0, 0, 0, 4, 0, 0], [0, 0, 0, 0, 5, 0], [0, 0, 0, 0, 0, 6]]; rotation_deg = [0, 0, 90]
[[force]]; name = "pad"; type = "contact"; body = "lid"; shape = "sphere"; stiffness = 1e6; radius = 0.1
to_radius = 0.2; exponent = 1; damping = 0.3; friction = 0.4; slip_velocity = 0.001
[[force]]; name = "earth"; type = "gravity_central"; mu = 4e14; centre = [1, 0, 0]; j2 = 1e-3; radius = 6.4e6
axis = [0, 1, 0]; bodies = "lid"
[[force]]; name = "air"; type = "drag"; body = "lid"; area = 2; coefficient = 1.2; density = 1.3
wind = [3, 0, 0]; normal = [0, 1, 0]
)"),
                         ids);
  EXPECT_EQ(ids, "");
  EXPECT_TRUE(spec.forces.empty());
  ASSERT_EQ(spec.force_elements.size(), 5u);
  const auto& strut = spec.force_elements[0];
  EXPECT_EQ(strut.name, "strut");
  EXPECT_EQ(strut.from.node, 3);
  EXPECT_EQ(strut.from.position, Vector3d(1, 2, 3));
  EXPECT_EQ(strut.to.body, "ground");
  EXPECT_EQ(strut.to.position, Vector3d(4, 5, 6));
  EXPECT_EQ(strut.stiffness, 7);
  EXPECT_EQ(strut.free_length, 8);
  EXPECT_EQ(strut.damping, 9);
  EXPECT_EQ(strut.preload, -1);
  EXPECT_EQ(strut.sense, records::SpringSense::Tension);
  EXPECT_EQ(strut.damper_table, "law");
  EXPECT_EQ(strut.function, "law");
  EXPECT_GT(strut.at.line, 9);
  const auto& mount = spec.force_elements[1];
  EXPECT_EQ(mount.stiffness6(5, 5), 6);
  EXPECT_EQ(mount.stiffness6(0, 1), 0);
  EXPECT_EQ(mount.damping6(0, 1), 1);
  EXPECT_LT((mount.from.rotation * Vector3d(1, 0, 0) - Vector3d(0, 1, 0)).norm(), 1e-15);
  const auto& pad = spec.force_elements[2];
  EXPECT_EQ(pad.shape, records::ContactShape::Sphere);
  EXPECT_EQ(pad.radius + pad.to_radius, 0.1 + 0.2);
  EXPECT_EQ(pad.exponent, 1);
  EXPECT_EQ(pad.friction, 0.4);
  EXPECT_EQ(pad.slip_velocity, 0.001);
  const auto& earth = spec.force_elements[3];
  EXPECT_EQ(earth.mu, 4e14);
  EXPECT_EQ(earth.equator, 6.4e6);
  EXPECT_EQ(earth.axis, Vector3d(0, 1, 0));
  EXPECT_THAT(earth.bodies, ElementsAre("lid"));
  const auto& air = spec.force_elements[4];
  EXPECT_EQ(air.area * air.coefficient * air.density, 2 * 1.2 * 1.3);
  EXPECT_EQ(air.wind, Vector3d(3, 0, 0));
}

TEST(ForceTable, KeysOfAnotherTypeAndMissingOnesAreErrors) {
  const std::string spring = "[[force]]\nname = \"a\"\ntype = \"spring\"\nbody = \"lid\"\n";
  for (const auto& [keys, ids] : std::vector<std::pair<std::string, std::string>>{
           {"stiffness = 1\nfree_length = 1\n", ""},
           {"stiffness = 1\n", "toml.missing-key "},
           {"radius = 1\n", "toml.conflicting-keys "},
           {"frame = \"node\"\n", "toml.conflicting-keys "},
           {"force = [1, 0, 0]\n", "toml.conflicting-keys "},
           {"damping = [1, 2]\n", "toml.wrong-type "},
           {"to_body = \"lidd\"\n", "toml.unknown-name "},
           {"spring_table = \"lax\"\n", "toml.unknown-name "},
           {"tension_only = true\ncompression_only = true\n", "toml.conflicting-keys "},
           {"[[force]]\nname = \"a\"\nbody = \"lid\"\nforce = [1, 0, 0]\n", "toml.duplicate-name "},
       })
    EXPECT_EQ(find_errors(spring + keys), ids) << keys;
  EXPECT_EQ(find_errors("[[force]]\nname = \"a\"\nforce = [1, 0, 0]\n"), "toml.missing-key ");
  EXPECT_EQ(find_errors("[[force]]\nname = \"a\"\nbody = \"lid\"\nforce = [1, 0, 0]\nstiffness = 1\n"),
            "toml.conflicting-keys ");
  EXPECT_EQ(find_errors("[[force]]\nname = \"a\"\ntype = \"bushing\"\nbody = \"lid\"\nstiffness = [1, 2]\n"),
            "toml.wrong-length ");
}

TEST(HingeTable, LawsOfCoordinatesArrive) {
  std::string ids;
  const auto spec = read(R"(preload = [1, 2]
spring_table = ["law", ""]
stops = {lower_deg = [-90, 1], upper = 3, stiffness = 5}
friction = {coulomb = 1, static = [2, 3], stribeck_velocity = 4, smoothing = 0.1}
rotor_inertia = [0, 0.5]
gear_ratio = 10
)",
                         ids);
  EXPECT_EQ(ids, "");
  const auto& law = spec.hinges.at(0).law;
  EXPECT_THAT(law.preload, ElementsAre(1, 2));
  EXPECT_THAT(law.spring_table, ElementsAre("law", ""));
  EXPECT_TRUE(law.has_stops && law.has_friction);
  EXPECT_THAT(law.stop_lower, ElementsAre(-std::numbers::pi / 2, 1));
  EXPECT_THAT(law.stop_upper, ElementsAre(3, 3));
  EXPECT_THAT(law.stop_stiffness, ElementsAre(5, 5));
  EXPECT_THAT(law.static_friction, ElementsAre(2, 3));
  EXPECT_THAT(law.coulomb, ElementsAre(1, 1));
  EXPECT_THAT(law.rotor_inertia, ElementsAre(0, 0.5));
  EXPECT_THAT(law.gear_ratio, ElementsAre(10, 10));
  EXPECT_EQ(find_errors("stops = {lower = 0}\n"), "toml.missing-key ");
  EXPECT_EQ(find_errors("friction = {coulomb = 1, smooth = 0.1, smoothing = 1}\n"), "toml.unknown-key ");
}

}  // namespace
}  // namespace bough::toml_files
