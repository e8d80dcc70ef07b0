#include "analysis/common/body_files.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/compare/compare.hpp"

namespace bough::analysis {

namespace {

using Eigen::Index;
using records::Comparison;

void add_arrays(const SingleReport& r, Comparison& file) {
  file.arrays.push_back({"/frequency_hz", r.frequency_hz, "natural frequency", "1/T"});
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

void add_arrays(const TestReport& r, Comparison& file) {
  MatrixXd pairs(static_cast<Index>(r.pairs.size()), 6), dofs(static_cast<Index>(r.dofs.size()), 2);
  for (std::size_t i = 0; i < r.pairs.size(); ++i) {
    const auto& p = r.pairs[i];
    pairs.row(static_cast<Index>(i)) << p.a + 1, p.b + 1, r.a.frequency_hz[p.a], r.b.frequency_hz[p.b], p.mac,
        r.cross_orthogonality(p.a, p.b);
  }
  for (std::size_t k = 0; k < r.dofs.size(); ++k)
    dofs.row(static_cast<Index>(k)) << r.a.node_id[static_cast<std::size_t>(r.dofs[k].a)], r.dofs[k].component + 1;
  file.arrays.push_back({"/mac", r.mac, "modal assurance criterion at the measured dofs, analysis by test", "1"});
  file.arrays.push_back(
      {"/pairs", pairs, "mode of the analysis, of the test (from 1), their Hz, MAC, cross-orthogonality", ""});
  file.arrays.push_back({"/dofs", dofs, "measured: node of the analysis, component 1..6", "1"});
  file.arrays.push_back({"/mass", r.mass, "mass matrix of the test-analysis model", "M, M L, M L^2"});
  file.arrays.push_back({"/cross_orthogonality", r.cross_orthogonality, "analysis by test, shapes of unit mass", "1"});
  file.arrays.push_back({"/self_orthogonality", r.self_orthogonality, "test by test", "1"});
  file.arrays.push_back({"/comac", r.comac, "of each measured dof over the pairs", "1"});
  file.arrays.push_back({"/collinearity", r.collinearity, "modal phase collinearity of each test mode", "1"});
  file.arrays.push_back({"/test/frequency_hz", r.b.frequency_hz, "of each test mode", "1/T"});
  file.arrays.push_back({"/test/damping", r.damping, "viscous damping ratio of each test mode", "1"});
  if (r.model_hz.size() > 0)
    file.arrays.push_back({"/model_frequency_hz", r.model_hz, "of the test-analysis model", "1/T"});
  file.words.emplace_back("/test_analysis_model", std::vector<std::string>{r.kind});
}

void add_arrays(const SensorReport& r, Comparison& file) {
  MatrixXd dofs(static_cast<Index>(r.dofs.size()), 2);
  for (std::size_t k = 0; k < r.dofs.size(); ++k) dofs.row(static_cast<Index>(k)) << r.dofs[k].first, r.dofs[k].second;
  file.arrays.push_back({"/dofs", dofs, "of the sensors: node, component 1..3", "1"});
  file.arrays.push_back({"/independence", r.independence, "effective independence of each", "1"});
  file.arrays.push_back({"/mac", r.mac, "of the modes with themselves at these dofs", "1"});
}

void add_arrays(const FrfReport& r, Comparison& file) {
  MatrixXd values(static_cast<Index>(r.pairs.size()), 5);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < r.pairs.size(); ++i) {
    const auto& p = r.pairs[i];
    values.row(static_cast<Index>(i)) << p.frac, p.level_db, p.peak_hz, p.test_peak_hz, p.num_points;
    names.push_back(p.name);
  }
  file.arrays.push_back(
      {"/functions/values", values, "FRAC, level of the curve over the function in dB, Hz of both peaks, points", ""});
  file.arrays.push_back({"/functions/frac", Eigen::VectorXd::Constant(1, r.frac), "FRAC of all functions", "1"});
  file.words.emplace_back("/functions/curve", names);
}

}  // namespace

records::Comparison make_comparison(const CompareRequest& request, const CompareAnswer& answer) {
  Comparison file;
  std::vector<std::string> files;
  for (const auto& name : request.files) files.push_back(get_body_path(name));
  for (const auto& name : {request.test, request.deck})
    if (!name.empty()) files.push_back(name);
  file.source = calc_sources(files);
  std::visit([&](const auto& report) { add_arrays(report, file); }, answer);
  return file;
}

}  // namespace bough::analysis
