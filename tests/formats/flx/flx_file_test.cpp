/// .FLX: special nodes, write -> read -> write, layouts, faults of files and of layouts.
#include "formats/flx/flx_file.hpp"

#include <gmock/gmock.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>

#include "base/diagnostic.hpp"
#include "tests/support/members.hpp"
#include "tests/support/paths.hpp"

namespace bough::flx {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// A body of n modes and two nodes with random numbers of every size.
records::FlexBody make_body(int n) {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> exponent(-120, 120);
  const auto random = [&](Eigen::Index rows, Eigen::Index cols) -> MatrixXd {
    return MatrixXd::NullaryExpr(rows, cols, [&] { return normal(generator) * std::pow(10.0, exponent(generator)); });
  };
  records::FlexBody body;
  body.name = "boom \"1\"";
  body.mass = 4.25;
  body.eigenvalue = random(n, 1);
  body.modal_mass = random(n, n);
  body.modal_stiffness = random(n, n);
  body.modal_damping = random(n, n);
  body.consistent.gamma0 = random(3, n);
  body.consistent.gamma1 = random(3, n);
  for (int j = 0; j < n; ++j) {
    body.consistent.gamma2.push_back(random(3, n));
    body.consistent.gamma3.emplace_back(random(3, 3));
    body.consistent.gamma4.emplace_back();
    for (int k = 0; k < n; ++k) body.consistent.gamma4.back().emplace_back(random(3, 3));
  }
  body.integrals_method = "consistent";
  body.node_id = {12, 5};
  body.node_xyz = random(2, 3);
  body.phi = {random(6, n), random(6, n)};
  return body;
}

std::string get_id(const std::function<void()>& action, int* line = nullptr) {
  try {
    action();
  } catch (const InputError& error) {
    if (line != nullptr) *line = error.items()[0].where.line;
    return error.items()[0].id;
  }
  return "no error";
}

class FlxFileTest : public testing::Test {
 protected:
  std::string write(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return path_;
  }
  void TearDown() override { std::filesystem::remove(path_); }
  std::string path_ = testing::TempDir() + "/bough-flx-" + std::to_string(getpid()) + ".FLX";
};

TEST_F(FlxFileTest, SpecialNodesComeAfterTheLastNode) {
  MakeOptions options;
  options.has_special_nodes = true;
  const auto file = make_flx(make_body(3), options);
  EXPECT_THAT(file.special_id, ElementsAre(13, 14, 15, 16));
  EXPECT_TRUE(file.special_gains[0].isZero(0));
  for (int j = 0; j < 3; ++j) {
    MatrixXd expected = MatrixXd::Zero(6, 3);
    expected(0, j) = 1;
    EXPECT_EQ(file.special_gains[static_cast<std::size_t>(j + 1)], expected);
  }
}

TEST_F(FlxFileTest, AlphaIsGamma0OverTheMass) {
  const auto body = make_body(2);
  EXPECT_EQ(make_flx(body, {}).alpha, body.consistent.gamma0 / 4.25);
}

TEST_F(FlxFileTest, WriteReadWriteIsIdentical) {
  for (int n : {0, 1, 4, 7}) {
    for (int modopt : {0, 1, 2}) {
      for (int digits : {2, 9, 15, 16, 17}) {
        MakeOptions options;
        options.modopt = modopt;
        options.has_special_nodes = modopt != 1;
        options.digits = digits;
        for (int j = 0; j < n; ++j) options.modes.push_back(2 * j + 3);
        const auto text = write_flx(make_flx(make_body(n), options), make_native_layout(digits));
        const auto back = read_flx(write(text));
        EXPECT_EQ(back.digits, digits);
        EXPECT_EQ(back.modes, options.modes);
        ASSERT_EQ(write_flx(back, make_native_layout(back.digits)), text) << n << " " << modopt << " " << digits;
      }
    }
  }
}

TEST_F(FlxFileTest, SeventeenDigitsKeepEveryBit) {
  MakeOptions options;
  options.has_special_nodes = true;
  const auto file = make_flx(make_body(5), options);
  const auto back = read_flx(write(write_flx(file, make_native_layout(17))));
  using records::MassIntegrals;
  test::expect_same_members(back, file, &FlxFile::name, &FlxFile::mass, &FlxFile::M, &FlxFile::K, &FlxFile::D,
                            &FlxFile::alpha, &FlxFile::node_id, &FlxFile::node_xyz, &FlxFile::gains,
                            &FlxFile::special_id, &FlxFile::special_gains);
  EXPECT_EQ(back.method, "consistent");
  test::expect_same_members(back.integrals, file.integrals, &MassIntegrals::gamma1, &MassIntegrals::gamma2,
                            &MassIntegrals::gamma3, &MassIntegrals::gamma4);
}

TEST_F(FlxFileTest, ModoptLeavesOutTheHigherOrders) {
  for (int modopt : {0, 1, 2}) {
    MakeOptions options;
    options.modopt = modopt;
    const auto text = write_flx(make_flx(make_body(2), options), make_native_layout(9));
    EXPECT_THAT(text, HasSubstr("\nALPHA"));
    EXPECT_THAT(text, HasSubstr("\nGAMMA1"));
    EXPECT_EQ(text.find("\nGAMMA2") != std::string::npos, modopt <= 1);
    EXPECT_EQ(text.find("\nGAMMA3") != std::string::npos, modopt <= 1);
    EXPECT_EQ(text.find("\nGAMMA4") != std::string::npos, modopt == 0);
  }
}

TEST_F(FlxFileTest, ASetThatTheBodyDoesNotHold) {
  MakeOptions options;
  options.method = "exact";
  EXPECT_EQ(get_id([&] { make_flx(make_body(2), options); }), "flx.no-integrals");
  auto body = make_body(2);
  body.mass = 0;
  EXPECT_EQ(get_id([&] { make_flx(body, {}); }), "flx.bad-value");
}

TEST_F(FlxFileTest, FaultsOfAFile) {
  MakeOptions options;
  options.has_special_nodes = true;
  const auto good = write_flx(make_flx(make_body(2), options), make_native_layout(9));
  const auto id_with = [&](const std::string& old, const std::string& by, int* line = nullptr) {
    auto text = good;
    const auto at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    text.replace(at, old.size(), by);
    write(text);
    return get_id([&] { read_flx(path_); }, line);
  };
  int line = 0;
  EXPECT_EQ(id_with("BODY", "BODY"), "no error");
  EXPECT_EQ(id_with("FLX 1.0", "PLY 1.0"), "flx.not-flx");
  EXPECT_EQ(id_with("FLX 1.0", "FLX 2.0"), "flx.version");
  EXPECT_EQ(id_with("MODOPT 0", "MODOPT 3", &line), "flx.bad-line");
  EXPECT_EQ(line, 4);
  EXPECT_EQ(id_with("\nGSTIF", "\nGSTIFF"), "flx.bad-line");
  EXPECT_EQ(id_with("NMODE 2", "NMODE 1"), "flx.bad-line");
  EXPECT_EQ(id_with("NMODE 2", "NMODE 3"), "flx.missing-block");
  EXPECT_EQ(id_with("NMODE 2", "NMODE 900000"), "flx.bad-line");
  EXPECT_EQ(id_with("NNODE 2", "NNODE x"), "flx.bad-line");
  EXPECT_EQ(id_with("\nALPHA    1", "\nALPHA    2"), "flx.missing-block");
  EXPECT_EQ(id_with("\nALPHA    1", "\nALPHA    1 7.0"), "flx.bad-line");
  EXPECT_EQ(id_with("\nPHI        5", "\nPHI        6"), "flx.bad-line");
  EXPECT_EQ(id_with("\nEND", "\n"), "flx.missing-block");
  for (std::size_t end = 0; end < good.size() - 1; end += 37) {
    write(good.substr(0, end));
    EXPECT_NE(get_id([&] { read_flx(path_); }), "no error") << end;
  }
  EXPECT_EQ(get_id([&] { read_flx("no-such.FLX"); }), "flx.cannot-read");
}

std::string write_by(const std::string& layout) {
  auto body = make_body(2);
  body.modal_mass << 1, 2, 3, 4;
  body.consistent.gamma0 << 1, 4, 2, 5, 3, 6;
  body.phi[0].setConstant(0.5);
  body.phi[1].setConstant(-0.25);
  MakeOptions options;
  options.body_id = 9;
  options.has_special_nodes = true;
  options.modes = {3, 8};
  return write_flx(make_flx(body, options), parse_layout(layout, "site.layout"));
}

TEST_F(FlxFileTest, LayoutChoosesOrderFormatAndColumns) {
  for (const auto& [layout, expected] : std::vector<std::pair<std::string, std::string>>{
           {"number 3F6.1\nblock mass\n", "   1.0   2.0\n   3.0   4.0\n"},
           {"number F6.1\nblock mass order=k,j record=none\n", "   1.0   3.0   2.0   4.0\n"},
           {"number 3F6.1\nblock mass record=none\n", "   1.0   2.0   3.0\n   4.0\n"},
           {"block mass triangle=upper number=%g\n", "1 2\n4\n"},
           {"block mass triangle=lower number=%g separator=\",\" record=none\n", "1,3,4\n"},
           {"block gamma0 number=%g label=\"G {mode}:\"\n", "G 3: 1 2 3\nG 8: 4 5 6\n"},
           {"block gamma0 a=2 number=%g record=none heading=\"y only\"\n", "y only\n2 5\n"},
           {"block modes integer=I5 record=none\n", "    3    8\n"},
           {"block node_id nodes=all integer=%d record=none\n", "12 5 13 14 15\n"},
           {"block phi nodes=special j=1 a=1 number=%g order=i label=\"{node}\" record=i\n", "13 0\n14 1\n15 0\n"},
       })
    EXPECT_EQ(write_by(layout), expected) << layout;
  EXPECT_EQ(write_by("number %g\nblock gains nodes=output per_line=4 label=\"{i} {j} {d}:\" continue=\"    \"\n")
                .substr(0, 40),
            "1 1 1: 0.5 0.5 0.5 0.5\n     0.5 0.5\n1 2 ");
}

TEST_F(FlxFileTest, LayoutLoopsAndTexts) {
  EXPECT_EQ(write_by("# a remark\ntext \"{body_id:I3} {{x}} {num_modes}\\n{mass:E12.4}\"\n"),
            "  9 {x} 2\n  0.4250E+01\n");
  EXPECT_EQ(write_by("number %g\nfor j\n  text \"mode {mode:I3}\"\n  block mass label=\"{j} {k}\" record=k\nend\n"),
            "mode   3\n1 1 1\n1 2 2\nmode   8\n2 1 3\n2 2 4\n");
  EXPECT_EQ(write_by("for i nodes=special\n text \"{node}\"\nend\n"), "13\n14\n15\n");
}

TEST_F(FlxFileTest, ExampleLayoutsArePlain) {
  MakeOptions options;
  options.has_special_nodes = true;
  auto body = make_body(3);
  body.modal_mass.setIdentity();
  const auto file = make_flx(body, options);
  const std::string data = std::string(BOUGH_SOURCE_DIR) + "/data/integrals/";
  EXPECT_THAT(write_flx(file, read_layout(data + "columns.layout")),
              StartsWith("    1    0    3    2    4  0.42500000E+01\n  0.10000000E+01  0.00000000E+00"));
  EXPECT_THAT(write_flx(file, read_layout(data + "diagonals.layout")),
              AllOf(StartsWith("body 1 \"boom \"1\"\" mass 4.25\nmass 1 1 1\nstiffness "),
                    ContainsRegex("\nphi [0-9]+ 1 [-+.e0-9]+, [-+.e0-9]+, [-+.e0-9]+\n")));
}

TEST_F(FlxFileTest, FaultsOfALayout) {
  const auto id_of = [](const std::string& text, int* line) {
    return get_id([&] { parse_layout(text, "site.layout"); }, line);
  };
  int line = 0;
  EXPECT_EQ(id_of("number 5E16.8\nblok mass\n", &line), "flx.layout-syntax");
  EXPECT_EQ(line, 2);
  for (const char* text : {"number x",
                           "number",
                           "number I5",
                           "integer",
                           "text hello world",
                           "text \"open",
                           "text \"{\"",
                           "for x",
                           "for j",
                           "for j\nfor j\nend\nend",
                           "end",
                           "block mass order=j",
                           "block mass order=j,k,a",
                           "block mass triangle=left",
                           "block mass nodes=all",
                           "block mass nonsense",
                           "block mass per_line=x",
                           "block mass record=a",
                           "block phi j=0",
                           "for j nodes=all\nend",
                           "text \"{name:I5}\"",
                           "block mass number=%s",
                           "block node_id nodes=none"})
    EXPECT_EQ(id_of(text, &line), "flx.layout-syntax") << text;
  for (const char* text : {"block mas", "block", "text \"{bodyid}\"", "text \"{j}\"", "block mass label=\"{node}\""})
    EXPECT_EQ(id_of(text, &line), "flx.layout-name") << text;
  EXPECT_EQ(get_id([] { write_by("block mass number=F3.2\n"); }), "flx.number-too-wide");
  EXPECT_EQ(get_id([&] { write_by("number %g\nblock phi j=3\n"); }, &line), "flx.layout-index");
  EXPECT_EQ(line, 2);
  EXPECT_EQ(get_id([] { read_layout("no-such.layout"); }), "flx.cannot-read");
}

TEST_F(FlxFileTest, ANumberThatIsNoneIsNotWritten) {
  auto body = make_body(1);
  body.modal_mass(0, 0) = std::nan("");
  EXPECT_EQ(get_id([&] { write_flx(make_flx(body, {}), make_native_layout(9)); }), "flx.not-finite");
}

}  // namespace
}  // namespace bough::flx
