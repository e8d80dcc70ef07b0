#include "analysis/modes/complex_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "analysis/common/inputs.hpp"
#include "analysis/common/solution.hpp"
#include "analysis/listing/listing.hpp"
#include "analysis/modes/rotor_speeds.hpp"
#include "base/phase.hpp"
#include "fe/statics/build_model.hpp"
#include "modal/complex/complex_modes.hpp"

namespace bough::analysis {
namespace {

/// Vector of the listing with the shape of one mode in displacement (CD) axes; none if the case control does not
/// request it.
std::optional<records::ListedVector> list_shape(const fe::Model& model, const records::DynamicSubcase& subcase,
                                                const records::ComplexModesResult& r, Eigen::Index j) {
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
      vector.real(row, c) = vector.is_phase ? std::abs(z) : z.real();
      vector.imag(row, c) = vector.is_phase ? calc_phase_degrees(z, kListedPhase) : z.imag();
    }
  }
  return vector;
}

void add_to_listing(const fe::Model& model, const records::DynamicSubcase& subcase,
                    const records::ComplexModesResult& r, std::vector<listing::ListedComplexModes>& all) {
  listing::ListedComplexModes modes{
      std::max(r.subcase, 1), subcase.title, subcase.subtitle, subcase.label, r.eigenvalue, r.damping, {}};
  for (Eigen::Index j = 0; j < r.eigenvalue.size(); ++j)
    if (auto vector = list_shape(model, subcase, r, j); vector && vector->is_printed)
      modes.shapes.push_back(std::move(*vector));
  all.push_back(std::move(modes));
}

/// Synchronous modes in a range of speeds [1/T] that resonate.
void add_critical_speeds(double low, double high, records::ComplexModesResult& result) {
  for (Eigen::Index j = 0; j < result.eigenvalue.size(); ++j) {
    const double speed = result.eigenvalue(j).imag();
    if (is_resonant(result.eigenvalue(j)) && speed >= low && speed <= high)
      result.rotors->critical.push_back(
          {static_cast<int>(j), speed, result.frequency_hz(j), result.whirl.size() > 0 ? result.whirl(j) : 0});
  }
}

}  // namespace

void refuse_complex_option(bool is_given, const char* option) {
  if (is_given)
    throw InputError("cli.complex-option", {},
                     std::string(option) + " is given with a deck that requests complex eigenvalues",
                     "leave the option out, or --ignore CMETHOD for the real modes");
}

ModesAnswer solve_complex_modes(const ModesRequest& request, ModesReceiver& receiver, Events& events) {
  refuse_complex_option(request.energies, "--ese");
  refuse_complex_option(request.about_grid != 0, "--meffmass");
  Diagnostics diagnostics;
  auto model_options = make_model_options(request.model);
  const auto deck = read_loads_deck_or_throw(request.deck, model_options, false, diagnostics, true);
  const auto subcases =
      request.model.subcase != 0 ? std::vector<int>{request.model.subcase} : modal::complex_modes::list_subcases(deck);
  receiver.begin(subcases.size(), true);
  const auto sources = calc_sources(deck.files);
  modal::complex_modes::ComplexModesOptions solver;
  solver.is_by_modes = has_modal_complex_modes(deck.sol);
  // In SOL 110 the number of real modes is that of EIGRL.
  solver.num_modes = request.eigen.number;
  solver.has_shapes = true;
  solver.choose_eigen = [&](const records::DynamicSubcase& subcase, Diagnostics& own) {
    auto of_real = request.eigen;
    of_real.number = 0;
    return choose_eigen_options(of_real, deck, subcase.method, own);
  };
  ModesAnswer answer{SubcaseFailures(subcases.size(), deck.subcases.size()), {}, {}};
  bool has_modes = false;
  for (const int id : subcases) {
    Diagnostics own;
    records::ComplexModesResult result;
    records::DynamicSubcase subcase;
    try {
      model_options.subcase = id;
      const auto found =
          std::find_if(deck.subcases.begin(), deck.subcases.end(), [id](const auto& s) { return s.id == id; });
      const auto& control = found == deck.subcases.end() ? deck.subcases.front() : *found;
      const auto selection = deck.selections.find(control.id);
      subcase = {control, selection == deck.selections.end() ? records::DynamicSelection{} : selection->second};
      model_options.prestress =
          modal::rotors::has_own_stress(deck, subcase) ? nullptr : calc_prestress(deck, model_options, own);
      events.show_progress(fmt::format("subcase {}", id));
      const modal::complex_modes::ComplexModesSolver modes(deck, model_options, subcase, solver, own);
      std::optional<double> speed;
      const auto* rotors = modes.rotor_case();
      if (rotors != nullptr && !rotors->is_synchronous)
        speed = rotors->shapes_at >= 0 ? rotors->shapes_at : rotors->speeds.back();
      result = modes.solve(speed, own);
      result.speed = speed.value_or(-1);
      if (rotors != nullptr) {
        result.rotors = calc_rotor_speeds(modes, request.deck, events, own);
        if (rotors->is_synchronous) add_critical_speeds(rotors->low, rotors->high, result);
      }
    } catch (const Failure& failure) {
      events.show_progress("");
      answer.failures.add(id, failure);
      add_warnings(own, diagnostics);
      continue;
    }
    events.show_progress("");
    result.source = sources;
    if (request.has_listing) {
      Diagnostics of_model;  // reported by the solver
      add_to_listing(fe::build_model(deck, model_options, of_model), subcase, result, answer.complex_listing);
    }
    receiver.take(result, own);
    add_new(own, diagnostics);
    has_modes = true;
  }
  if (!has_modes) answer.failures.throw_all(diagnostics);
  add_messages(diagnostics, events);
  return answer;
}

}  // namespace bough::analysis
