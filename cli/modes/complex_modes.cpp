#include "cli/modes/complex_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "analysis/common/inputs.hpp"
#include "analysis/common/model_choice.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/solution.hpp"
#include "analysis/common/subcase_failures.hpp"
#include "analysis/listing/listing.hpp"
#include "analysis/modes/eigen_choices.hpp"
#include "cli/common/deck_tables.hpp"
#include "cli/common/options.hpp"
#include "cli/common/text_file.hpp"
#include "cli/common/vtu_file.hpp"
#include "cli/modes/modes_tables.hpp"
#include "fe/statics/build_model.hpp"
#include "formats/hdf5/complex_modes_file.hpp"
#include "formats/listing/complex_f06.hpp"
#include "modal/complex/complex_modes.hpp"

namespace bough::cli {
namespace {

using records::ComplexModesResult;

bool is_by_modes(const std::string& sol) {
  static const std::array modal{"110", "29", "SEMCEIG", "MCEIG"};
  return std::find(modal.begin(), modal.end(), sol) != modal.end();
}

/// Options with results that only real modes have.
void demand_supported(const ModesOptions& options) {
  const auto demand = [](bool is_given, const char* option) {
    if (is_given)
      throw InputError("cli.complex-option", {},
                       std::string(option) + " is given with a deck that asks for complex eigenvalues",
                       "leave the option out, or --ignore CMETHOD for the real modes");
  };
  demand(!options.listing.op2.empty(), "--op2");
  demand(options.energies, "--ese");
  demand(options.about_grid != 0, "--meffmass");
  demand(!options.compare.empty(), "--compare");
}

/// Vector of the listing with the shape of one mode in displacement (CD) axes; none if the case control does not
/// request it.
std::optional<records::ListedVector> list_shape(const fe::Model& model, const records::DynamicSubcase& subcase,
                                                const ComplexModesResult& r, Eigen::Index j) {
  const auto& selection = subcase.dynamics;
  records::ListedVector vector;
  vector.kind = records::ListedKind::Eigenvector;
  const records::CaseSet* set = nullptr;
  if (!selection.outputs.empty()) {
    const auto request = selection.outputs.find("DISPLACEMENT");
    if (request == selection.outputs.end() || request->second.is_none) return std::nullopt;
    vector.is_phase = request->second.is_phase;
    vector.is_printed = request->second.is_printed;
    const auto found = selection.sets.find(request->second.set);
    if (!request->second.is_all && found != selection.sets.end()) set = &found->second;
  }
  struct Row {
    int id;
    bool is_scalar;
    Eigen::VectorXcd values;
  };
  std::vector<Row> rows;
  for (std::size_t k = 0; k < r.node_id.size(); ++k) {
    const auto& R = model.node(model.find_node(r.node_id[k])).R_basic_cd;
    Eigen::VectorXcd values(6);
    values << R.transpose() * r.phi[k].col(j).head<3>(), R.transpose() * r.phi[k].col(j).tail<3>();
    rows.push_back({r.node_id[k], false, values});
  }
  for (std::size_t k = 0; k < r.point_id.size(); ++k) {
    Eigen::VectorXcd values = Eigen::VectorXcd::Zero(6);
    values(0) = r.point_phi(static_cast<Eigen::Index>(k), j);
    rows.push_back({r.point_id[k], true, values});
  }
  std::erase_if(rows, [&](const Row& row) { return set != nullptr && !set->contains(row.id); });
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
  vector.real.resize(static_cast<Eigen::Index>(rows.size()), 6);
  vector.imag = vector.real;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    vector.id.push_back(rows[k].id);
    vector.is_scalar.push_back(rows[k].is_scalar);
    for (Eigen::Index c = 0; c < 6; ++c) {
      const auto z = rows[k].values(c);
      const double degrees = std::arg(z) * 180 / std::numbers::pi;
      vector.real(row, c) = vector.is_phase ? std::abs(z) : z.real();
      vector.imag(row, c) = !vector.is_phase ? z.imag() : degrees < 0 ? degrees + 360 : degrees;
    }
  }
  return vector;
}

void add_to_listing(const fe::Model& model, const records::DynamicSubcase& subcase, const ComplexModesResult& r,
                    std::vector<listing::ListedComplexModes>& all) {
  listing::ListedComplexModes modes{
      std::max(r.subcase, 1), subcase.title, subcase.subtitle, subcase.label, r.eigenvalue, r.damping, {}};
  for (Eigen::Index j = 0; j < r.eigenvalue.size(); ++j)
    if (auto vector = list_shape(model, subcase, r, j); vector && vector->is_printed)
      modes.shapes.push_back(std::move(*vector));
  all.push_back(std::move(modes));
}

std::string format_text(const ComplexModesResult& r) {
  Table table{{"mode", "real", "imaginary", "Hz", "damping g", "ratio", "residual"}, {}};
  for (Eigen::Index j = 0; j < r.eigenvalue.size(); ++j)
    table.rows.push_back({std::to_string(j + 1), fmt::format("{:.8g}", r.eigenvalue(j).real()),
                          fmt::format("{:.8g}", r.eigenvalue(j).imag()), fmt::format("{:.7g}", r.frequency_hz(j)),
                          fmt::format("{:.6g}", r.damping(j)), fmt::format("{:.6g}", r.damping_ratio(j)),
                          fmt::format("{:.1e}", r.residual(j))});
  std::string text = "complex eigenvalues, imaginary part not below 0\n" + table.to_text() + "\n";
  const auto count_if = [&](const auto& is_one) {
    return std::count_if(r.eigenvalue.begin(), r.eigenvalue.end(), is_one);
  };
  // An undamped mode is unstable by round-off alone.
  const auto unstable = count_if([](std::complex<double> l) { return l.real() > 1e-9 * std::abs(l); });
  if (unstable > 0) text += fmt::format("unstable: {} of {} (real part above 0)\n", unstable, r.eigenvalue.size());
  text += fmt::format("method: {}, {} unknowns{}\n",
                      r.is_by_modes ? "on real modes (SOL 110)" : "on the full matrices (SOL 107)", r.num_unknowns,
                      r.left.empty() ? "" : ", unsymmetric");
  text += fmt::format("eigensolver: {} about {:.6g}{:+.6g}i, {} solutions with a factor of {:.3g} entries\n",
                      r.is_complete ? "Schur form, every eigenvalue," : "Krylov-Schur, the nearest", r.shift.real(),
                      r.shift.imag(), r.num_iterations, r.factor_entries);
  text +=
      fmt::format("shapes: {} (NORM = {})\n", r.norm == "MAX" ? "the largest component is 1" : "one dof is 1", r.norm);
  if (r.residual.size() > 0) text += fmt::format("largest residual: {:.1e}\n", r.residual.maxCoeff());
  if (r.biorthogonality >= 0) text += fmt::format("bi-orthogonality: {:.1e}\n", r.biorthogonality);
  return text;
}

nlohmann::json make_json(const ComplexModesResult& r) {
  auto modes = nlohmann::json::array();
  for (Eigen::Index j = 0; j < r.eigenvalue.size(); ++j)
    modes.push_back({{"mode", j + 1},
                     {"eigenvalue", {{"real", r.eigenvalue(j).real()}, {"imag", r.eigenvalue(j).imag()}}},
                     {"frequency_hz", r.frequency_hz(j)},
                     {"damping", r.damping(j)},
                     {"damping_ratio", r.damping_ratio(j)},
                     {"residual", r.residual(j)}});
  return {{"subcase", r.subcase},
          {"solution", r.is_by_modes ? "modal" : "direct"},
          {"method", r.method},
          {"norm", r.norm},
          {"symmetric", r.left.empty()},
          {"complete", r.is_complete},
          {"shift", {{"real", r.shift.real()}, {"imag", r.shift.imag()}}},
          {"biorthogonality", r.biorthogonality},
          {"modes", modes}};
}

}  // namespace

int run_complex_modes(const ModesOptions& options, const std::vector<int>& subcases, Console& console) {
  demand_supported(options);
  Diagnostics diagnostics;
  auto model_options = analysis::make_model_options(options.model);
  const auto deck = analysis::read_loads_deck_or_throw(options.deck, model_options, false, diagnostics, true);
  const auto sources = analysis::calc_sources(deck.files);
  modal::complex_modes::ComplexModesOptions solver;
  solver.is_by_modes = is_by_modes(deck.sol);
  // In SOL 110 the number of real modes is that of EIGRL.
  solver.num_modes = options.eigen.number;
  solver.has_shapes = true;
  solver.choose_eigen = [&](const records::DynamicSubcase& subcase, Diagnostics& own) {
    auto of_real = options.eigen;
    of_real.number = 0;
    return analysis::choose_eigen_options(of_real, deck, subcase.method, own);
  };
  analysis::SubcaseFailures failures(subcases.size(), deck.subcases.size());
  nlohmann::json json;
  std::vector<listing::ListedComplexModes> listed;
  std::string text, written;
  std::vector<std::pair<std::string, std::string>> pictures;
  bool is_first = true;
  for (const int id : subcases) {
    Diagnostics own;
    ComplexModesResult result;
    records::DynamicSubcase subcase;
    try {
      model_options.subcase = id;
      const auto found =
          std::find_if(deck.subcases.begin(), deck.subcases.end(), [id](const auto& s) { return s.id == id; });
      const auto& control = found == deck.subcases.end() ? deck.subcases.front() : *found;
      const auto selection = deck.selections.find(control.id);
      subcase = {control, selection == deck.selections.end() ? records::DynamicSelection{} : selection->second};
      model_options.prestress = analysis::calc_prestress(deck, model_options, own);
      console.show_progress(fmt::format("subcase {}", id));
      result = modal::complex_modes::solve_complex_modes(deck, model_options, subcase, solver, own);
    } catch (const Failure& failure) {
      console.end_progress();
      failures.add(id, failure);
      analysis::add_warnings(own, diagnostics);
      continue;
    }
    console.end_progress();
    result.source = sources;
    if (!options.listing.empty()) {
      Diagnostics heard;  // by the solver
      add_to_listing(fe::build_model(deck, model_options, heard), subcase, result, listed);
    }
    const auto vtu = name_output(options.vtu, result.subcase, is_first);
    if (!vtu.empty() && console.is_root())
      pictures.emplace_back(
          vtu, make_vtu_text(exports::make_picture(result), exports::VtuEncoding::Base64, options.deck, own));
    analysis::add_new(own, diagnostics);
    if (subcases.size() > 1) text += fmt::format("{}subcase {}\n\n", is_first ? "" : "\n", result.subcase);
    text += format_text(result);
    const auto one = make_json(result);
    if (is_first) json = one;
    if (subcases.size() > 1) json["subcases"].push_back(one);
    const auto output = name_output(options.output, result.subcase, is_first);
    is_first = false;
    if (output.empty()) continue;
    analysis::do_once([&] {
      check_outputs(options, {output, options.vtu, vtu == options.vtu ? "" : vtu}, {options.deck});
      hdf5::write_complex_modes(result, output);
    });
    written += "written: " + output + "\n";
  }
  if (is_first) failures.throw_all(diagnostics);
  if (!failures.is_empty()) json["failed"] = to_json(failures);
  console.print(diagnostics);
  console.print(failures.get_items(diagnostics));
  if (options.json)
    console.print_data(json.dump(2) + "\n");
  else
    console.print(text);
  analysis::do_once([&] {
    for (const auto& [path, picture] : pictures) write_text_file(path, picture);
    if (!options.listing.f06.empty()) write_text_file(options.listing.f06, listing::make_complex_f06(listed));
  });
  if (!options.listing.f06.empty()) written += "written: " + options.listing.f06 + "\n";
  for (const auto& [path, picture] : pictures) written += "written: " + path + "\n";
  if (!options.json) console.print(written);
  analysis::do_once([] { flush_data(); });
  return failures.get_exit_code();
}

}  // namespace bough::cli
