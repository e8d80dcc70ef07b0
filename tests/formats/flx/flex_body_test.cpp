/// .FLX as a body of a run: the extension of version 1.1, several bodies in one file, back to a flexible body.
#include <gmock/gmock.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <random>

#include "base/diagnostic.hpp"
#include "formats/flx/flx_file.hpp"
#include "formats/flx/fragment.hpp"
#include "tests/support/members.hpp"

namespace bough::flx {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// Everything that a .FLX of version 1.1 holds, with random numbers.
records::FlexBody make_stiffened_body(int n, unsigned seed = 3) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const auto random = [&](Eigen::Index rows, Eigen::Index cols) -> MatrixXd {
    return MatrixXd::NullaryExpr(rows, cols, [&] { return normal(generator); });
  };
  records::FlexBody body;
  body.name = "panel " + std::to_string(seed);
  body.mass = 3.7;
  body.cg = random(3, 1);
  body.inertia = random(3, 3);
  body.is_free_free = seed % 2 == 0;
  body.modal_mass = random(n, n) + 10 * MatrixXd::Identity(n, n);
  body.modal_stiffness = random(n, n) + 100 * MatrixXd::Identity(n, n);
  body.modal_damping = random(n, n);
  body.eigenvalue = body.modal_stiffness.diagonal().cwiseQuotient(body.modal_mass.diagonal());
  body.frequency_hz = body.eigenvalue.cwiseSqrt() / (2 * std::numbers::pi);
  body.kind.assign(static_cast<std::size_t>(n), records::ModeKind::Normal);
  if (n > 1) body.kind[1] = records::ModeKind::Residual;
  auto& g = body.exact;
  g.gamma0 = random(3, n);
  g.gamma1 = random(3, n);
  for (int j = 0; j < n; ++j) {
    g.gamma2.push_back(random(3, n));
    g.gamma3.emplace_back(random(3, 3));
    g.gamma4.emplace_back();
    for (int k = 0; k < n; ++k) g.gamma4.back().emplace_back(random(3, 3));
  }
  body.integrals_method = "exact";
  body.node_id = {12, 5};
  body.node_xyz = random(2, 3);
  body.phi = {random(6, n), random(6, n)};
  body.interface_nodes = {5};
  for (std::size_t l = 0; l < records::kNumInertialLoads; ++l) {
    body.kg_inertial_computed[l] = l % 3 != 1;
    body.kg_inertial[l] = body.kg_inertial_computed[l] ? random(n, n) : MatrixXd::Zero(n, n);
  }
  body.locators = {{"node5_x", 5, 1}, {"thrust of both", 0, 0}};
  body.kg_external = {random(n, n), random(n, n)};
  body.external_load = random(n, 2);
  body.load_resultant = random(6, 2);
  body.load_moment = {random(3, n), random(3, n)};
  body.preload = "spin (0, 0, 2)";
  body.kg_preload = random(n, n);
  body.preload_A_I = random(records::kNumInertialLoads, 1);
  return body;
}

std::vector<std::string> list_ids(const std::function<void()>& action) {
  std::vector<std::string> ids;
  try {
    action();
  } catch (const InputError& error) {
    for (const auto& item : error.items()) ids.push_back(item.id);
  }
  return ids;
}

void replace_first(std::string& text, const std::string& old, const std::string& by) {
  const auto at = text.find(old);
  ASSERT_NE(at, std::string::npos) << old;
  text.replace(at, old.size(), by);
}

class FlxBodyTest : public testing::Test {
 protected:
  std::string write(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return path_;
  }
  static std::string make_text(const records::FlexBody& body, int digits, int id = 1, int modopt = 0) {
    MakeOptions options;
    options.has_stiffening = true;
    options.digits = digits;
    options.body_id = id;
    options.modopt = modopt;
    return write_flx(make_flx(body, options), make_native_layout(digits));
  }
  void TearDown() override { std::filesystem::remove(path_); }
  std::string path_ = testing::TempDir() + "/bough-flx-body-" + std::to_string(getpid()) + ".FLX";
  std::vector<std::string> lacking_;
};

TEST_F(FlxBodyTest, SeventeenDigitsGiveTheBodyBack) {
  for (const int n : {0, 1, 4}) {
    const auto body = make_stiffened_body(n, n == 4 ? 2 : 3);
    const auto text = make_text(body, 17);
    EXPECT_THAT(text, testing::StartsWith("FLX 1.1 "));
    const auto back = make_flex_body(read_flx(write(text)), lacking_);
    using records::FlexBody;
    using records::MassIntegrals;
    test::expect_same_members(back, body, &FlexBody::name, &FlexBody::mass, &FlexBody::cg, &FlexBody::inertia,
                              &FlexBody::is_free_free, &FlexBody::modal_mass, &FlexBody::modal_stiffness,
                              &FlexBody::modal_damping, &FlexBody::eigenvalue, &FlexBody::frequency_hz, &FlexBody::kind,
                              &FlexBody::node_id, &FlexBody::node_xyz, &FlexBody::phi, &FlexBody::interface_nodes,
                              &FlexBody::kg_inertial, &FlexBody::kg_external, &FlexBody::external_load,
                              &FlexBody::load_resultant, &FlexBody::load_moment, &FlexBody::preload,
                              &FlexBody::kg_preload, &FlexBody::preload_A_I);
    EXPECT_EQ(back.integrals_method, "exact");
    test::expect_same_members(back.exact, body.exact, &MassIntegrals::gamma0, &MassIntegrals::gamma1,
                              &MassIntegrals::gamma2, &MassIntegrals::gamma3, &MassIntegrals::gamma4);
    EXPECT_EQ(back.kg_inertial_computed[0], n > 0);  // of no modes there is nothing to write
    ASSERT_EQ(back.locators.size(), 2U);
    EXPECT_EQ(back.locators[1].name, "thrust of both");
    EXPECT_EQ(back.locators[0].node, 5);
    EXPECT_EQ(back.locators[0].direction, 1);
  }
}

TEST_F(FlxBodyTest, WriteReadWriteIsIdentical) {
  for (const int digits : {2, 9, 17}) {
    const auto text = make_text(make_stiffened_body(4), digits);
    EXPECT_EQ(write_flx(read_flx(write(text)), make_native_layout(digits)), text) << digits;
  }
}

/// A reader of version 1.0 passes over every line that begins with "!": what is left is a file of version 1.0.
TEST_F(FlxBodyTest, TheExtensionIsRemarksToReadersOfVersionOne) {
  std::istringstream lines(make_text(make_stiffened_body(3), 9));
  std::string old, line;
  while (std::getline(lines, line))
    if (line[0] != '!') old += line + "\n";
  replace_first(old, "FLX 1.1", "FLX 1.0");
  const auto file = read_flx(write(old));
  EXPECT_FALSE(file.has_rigid);
  EXPECT_FALSE(file.has_stiffening);
  const auto body = make_flex_body(file, lacking_);
  EXPECT_THAT(lacking_, Contains(HasSubstr("geometric stiffness")));
  EXPECT_TRUE(body.exact.gamma0.isApprox(make_stiffened_body(3).exact.gamma0, 1e-8));
  EXPECT_EQ(body.kg_inertial_computed, (std::array<bool, 12>{}));
}

TEST_F(FlxBodyTest, EffectiveMassesComeFromTheIntegrals) {
  const auto body = make_stiffened_body(3);
  const auto back = make_flex_body(read_flx(write(make_text(body, 17))), lacking_);
  for (int j = 0; j < 3; ++j) {
    EXPECT_DOUBLE_EQ(back.effective_mass(j, 1), std::pow(body.exact.gamma0(1, j), 2) / body.modal_mass(j, j));
    EXPECT_DOUBLE_EQ(back.effective_mass(j, 5), std::pow(body.exact.gamma1(2, j), 2) / body.modal_mass(j, j));
  }
}

TEST_F(FlxBodyTest, IntegralsThatModoptLeavesOutAreZero) {
  const auto back = make_flex_body(read_flx(write(make_text(make_stiffened_body(2), 9, 1, 2))), lacking_);
  EXPECT_THAT(lacking_, Contains(HasSubstr("first and second order")));
  ASSERT_EQ(back.exact.gamma4.size(), 2U);
  EXPECT_TRUE(back.exact.gamma4[1][0].isZero(0));
  EXPECT_TRUE(back.exact.gamma3[1].isZero(0));
  EXPECT_EQ(back.exact.gamma2[1].cols(), 2);
}

TEST_F(FlxBodyTest, SeveralBodiesOfOneFile) {
  const auto both =
      make_text(make_stiffened_body(2, 3), 9, 4) + "\n! the other one\n" + make_text(make_stiffened_body(3, 8), 9, 7);
  const auto bodies = read_flx_bodies(write(both));
  ASSERT_EQ(bodies.size(), 2U);
  EXPECT_EQ(bodies[0].num_modes(), 2);
  EXPECT_EQ(read_flx(path_, 7).name, "panel 8");
  EXPECT_EQ(read_flx(path_, 7).num_modes(), 3);
  EXPECT_THAT(list_ids([&] { read_flx(path_); }), ElementsAre("flx.which-body"));
  EXPECT_THAT(list_ids([&] { read_flx(path_, 5); }), ElementsAre("flx.no-body"));
  // Lines count through the file.
  auto damaged = both;
  const auto second = damaged.rfind("\nGSTIF");
  damaged.replace(second, 6, "\nGSTIX");
  try {
    read_flx_bodies(write(damaged));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.items()[0].where.line,
              std::count(damaged.begin(), damaged.begin() + static_cast<long>(second), '\n') + 2);
  }
  write(make_text(make_stiffened_body(2), 9, 4) + make_text(make_stiffened_body(2), 9, 4));
  EXPECT_THAT(list_ids([&] { read_flx_bodies(path_); }), ElementsAre("flx.same-body"));
  write(make_text(make_stiffened_body(2), 9, 4) + "GMASS 1 1 2.0\n");
  EXPECT_THAT(list_ids([&] { read_flx_bodies(path_); }), ElementsAre("flx.bad-line"));
}

TEST_F(FlxBodyTest, FaultsOfTheExtension) {
  const auto good = make_text(make_stiffened_body(2), 9);
  const auto ids_with = [&](const std::string& old, const std::string& by) {
    auto text = good;
    replace_first(text, old, by);
    return list_ids([&] { read_flx(write(text)); });
  };
  EXPECT_THAT(ids_with("!+ CG", "!+ CGG"), Contains("flx.bad-line"));
  EXPECT_THAT(ids_with("\n!+ CG", "\n! CG"), ElementsAre("flx.missing-block"));
  EXPECT_THAT(ids_with("!+ INERTIA 2", "!+ INERTIA 4"), Contains("flx.bad-line"));
  EXPECT_THAT(ids_with("FRAME fixed", "FRAME loose"), Contains("flx.bad-line"));
  EXPECT_THAT(ids_with("residual", "spurious"), Contains("flx.bad-line"));
  EXPECT_THAT(ids_with("NLOCATOR 2", "NLOCATOR 3"), Contains("flx.missing-block"));
  EXPECT_THAT(ids_with("NLOCATOR 2", "NLOCATOR 999999"), Contains("flx.bad-line"));
  EXPECT_THAT(ids_with("INTERFACE 5", "INTERFACE 6"), Contains("flx.bad-line"));
  EXPECT_THAT(ids_with("5 1 node5_x", "6 1 node5_x"), Contains("flx.bad-line"));
  EXPECT_THAT(ids_with("!+ KG1  1    1    1", "!+ KG1 13    1    1"), Contains("flx.bad-line"));
  EXPECT_THAT(ids_with("!+ KG1  1    1    1", "!+ KG1  1    1    2"), Contains("flx.bad-line"));
  EXPECT_THAT(ids_with("\n!+ KG2", "\n! KG2"), ElementsAre("flx.missing-block"));
  EXPECT_THAT(ids_with("\n!+ FACTOR", "\n! FACTOR"), ElementsAre("flx.missing-block"));
  EXPECT_THAT(ids_with("\n!+ PRELOAD", "\n! PRELOAD"), Contains("flx.bad-line"));
  // A later version may add labels; a 1.0 has none at all.
  EXPECT_THAT(ids_with("!+ FRAME", "!+ COLOUR 3\n!+ FRAME"), ElementsAre("flx.bad-line"));
  auto later = good;
  replace_first(later, "FLX 1.1", "FLX 1.2");
  replace_first(later, "!+ FRAME", "!+ COLOUR 3\n!+ FRAME");
  EXPECT_THAT(list_ids([&] { read_flx(write(later)); }), ElementsAre());
  EXPECT_THAT(ids_with("FLX 1.1", "FLX 1.x"), ElementsAre("flx.version"));
}

TEST_F(FlxBodyTest, NamesOfFiles) {
  const auto show = [](const std::string& name) {
    const auto parsed = parse_flx_name(name);
    return parsed ? parsed->path + " " + std::to_string(parsed->body_id) : "no";
  };
  for (const auto& [name, expected] : std::vector<std::pair<std::string, std::string>>{
           {"a/boom.FLX", "a/boom.FLX 0"},
           {"boom.flx:12", "boom.flx 12"},
           {"boom.h5", "no"},
           {"boom.FLX:", "no"},
           {"boom.FLX:0", "no"},
           {"boom.FLX:1x", "no"},
           {".FLX", "no"},
       })
    EXPECT_EQ(show(name), expected) << name;
  // The content of a file goes before its name.
  const auto put = [](const std::string& name, const std::string& text) {
    const auto path = (std::filesystem::temp_directory_path() / name).string();
    std::ofstream(path) << text;
    return path;
  };
  const auto fln = put("bough-names.FLN", "FLX 1.1\n"), hdf5 = put("bough-names.FLX", "\x89HDF\r\n"),
             deck = put("bough-names.dat", "FLXA\n");
  EXPECT_EQ(show(fln), fln + " 0");
  EXPECT_EQ(show(fln + ":3"), fln + " 3");
  EXPECT_EQ(show(hdf5), "no");
  EXPECT_EQ(show(deck), "no");
  for (const auto& path : {fln, hdf5, deck}) std::filesystem::remove(path);
}

TEST_F(FlxBodyTest, ALayoutMayHoldTheGeometricStiffness) {
  const auto body = make_stiffened_body(2);
  MakeOptions options;
  options.has_stiffening = true;
  const std::string layout =
      "number %.3f\nwhen stiffening\nblock kg_inertial triangle=lower record=j label=\"KG {l} {j}:\"\nend\n"
      "for e\ntext \"{e} {locator} at {locator_node}, {locator_direction}\"\nblock external_load record=none\nend\n";
  const auto text = write_flx(make_flx(body, options), parse_layout(layout, "site"));
  char line[64];
  std::snprintf(line, sizeof line, "KG 3 2: %.3f %.3f\n", body.kg_inertial[2](1, 0), body.kg_inertial[2](1, 1));
  EXPECT_THAT(text, HasSubstr(line));
  EXPECT_THAT(text, Not(HasSubstr("KG 2 ")));  // was not computed
  std::snprintf(line, sizeof line, "1 node5_x at 5, 1\n%.3f %.3f\n", body.external_load(0, 0),
                body.external_load(1, 0));
  EXPECT_THAT(text, HasSubstr(line));
  EXPECT_EQ(write_flx(make_flx(body, {}), parse_layout(layout, "site")), "");
  EXPECT_THAT(list_ids([] { parse_layout("when moon\nend\n", "site"); }), ElementsAre("flx.layout-syntax"));
  EXPECT_THAT(list_ids([] { parse_layout("when rigid\n", "site"); }), ElementsAre("flx.layout-syntax"));
  EXPECT_THAT(list_ids([] { parse_layout("text \"{locator:I5}\"\n", "site"); }), ElementsAre("flx.layout-name"));
}

/// One more special node than modes, a jet at each, nine sensors at the first, all connected once.
TEST_F(FlxBodyTest, FragmentForTheSystemFileOfTreetops) {
  MakeOptions options;
  options.has_special_nodes = options.has_stiffening = true;
  std::vector<FlxFile> files{make_flx(make_stiffened_body(2), options)};
  options.body_id = 2;
  files.push_back(make_flx(make_stiffened_body(3), options));
  const auto text = make_fragment(files, 11);
  const auto count = [&](const std::string& word) {
    int found = 0;
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count("\nBODY "), 2);
  EXPECT_EQ(count("special: "), 3 + 4);
  EXPECT_EQ(count("\nACTUATOR "), 3 + 4);
  EXPECT_EQ(count("\nSENSOR "), 18);
  EXPECT_EQ(count("TO CONTROLLER 11 INPUT"), 9);
  EXPECT_EQ(count("\nCONNECT CONTROLLER 12 OUTPUT"), 4);
  EXPECT_THAT(text, HasSubstr("\nACTUATOR 11 JET BODY 1 NODE 13 AXIS 1 0 0"));
  EXPECT_THAT(text, HasSubstr("\nACTUATOR 14 JET BODY 2 NODE 13 AXIS 1 0 0"));
  EXPECT_THAT(text, HasSubstr("\nSENSOR 20 ACCELEROMETER BODY 2 NODE 13 AXIS 1 0 0"));
  EXPECT_THAT(text, HasSubstr("A2 = ay (not needed)"));
  options.has_special_nodes = false;
  EXPECT_THAT(list_ids([&] { make_fragment({make_flx(make_stiffened_body(2), options)}, 1); }),
              ElementsAre("flx.no-special-nodes"));
}

}  // namespace
}  // namespace bough::flx
