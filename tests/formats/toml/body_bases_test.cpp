// Bases, frames and damping in a body file.
#include <gtest/gtest.h>

#include "formats/toml/specs.hpp"

namespace bough {
namespace {

using records::BodyBasis;
using records::BodyFrame;

const std::string kBody = R"([body]
deck = "boom.bdf"
frame = "mass-centre"
frame_nodes = [3]
origin = "mass-centre"
interface = [1, 41]

[body.modes]
basis = "craig-bampton"
number = 4
select = [7, 2]
orthogonalize = true
residual = ["inertial", "push"]

[[body.load]]
name = "push"
node = 7

[body.damping]
table = [[0.0, 50], [20.0, 25.0]]
table_kind = "quality"
rayleigh = [0.1, 1e-4]
structural = 0.02
material = true
residual_ratio = 0.5
)";

records::BodySpec read(const std::string& text, Diagnostics& diagnostics) {
  return toml_files::read_body_spec_text(text, "boom.toml", diagnostics);
}

std::string replace(const std::string& what, const std::string& with) {
  std::string text = kBody;
  return text.replace(text.find(what), what.size(), with);
}

TEST(BodyBases, EveryKeyIsRead) {
  Diagnostics diagnostics;
  const auto spec = read(kBody, diagnostics);
  EXPECT_TRUE(diagnostics.items().empty()) << diagnostics.items().front().what;
  EXPECT_EQ(spec.frame, BodyFrame::MassCentre);
  EXPECT_EQ(spec.frame_nodes, std::vector<int>{3});
  EXPECT_TRUE(spec.origin_at_mass_centre);
  EXPECT_EQ(spec.basis, BodyBasis::CraigBampton);
  EXPECT_TRUE(spec.orthogonalize);
  EXPECT_EQ(spec.select, (std::vector<int>{7, 2}));  // beyond number: constraint modes count too
  EXPECT_EQ(spec.residual, (std::vector<std::string>{"inertial", "push"}));
  EXPECT_EQ(spec.damping_table.points, (std::vector<std::pair<double, double>>{{0, 50}, {20, 25}}));
  EXPECT_EQ(spec.damping_table.kind, "quality");
  EXPECT_EQ(spec.rayleigh_alpha, 0.1);
  EXPECT_EQ(spec.rayleigh_beta, 1e-4);
  EXPECT_EQ(spec.structural_damping, 0.02);
  EXPECT_TRUE(spec.has_material_damping);
  EXPECT_EQ(spec.residual_damping, 0.5);
}

TEST(BodyBases, OriginAndFrames) {
  Diagnostics diagnostics;
  EXPECT_EQ(read(replace("\"mass-centre\"\ninterface", "41\ninterface"), diagnostics).origin_node, 41);
  EXPECT_EQ(read(replace("\"mass-centre\"\ninterface", "[1, 2, 3]\ninterface"), diagnostics).origin->y(), 2);
  EXPECT_EQ(read(replace("\"mass-centre\"\nframe", "\"3-2-1\"\nframe"), diagnostics).frame, BodyFrame::ThreeNodes);
  EXPECT_EQ(read(replace("\"mass-centre\"\nframe", "\"node\"\nframe"), diagnostics).frame, BodyFrame::Node);
  EXPECT_EQ(read(replace("\"mass-centre\"\nframe", "\"mean\"\nframe"), diagnostics).frame, BodyFrame::MeanAxes);
  EXPECT_EQ(read(replace("craig-bampton", "craig-chang"), diagnostics).basis, BodyBasis::CraigChang);
  EXPECT_TRUE(diagnostics.items().empty());
}

TEST(BodyBases, Errors) {
  const auto get_error = [](const std::string& what, const std::string& with) {
    Diagnostics diagnostics;
    read(replace(what, with), diagnostics);
    return diagnostics.items().empty() ? std::string() : diagnostics.items().front().id;
  };
  EXPECT_EQ(get_error("\"mass-centre\"\ninterface", "\"tip\"\ninterface"), "toml.bad-value");
  EXPECT_EQ(get_error("craig-bampton", "craig-bamton"), "toml.bad-value");
  EXPECT_EQ(get_error("[20.0, 25.0]", "[20.0]"), "toml.wrong-length");
  EXPECT_EQ(get_error("structural = 0.02", "ratio = 0.02"), "toml.conflicting-keys");
  EXPECT_EQ(get_error("[0.1, 1e-4]", "[0.1]"), "toml.wrong-length");
}

}  // namespace
}  // namespace bough
