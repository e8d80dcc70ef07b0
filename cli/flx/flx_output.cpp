#include "cli/flx/flx_output.hpp"
#include "cli/common/number_checks.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "analysis/common/inputs.hpp"
#include "formats/records/mode_kind.hpp"

namespace bough::cli {

namespace {

using nlohmann::json;

template <class Matrix>
json to_rows(const Matrix& m) {
  json rows = json::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    json row = json::array();
    for (Eigen::Index j = 0; j < m.cols(); ++j) row.push_back(m(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

/// p x 6 x n, as /modes/phi.
json to_gains(const std::vector<Eigen::MatrixXd>& gains) {
  json list = json::array();
  for (const auto& block : gains) list.push_back(to_rows(block));
  return list;
}

}  // namespace

void add_flx_options(CLI::App& verb, FlxOptions& options) {
  auto* digits = verb.add_option("--digits", options.digits, "Significant digits of each number, 2 to 17")
                     ->check(is_within(2, 17))
                     ->capture_default_str();
  verb.add_option("--layout", options.layout, "Write by this template instead of Bough's own layout")->excludes(digits);
}

flx::Layout choose_layout(const FlxOptions& options, int digits) {
  if (options.layout.empty()) return flx::make_native_layout(digits);
  analysis::demand_file(options.layout);
  return flx::read_layout(options.layout);
}

namespace {

/// Adds the data of the extension.
void add_extension(const flx::FlxFile& file, json& out) {
  const auto& more = file.more;
  if (file.has_rigid) {
    out["cg"] = std::vector<double>(more.cg.begin(), more.cg.end());
    out["inertia"] = to_rows(more.inertia);
    out["frame"] = more.is_free_free ? "free" : "fixed";
    out["kind"] = json::array();
    for (const auto kind : more.kind) out["kind"].push_back(records::get_name(kind));
  }
  if (!file.has_stiffening) return;
  out["interface"] = more.interface_nodes;
  out["kg_inertial"] = to_gains({more.kg_inertial.begin(), more.kg_inertial.end()});
  out["kg_inertial_computed"] = more.kg_inertial_computed;
  out["locators"] = json::array();
  for (const auto& locator : more.locators)
    out["locators"].push_back({{"name", locator.name}, {"node", locator.node}, {"direction", locator.direction}});
  out["kg_external"] = to_gains(more.kg_external);
  out["external_load"] = to_rows(more.external_load);
  if (more.load_resultant.size() > 0) {
    out["load_resultant"] = to_rows(more.load_resultant);
    out["load_moment"] = to_gains(more.load_moment);
  }
  if (more.preload.empty()) return;
  out["preload"] = more.preload;
  out["kg_preload"] = to_rows(more.kg_preload);
  out["preload_factors"] = std::vector<double>(more.preload_A_I.begin(), more.preload_A_I.end());
}

json make_json(const flx::FlxFile& file) {
  const auto& g = file.integrals;
  json out{{"body_id", file.body_id},
           {"name", file.name},
           {"modopt", file.modopt},
           {"method", file.method},
           {"digits", file.digits},
           {"mass", file.mass},
           {"modes", file.modes},
           {"generalized_mass", to_rows(file.M)},
           {"generalized_stiffness", to_rows(file.K)},
           {"generalized_damping", to_rows(file.D)},
           {"alpha", to_rows(file.alpha.transpose())},
           {"gamma0", to_rows(g.gamma0.transpose())},
           {"gamma1", to_rows(g.gamma1.transpose())},
           {"nodes", {{"id", file.node_id}, {"xyz", to_rows(file.node_xyz)}}},
           {"gains", to_gains(file.gains)},
           {"special_nodes", {{"id", file.special_id}, {"gains", to_gains(file.special_gains)}}}};
  if (file.has_gamma23()) {
    out["gamma2"] = json::array();
    out["gamma3"] = json::array();
    for (const auto& block : g.gamma2) out["gamma2"].push_back(to_rows(block.transpose()));
    for (const auto& block : g.gamma3) out["gamma3"].push_back(to_rows(block));
  }
  if (file.has_gamma4()) {
    out["gamma4"] = json::array();
    for (const auto& row : g.gamma4) {
      json blocks = json::array();
      for (const auto& block : row) blocks.push_back(to_rows(block));
      out["gamma4"].push_back(std::move(blocks));
    }
  }
  add_extension(file, out);
  return out;
}

}  // namespace

std::string format_flx_json(const std::vector<flx::FlxFile>& files) {
  if (files.size() == 1) return make_json(files.front()).dump(2) + "\n";
  json bodies = json::array();
  for (const auto& file : files) bodies.push_back(make_json(file));
  return json{{"bodies", bodies}}.dump(2) + "\n";
}

std::string format_flx_text(const flx::FlxFile& file) {
  // The layout language prints the data of Bough's extension lines under full names.
  static constexpr const char* kText = R"(number %14.6E
integer %8d
text "body id: {body_id}\nname: {name}\nmodal integral option: {modopt}\nintegrals: {method}\nmass: {mass:%.9g}"
text "modes: {num_modes}, output nodes: {num_nodes}, special nodes: {num_special}"
block modes record=none per_line=10 heading="mode numbers in the source:"
block mass per_line=6 heading="generalized mass:" label="{j:%4d}" continue="    "
block stiffness per_line=6 heading="generalized stiffness:" label="{j:%4d}" continue="    "
block damping per_line=6 heading="generalized damping:" label="{j:%4d}" continue="    "
block alpha heading="alpha = gamma0 / mass: mode, x y z" label="{j:%4d}"
block gamma0 heading="gamma0: mode, x y z" label="{j:%4d}"
block gamma1 heading="gamma1: mode, x y z" label="{j:%4d}"
block gamma2 heading="gamma2: mode, mode, x y z" label="{j:%4d}{k:%4d}"
block gamma3 heading="gamma3: mode, row, x y z" label="{j:%4d}{a:%4d}"
block gamma4 heading="gamma4: mode, mode, row, x y z" label="{j:%4d}{k:%4d}{a:%4d}"
block node_xyz nodes=output heading="output nodes: id, x y z" label="{node:%8d}"
block gains nodes=output heading="gains: node, mode, translations, rotations" label="{node:%8d}{j:%4d}"
block gains nodes=special heading="special nodes: node, mode, translations, rotations" label="{node:%8d}{j:%4d}"
when rigid
block cg heading="mass centre:"
block inertia heading="inertia about the origin:"
text "frame: {frame}"
end
when stiffening
text "locators: {num_locators}, interface nodes: {interface}"
for e
text "locator {e:%4d}: node {locator_node} direction {locator_direction}, {locator}"
end
block kg_inertial per_line=6 heading="K_G1: inertial load, mode" label="{l:%4d}{j:%4d}" continue="        "
block kg_external per_line=6 heading="K_G2: locator, mode" label="{e:%4d}{j:%4d}" continue="        "
end
when preload
text "preload, part of the stiffness: {preload}"
end
)";
  return flx::write_flx(file, flx::parse_layout(kText, "text of flx --read"));
}

}  // namespace bough::cli
