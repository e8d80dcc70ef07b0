#include <algorithm>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/toml/specs.hpp"
#include "tests/formats/toml/toml_cases.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temp_folder.hpp"

namespace bough::toml_files {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::TempFolder;
using testing::ElementsAre;
using testing::HasSubstr;
constexpr double kPi = std::numbers::pi;

std::string join(const Diagnostics& diagnostics) {
  std::string text;
  for (const auto& d : diagnostics.items()) text += format(d) + "\n";
  return text;
}

/// 1-based line of the first place where two texts differ.
int find_first_changed_line(const std::string& a, const std::string& b) {
  const auto at = std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first;
  return 1 + static_cast<int>(std::count(a.begin(), at, '\n'));
}

/// Content of a file without faults, which has its own path and this name.
template <class Read>
auto read_clean(const std::string& path, const std::string& name, const Read& read) {
  Diagnostics diagnostics;
  auto spec = read(path, diagnostics);
  EXPECT_TRUE(diagnostics.items().empty()) << join(diagnostics);
  EXPECT_EQ(spec.name, name);
  EXPECT_EQ(spec.file, path);
  return spec;
}

TEST(SystemFile, EveryKeyOfAGoodFileArrives) {
  const TempFolder folder;
  const std::string path = folder.write("crane.toml", test::kGoodSystem);
  const auto spec = read_clean(path, "crane", [](const auto& p, Diagnostics& d) { return read_system_spec(p, d); });
  EXPECT_EQ(spec.text, test::kGoodSystem);

  ASSERT_EQ(spec.bodies.size(), 2u);
  const auto& tower = spec.bodies[0];
  EXPECT_EQ(tower.file, folder.at("tower.h5"));
  EXPECT_FALSE(tower.stiffening);
  EXPECT_THAT(tower.eta, ElementsAre(0.1, 0));
  EXPECT_THAT(tower.eta_dot, ElementsAre(0, 0.5));
  EXPECT_THAT(tower.damping_ratios, ElementsAre(0.01));
  EXPECT_EQ(tower.num_modes, 2);
  EXPECT_EQ(tower.at.line, 3);
  const auto& hook = spec.bodies[1];
  EXPECT_EQ(hook.mass, 12);
  EXPECT_EQ(hook.cg, Vector3d(0, 0, -0.5));
  Matrix3d inertia;
  inertia << 1, 0.1, 0.2, 0.1, 2, 0.3, 0.2, 0.3, 3;
  EXPECT_EQ(hook.inertia, inertia);
  ASSERT_EQ(hook.nodes.size(), 1u);
  EXPECT_EQ(hook.nodes[0].id, 1);
  EXPECT_EQ(hook.nodes[0].p, Vector3d(0, 0, -1));
  EXPECT_TRUE(hook.file.empty());

  ASSERT_EQ(spec.hinges.size(), 2u);
  EXPECT_EQ(spec.hinges[0].parent, "ground");
  const auto& swivel = spec.hinges[1];
  EXPECT_EQ(swivel.type, records::HingeType::Universal);
  EXPECT_EQ(swivel.parent, "tower");
  EXPECT_EQ(swivel.child, "hook");
  EXPECT_EQ(swivel.parent_node, 41);
  EXPECT_EQ(swivel.parent_position, Vector3d(0, 0, 1.5));
  // A quarter turn about x takes y to z and z to -y.
  EXPECT_TRUE(swivel.parent_rotation.isApprox((Matrix3d() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished(), 1e-15));
  EXPECT_EQ(swivel.child_rotation, Matrix3d::Identity());
  EXPECT_EQ(swivel.axis, Vector3d::UnitX());
  EXPECT_EQ(swivel.axis2, Vector3d::UnitY());
  EXPECT_THAT(swivel.stiffness, ElementsAre(100, 100));
  EXPECT_THAT(swivel.damping, ElementsAre(1, 2));
  EXPECT_THAT(swivel.position, ElementsAre(testing::DoubleEq(kPi / 6), testing::DoubleEq(-kPi / 4)));
  EXPECT_THAT(swivel.rate, ElementsAre(0, 0.1));
  EXPECT_TRUE(swivel.motion.empty() && swivel.null_position.empty());

  ASSERT_EQ(spec.functions.size(), 2u);
  EXPECT_DOUBLE_EQ(spec.functions[0].values.at("amplitude"), kPi);
  EXPECT_EQ(spec.functions[0].values.at("omega"), 2);
  EXPECT_EQ(spec.functions[0].values.size(), 2u);
  EXPECT_THAT(spec.functions[1].x, ElementsAre(0, 1));
  EXPECT_THAT(spec.functions[1].y, ElementsAre(0, 2));
  EXPECT_EQ(spec.functions[1].interpolation, "cubic");

  ASSERT_EQ(spec.forces.size(), 1u);
  EXPECT_EQ(spec.forces[0].kind, records::ForceKind::Force);
  EXPECT_EQ(spec.forces[0].frame, records::VectorFrame::Inertial);
  EXPECT_EQ(spec.forces[0].direction, Vector3d::UnitX());
  EXPECT_EQ(spec.forces[0].function, "wave");

  ASSERT_EQ(spec.sensors.size(), 3u);
  EXPECT_EQ(spec.sensors[0].type, records::SensorType::Deflection);
  EXPECT_EQ(spec.sensors[0].frame, "body");
  EXPECT_EQ(spec.sensors[1].frame, "tower");
  EXPECT_EQ(spec.sensors[1].relative_to, "tower");
  EXPECT_EQ(spec.sensors[2].coordinate, 1);

  EXPECT_EQ(spec.simulation.duration, 10);
  EXPECT_EQ(spec.simulation.integrator, "bdf");
  EXPECT_EQ(spec.simulation.gravity, Vector3d(0, 0, -9.81));
  EXPECT_EQ(spec.simulation.relative_tolerance, 1e-8);
}

TEST(SystemFile, RotationIsAboutXThenNewYThenNewZ) {
  const TempFolder folder;
  std::string text = test::kGoodSystem;
  text.replace(text.find("[90.0, 0.0, 0.0]"), 16, "[90.0, 90.0, 0.0]");
  Diagnostics diagnostics;
  const auto spec = read_system_spec(folder.write("s.toml", text), diagnostics);
  // x -> (about the new y, which is z) ... Rx(90) Ry(90) x = Rx(90) (-z) = y.
  EXPECT_TRUE((spec.hinges[1].parent_rotation * Vector3d::UnitX()).isApprox(Vector3d::UnitY(), 1e-15));
}

TEST(SystemFile, DegreesOnlyTouchTheAnglesOfAHinge) {
  const TempFolder folder;
  std::string text = test::kGoodSystem;
  const auto from = text.find("type = \"fixed\"");
  text.replace(from, 14, "type = \"planar\"\nposition_deg = [1.0, 2.0, 180.0]\nnull_position_deg = [0, 0, 90]");
  Diagnostics diagnostics;
  const auto spec = read_system_spec(folder.write("s.toml", text), diagnostics);
  ASSERT_TRUE(diagnostics.items().empty()) << join(diagnostics);
  EXPECT_THAT(spec.hinges[0].position, ElementsAre(1, 2, testing::DoubleEq(kPi)));
  EXPECT_THAT(spec.hinges[0].null_position, ElementsAre(0, 0, testing::DoubleEq(kPi / 2)));
}

TEST(SystemFile, TableFromAFileNextToIt) {
  const TempFolder folder;
  folder.write("data/curve.csv", "time, force\n# from the rig\n0, 1.5\n0.5;2.5\n1.0\t3.5\r\n");
  std::string text = test::kGoodSystem;
  text.replace(text.find("x = [0.0, 1.0]\ny = [0.0, 2.0]"), 29, "file = \"data/curve.csv\"");
  const std::string path = folder.write("s.toml", text);
  Diagnostics diagnostics;
  const auto spec = read_system_spec(path, diagnostics);
  ASSERT_TRUE(diagnostics.items().empty()) << join(diagnostics);
  EXPECT_THAT(spec.functions[1].x, ElementsAre(0, 0.5, 1));
  EXPECT_THAT(spec.functions[1].y, ElementsAre(1.5, 2.5, 3.5));

  folder.write("data/curve.csv", "0, 1\n1, nan\n2, x\n3\n");
  Diagnostics bad;
  read_system_spec(path, bad);
  ASSERT_EQ(bad.num_errors(), 3) << join(bad);
  EXPECT_EQ(bad.items()[0].id, "toml.nan");
  EXPECT_EQ(bad.items()[0].where.line, 2);
  EXPECT_EQ(bad.items()[1].id, "toml.table-file");
  EXPECT_EQ(bad.items()[1].where.line, 3);
  EXPECT_EQ(bad.items()[2].where.line, 4);
  EXPECT_EQ(bad.items()[2].where.file, folder.at("data/curve.csv"));
}

template <class Read>
void check_bad_documents(const char* good, const std::vector<test::BadDocument>& cases, Read read) {
  const TempFolder folder;
  for (const auto& bad : cases) {
    const std::string text = test::make_document(good, bad);
    const std::string path = folder.write("bad.toml", text);
    Diagnostics diagnostics;
    read(path, diagnostics);
    EXPECT_EQ(diagnostics.num_errors(), 1) << bad.new_text << "\n" << join(diagnostics);
    if (diagnostics.num_errors() == 0) continue;
    const Diagnostic& d = diagnostics.items().front();
    EXPECT_EQ(d.id, bad.id) << join(diagnostics);
    EXPECT_THAT(format(d), HasSubstr(bad.words));
    EXPECT_EQ(d.where.file, path);
    // Something missing is reported where its table begins, the rest in the line of the key.
    const int changed = find_first_changed_line(good, text);
    const int added = static_cast<int>(std::count(bad.new_text.begin(), bad.new_text.end(), '\n'));
    if (bad.id.find("missing") == std::string::npos && bad.id != "toml.conflicting-keys") {
      EXPECT_LE(d.where.line, changed + added) << join(diagnostics);
      EXPECT_GE(d.where.line, changed - 20) << join(diagnostics);
    }
  }
}

TEST(SystemFile, EveryFaultHasItsError) {
  check_bad_documents(test::kGoodSystem, test::get_bad_systems(),
                      [](const auto& path, auto& diagnostics) { read_system_spec(path, diagnostics); });
}

TEST(BodyFile, EveryFaultHasItsError) {
  check_bad_documents(test::kGoodBody, test::get_bad_bodies(),
                      [](const auto& path, auto& diagnostics) { read_body_spec(path, diagnostics); });
}

TEST(SystemFile, LinesAreThoseOfTheKeys) {
  const TempFolder folder;
  const std::string path = folder.write("s.toml",
                                        "[[body]]\n"
                                        "name = \"a\"\n"
                                        "mass = \"x\"\n"      // 3
                                        "stifening = true\n"  // 4
                                        "[[hinge]]\n"
                                        "name = \"h\"\n"
                                        "type = \"revolut\"\n"  // 7
                                        "child = \"b\"\n"       // hinge of line 5
                                        "axis = [0, 0]\n"       // 9
                                        "[[connect]]\n"         // 10
                                        "from = \"m\"\n"
                                        "[simulation]\n"
                                        "duration = -1\n");  // 13
  Diagnostics diagnostics;
  read_system_spec(path, diagnostics);
  std::vector<std::pair<std::string, int>> found;
  for (const auto& d : diagnostics.items()) found.emplace_back(d.id, d.where.line);
  EXPECT_THAT(found, testing::UnorderedElementsAre(std::pair{"toml.wrong-type", 3}, std::pair{"toml.unknown-key", 4},
                                                   std::pair{"toml.bad-value", 7}, std::pair{"toml.unknown-name", 5},
                                                   std::pair{"toml.wrong-length", 9}, std::pair{"toml.missing-key", 10},
                                                   std::pair{"toml.out-of-range", 13}))
      << join(diagnostics);
}

TEST(SystemFile, FilesThatCannotBeReadAreReported) {
  const TempFolder folder;
  for (const std::string& path : {folder.at("none.toml"), folder.get_path()}) {
    Diagnostics diagnostics;
    read_system_spec(path, diagnostics);
    read_body_spec(path, diagnostics);
    ASSERT_EQ(diagnostics.num_errors(), 2);
    EXPECT_EQ(diagnostics.items()[0].id, "toml.cannot-open");
  }
  Diagnostics diagnostics;
  read_system_spec(folder.write("b.toml", test::kGoodBody), diagnostics);
  EXPECT_THAT(join(diagnostics), HasSubstr("[body] is for body files"));
  Diagnostics other;
  read_body_spec(folder.write("s.toml", test::kGoodSystem), other);
  EXPECT_THAT(join(other), HasSubstr("[[body]] is for system files"));
}

TEST(BodyFile, EveryKeyOfAGoodFileArrives) {
  using records::InertialLoad;
  const TempFolder folder;
  const std::string path = folder.write("boom.toml", test::kGoodBody);
  const auto spec = read_clean(path, "boom", [](const auto& p, Diagnostics& d) { return read_body_spec(p, d); });
  EXPECT_EQ(spec.deck, folder.at("decks/boom.bdf"));
  EXPECT_EQ(spec.subcase, 2);
  EXPECT_EQ(spec.frame, records::BodyFrame::Free);
  EXPECT_THAT(spec.interface_nodes, ElementsAre(1, 41));
  EXPECT_THAT(spec.support, ElementsAre(1));
  ASSERT_TRUE(spec.origin.has_value());
  EXPECT_EQ(*spec.origin, Vector3d(0, 1, 2));
  EXPECT_EQ(spec.mass, "lumped");
  EXPECT_EQ(spec.integrals, "consistent");
  EXPECT_THAT(spec.ignore_cards, ElementsAre("PLOTEL"));
  EXPECT_EQ(spec.num_modes, 6);
  EXPECT_EQ(spec.max_frequency_hz, 100.0);
  EXPECT_THAT(spec.select, ElementsAre(1, 2, 4));
  EXPECT_THAT(spec.inertial_loads, ElementsAre(InertialLoad::ax, InertialLoad::wz2));
  ASSERT_EQ(spec.loads.size(), 3u);
  EXPECT_EQ(spec.loads[2].temperature_set, 8);
  ASSERT_TRUE(spec.preload.has_value());
  EXPECT_EQ(spec.preload->subcase, 0);
  EXPECT_EQ(spec.preload->load_set, 5);
  EXPECT_EQ(spec.preload->temperature_set, 6);
  EXPECT_EQ(spec.preload->spin, Vector3d(0, 0.5, 2));
  EXPECT_EQ(spec.preload->at.line, 34);
  EXPECT_EQ(spec.loads[0].name, "tip");
  EXPECT_EQ(spec.loads[0].node, 41);
  EXPECT_THAT(spec.loads[0].directions, ElementsAre(1, 5));
  EXPECT_EQ(spec.loads[0].at.line, 21);
  EXPECT_EQ(spec.loads[1].load_set, 7);
  EXPECT_TRUE(spec.loads[1].directions.empty());
  EXPECT_THAT(spec.damping_ratios, ElementsAre(0.01, 0.02, 0.03));
  EXPECT_EQ(spec.output_file, folder.at("out/boom.h5"));
  EXPECT_THAT(spec.output_nodes, ElementsAre(1, 41));
  EXPECT_TRUE(spec.full);
}

TEST(BodyFile, SmallestFileHasTheDefaults) {
  const TempFolder folder;
  Diagnostics diagnostics;
  const auto spec = read_body_spec(
      folder.write("arm.toml",
                   "[body]\ndeck = \"a.bdf\"\n[body.modes]\nnumber = 3\n[[body.load]]\nname = \"t\"\nnode = 4\n"),
      diagnostics);
  ASSERT_TRUE(diagnostics.items().empty()) << join(diagnostics);
  EXPECT_EQ(spec.name, "arm");
  EXPECT_EQ(spec.frame, records::BodyFrame::Fixed);
  EXPECT_FALSE(spec.origin.has_value());
  EXPECT_EQ(spec.mass, "deck");
  EXPECT_EQ(spec.integrals, "exact");
  EXPECT_TRUE(spec.inertial_loads.empty() && spec.output_nodes.empty() && spec.output_file.empty());
  EXPECT_THAT(spec.loads[0].directions, ElementsAre(1, 2, 3));
}

TEST(BodyFile, PreloadBesideTheBody) {
  const TempFolder folder;
  Diagnostics diagnostics;
  const auto spec = read_body_spec(
      folder.write("arm.toml", "[body]\ndeck = \"a.bdf\"\n[body.modes]\nnumber = 3\n[preload]\nsubcase = 4\n"),
      diagnostics);
  ASSERT_TRUE(diagnostics.items().empty()) << join(diagnostics);
  ASSERT_TRUE(spec.preload.has_value());
  EXPECT_EQ(spec.preload->subcase, 4);
}

TEST(DetectKind, ByTheTablesEvenWhenTheSyntaxIsBroken) {
  const TempFolder folder;
  EXPECT_EQ(detect_kind(folder.write("a", test::kGoodSystem)), "system");
  EXPECT_EQ(detect_kind(folder.write("b", test::kGoodBody)), "body");
  EXPECT_EQ(detect_kind(folder.write("c", std::string(test::kGoodSystem) + "x = \n")), "system");
  EXPECT_EQ(detect_kind(folder.write("d", std::string(test::kGoodBody) + "x = \n")), "body");
  EXPECT_EQ(detect_kind(folder.write("e", "GRID,1\n")), "");
  EXPECT_EQ(detect_kind(folder.write("f", "a = 1\n")), "");
  EXPECT_EQ(detect_kind(folder.at("none")), "");
}

/// The schemas alone, in another program's validator, agree with Bough about every document above.
TEST(Schema, AnotherValidatorAgrees) {
  const TempFolder folder;
  folder.write("system/good/0.toml", test::kGoodSystem);
  folder.write("body/good/0.toml", test::kGoodBody);
  int number = 0;
  for (const auto& bad : test::get_bad_systems()) {
    if (bad.id == "toml.syntax") continue;
    folder.write(std::string("system/") + (bad.by_schema ? "bad/" : "good/") + std::to_string(++number) + ".toml",
                 test::make_document(test::kGoodSystem, bad));
  }
  for (const auto& bad : test::get_bad_bodies()) {
    folder.write(std::string("body/") + (bad.by_schema ? "bad/" : "good/") + std::to_string(++number) + ".toml",
                 test::make_document(test::kGoodBody, bad));
  }
  EXPECT_EQ(test::run_python(BOUGH_SOURCE_DIR "/tests/formats/toml/check_schema.py " BOUGH_SOURCE_DIR "/data/schema "
                                              "--cases " +
                             folder.get_path()),
            0);
}

}  // namespace
}  // namespace bough::toml_files
