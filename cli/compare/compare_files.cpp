#include "cli/common/deck_tables.hpp"
#include "cli/common/json_rows.hpp"
#include "cli/compare/compare_report.hpp"

namespace bough::cli {

namespace {

using analysis::PairReport;
using analysis::RefinementReport;
using analysis::SingleReport;
using Eigen::MatrixXd;

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
  nlohmann::json json{{"name", r.name},
                      {"frequency_hz", to_json_list(r.frequency_hz)},
                      {"method", r.method},
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

nlohmann::json make_json(const RefinementReport& r) {
  using Row = modal::Convergence;
  const auto rows = make_rows(r.rows, "mode", &Row::mode, "quantity", &Row::quantity, "value", &Row::value, "order",
                              &Row::order, "extrapolated", &Row::extrapolated);
  return {{"files", r.files}, {"element_size", r.element_size}, {"rows", rows}};
}

}  // namespace bough::cli
