#include "cli/common/deck_tables.hpp"
#include "cli/compare/compare_report.hpp"

namespace bough::cli {

namespace {

using Eigen::Index;
using records::Comparison;

/// NaN becomes null.
nlohmann::json make_model_json(const std::string& file, const modal::ModalModel& m) {
  return {{"file", file},
          {"name", m.name},
          {"mass", m.mass},
          {"cg", to_json_list(m.cg)},
          {"num_nodes", m.node_id.size()},
          {m.is_buckling ? "load_factor" : "frequency_hz", to_json_list(m.frequency_hz)}};
}

nlohmann::json make_effective_json(const modal::ModalModel& m, int mode) {
  if (m.effective_mass.rows() == 0) return nullptr;
  return to_json_list(m.effective_mass.row(mode).transpose().eval());
}

}  // namespace

nlohmann::json make_json(const SingleReport& r) {
  nlohmann::json json{{"name", r.body.name},
                      {"frequency_hz", to_json_list(r.body.frequency_hz)},
                      {"method", r.body.integrals_method},
                      {"rigid", to_json(MatrixXd(r.check.captured[2].rigid))},
                      {"integrals", nlohmann::json::object()}};
  for (std::size_t m = 0; m < modal::kNumMethods; ++m)
    if (r.check.has[m])
      json["integrals"][modal::kMethodNames[m]] = {{"norm", to_json(r.check.norm[m])},
                                                   {"difference", to_json(r.check.difference[m])},
                                                   {"captured", to_json(r.check.captured[m].fraction)},
                                                   {"captured_total", to_json(MatrixXd(r.check.captured[m].total))}};
  return json;
}

void add_arrays(const SingleReport& r, Comparison& file) {
  file.arrays.push_back({"/frequency_hz", r.body.frequency_hz, "natural frequency", "1/T"});
  file.arrays.push_back({"/rigid", r.check.captured[2].rigid, "rigid mass matrix about Bo", "M, M L, M L^2"});
  for (std::size_t m = 0; m < modal::kNumMethods; ++m) {
    if (!r.check.has[m]) continue;
    const std::string group = std::string("/integrals/") + modal::kMethodNames[m] + "/";
    file.arrays.push_back({group + "norm", r.check.norm[m], "norms of gamma0 .. gamma4 by mode", ""});
    file.arrays.push_back({group + "difference", r.check.difference[m], "relative difference from the exact set", "1"});
    file.arrays.push_back({group + "captured", r.check.captured[m].fraction,
                           "share of m m m Jxx Jyy Jzz captured by the modes so far", "1"});
    file.arrays.push_back({group + "captured_total", r.check.captured[m].total,
                           "gamma M^-1 gamma' of all modes, translations first", "M, M L, M L^2"});
  }
}

nlohmann::json make_json(const PairReport& r) {
  auto pairs = nlohmann::json::array();
  for (const auto& p : r.pairs) {
    const double hz = r.a.frequency_hz[p.a], other = r.b.frequency_hz[p.b];
    nlohmann::json row{{"a", p.a + 1},
                       {"b", p.b + 1},
                       {"difference", hz != 0 ? nlohmann::json(other / hz - 1) : nlohmann::json()},
                       {"mac", p.mac},
                       {"in_span", p.in_span},
                       {"sign", p.sign},
                       {"effective_mass_a", make_effective_json(r.a, p.a)},
                       {"effective_mass_b", make_effective_json(r.b, p.b)}};
    if (r.mass_mac) row["mass_mac"] = (*r.mass_mac)(p.a, p.b);
    pairs.push_back(row);
  }
  nlohmann::json json{{"a", make_model_json(r.file_a, r.a)},
                      {"b", make_model_json(r.file_b, r.b)},
                      {"nodes",
                       {{"matched", r.match.pairs.size()},
                        {"by_id", r.match.by_id},
                        {"by_place", r.match.by_place},
                        {"offset", to_json_list(r.match.offset)}}},
                      {"mac", to_json(r.mac)},
                      {"pairs", pairs}};
  if (r.mass_mac) json["mass_mac"] = to_json(*r.mass_mac);
  if (!r.bodies) return json;
  json["integrals"] = nlohmann::json::object();
  for (std::size_t m = 0; m < modal::kNumMethods; ++m)
    if (r.bodies->has[m])
      json["integrals"][modal::kMethodNames[m]] = {{"norm_a", to_json(r.bodies->norm_a[m])},
                                                   {"norm_b", to_json(r.bodies->norm_b[m])},
                                                   {"difference", to_json(r.bodies->difference[m])}};
  for (const auto& d : r.bodies->energy)
    json["third_order_energy"].push_back(
        {{"degree", d.load}, {"norm_a", d.norm_a}, {"norm_b", d.norm_b}, {"difference", d.difference}});
  if (!r.bodies->energy_note.empty()) json["third_order_note"] = r.bodies->energy_note;
  json["stiffness"] = nlohmann::json::array();
  for (const auto& d : r.bodies->stiffness)
    json["stiffness"].push_back(
        {{"load", d.load}, {"norm_a", d.norm_a}, {"norm_b", d.norm_b}, {"difference", d.difference}});
  return json;
}

void add_arrays(const PairReport& r, Comparison& file) {
  MatrixXd pairs(static_cast<Index>(r.pairs.size()), 6);
  for (std::size_t i = 0; i < r.pairs.size(); ++i) {
    const auto& p = r.pairs[i];
    pairs.row(static_cast<Index>(i)) << p.a + 1, p.b + 1, r.a.frequency_hz[p.a], r.b.frequency_hz[p.b], p.mac,
        p.in_span;
  }
  file.arrays.push_back({"/mac", r.mac, "modal assurance criterion, modes of A by modes of B", "1"});
  if (r.mass_mac) file.arrays.push_back({"/mass_mac", *r.mass_mac, "the same, weighted with the mass matrix", "1"});
  file.arrays.push_back(
      {"/pairs", pairs, "mode of A, of B (from 1), their frequencies, MAC, share in the span of B", ""});
  MatrixXd nodes(static_cast<Index>(r.match.pairs.size()), 2);
  for (std::size_t k = 0; k < r.match.pairs.size(); ++k)
    nodes.row(static_cast<Index>(k)) << r.a.node_id[static_cast<std::size_t>(r.match.pairs[k].first)],
        r.b.node_id[static_cast<std::size_t>(r.match.pairs[k].second)];
  file.arrays.push_back({"/nodes", nodes, "ids of nodes in common, A and B", "1"});
  file.arrays.push_back({"/offset", r.match.offset, "place in B less place in A", "L"});
  if (!r.bodies) return;
  for (std::size_t m = 0; m < modal::kNumMethods; ++m)
    if (r.bodies->has[m])
      file.arrays.push_back({std::string("/integrals/") + modal::kMethodNames[m] + "/difference",
                             r.bodies->difference[m], "relative difference of gamma0 .. gamma4 by pair", "1"});
  MatrixXd stiffness(static_cast<Index>(r.bodies->stiffness.size()), 3);
  std::vector<std::string> loads;
  for (std::size_t i = 0; i < r.bodies->stiffness.size(); ++i) {
    const auto& d = r.bodies->stiffness[i];
    stiffness.row(static_cast<Index>(i)) << d.norm_a, d.norm_b, d.difference;
    loads.push_back(d.load);
  }
  file.arrays.push_back({"/stiffness/values", stiffness, "norm of K_G in A, in B, relative difference", ""});
  file.words.emplace_back("/stiffness/load", loads);
}

nlohmann::json make_json(const RefinementReport& r) {
  auto rows = nlohmann::json::array();
  for (const auto& row : r.rows)
    rows.push_back({{"mode", row.mode},
                    {"quantity", row.quantity},
                    {"value", row.value},
                    {"order", row.order},
                    {"extrapolated", row.extrapolated}});
  return {{"files", r.files}, {"element_size", r.element_size}, {"rows", rows}};
}

void add_arrays(const RefinementReport& r, Comparison& file) {
  MatrixXd values(static_cast<Index>(r.rows.size()), 6);
  std::vector<std::string> quantities;
  for (std::size_t i = 0; i < r.rows.size(); ++i) {
    const auto& row = r.rows[i];
    values.row(static_cast<Index>(i)) << row.mode, row.value[0], row.value[1], row.value[2], row.order,
        row.extrapolated;
    quantities.push_back(row.quantity);
  }
  file.arrays.push_back(
      {"/refinement/values", values, "mode, value on three meshes, observed order, extrapolated", ""});
  file.arrays.push_back({"/refinement/element_size",
                         Eigen::Vector3d(r.element_size[0], r.element_size[1], r.element_size[2]),
                         "mean length of element edges", "L"});
  file.words.emplace_back("/refinement/quantity", quantities);
}

}  // namespace bough::cli
