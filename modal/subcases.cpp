#include "modal/subcases.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "fe/loads/dead_loads.hpp"
#include "fe/matrices/system.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/preload.hpp"
#include "fe/statics/superelement_check.hpp"
#include "formats/records/load_name.hpp"

namespace bough::modal {

bool is_buckling_solution(const records::Deck& deck) {
  return deck.sol == "105" || deck.sol == "5" || deck.sol == "SEBUCKL" || deck.sol == "BUCKLING";
}

std::vector<int> list_mode_subcases(const records::Deck& deck) {
  static const std::set<std::string> with_modes{"", "103", "3", "SEMODES", "MODES"};
  if (with_modes.count(deck.sol) == 0) return {0};
  std::vector<int> chosen;
  std::set<std::array<int, 4>> seen;
  for (const auto& subcase : deck.subcases)
    if (subcase.id > 0 && subcase.method > 0 &&
        seen.insert({subcase.method, subcase.spc, subcase.mpc, subcase.preload}).second)
      chosen.push_back(subcase.id);
  return chosen.empty() ? std::vector<int>{0} : chosen;
}

std::vector<BucklingCases> list_buckling_cases(const records::Deck& deck, int requested) {
  const auto is_loaded = [](const records::Subcase& s) { return s.load != 0 || s.temperature != 0; };
  std::vector<records::Subcase> buckling;
  const auto collect = [&](const auto& belongs) {
    if (!buckling.empty()) return;
    std::copy_if(deck.subcases.begin(), deck.subcases.end(), std::back_inserter(buckling), belongs);
  };
  collect([](const auto& s) { return s.statsub != 0; });
  collect([&](const auto& s) { return s.method != 0 && !is_loaded(s); });
  collect([](const auto& s) { return s.method != 0; });
  if (buckling.empty()) buckling.emplace_back();
  std::vector<BucklingCases> cases;
  std::set<std::array<int, 5>> seen;
  for (const auto& b : buckling)
    for (const auto& s : deck.subcases) {
      if (!is_loaded(s) || (b.statsub != 0 && s.id != b.statsub)) continue;
      if (b.statsub == 0 && requested != 0 && b.id != requested && s.id != requested) continue;
      // With a preload alone the load to scale is another one, if there is another.
      const auto is_other = [&](const auto& other) { return is_loaded(other) && other.id != b.preload; };
      if (b.statsub == 0 && s.id == b.preload && std::any_of(deck.subcases.begin(), deck.subcases.end(), is_other))
        continue;
      const bool is_asked = requested == 0 || b.id == requested || s.id == requested;
      if (is_asked && seen.insert({s.id, b.method, b.spc, b.mpc, b.suport1}).second) cases.push_back({s, b});
      break;
    }
  const auto is_id = [requested](const auto& s) { return s.id == requested; };
  if (requested != 0 && std::none_of(deck.subcases.begin(), deck.subcases.end(), is_id)) {  // build_model() reports it
    cases.emplace_back();
    cases.back().statics.id = requested;
  }
  for (const auto& b : buckling) {
    const auto is_statsub = [&](const auto& s) { return s.id == b.statsub; };
    if (!cases.empty() || b.statsub == 0) continue;
    const bool is_there = std::any_of(deck.subcases.begin(), deck.subcases.end(), is_statsub);
    throw InputError("cli.no-static-load", deck.locate(b.find_command("STATSUB")),
                     "STATSUB of subcase " + std::to_string(b.id) + " names subcase " + std::to_string(b.statsub) +
                         ", which " + (is_there ? "has no LOAD and no TEMPERATURE(LOAD)" : "the deck does not have"),
                     is_there ? "give that subcase its load" : "name the subcase whose load is scaled");
  }
  if (cases.empty()) {
    throw InputError("cli.no-static-load", {deck.files.empty() ? std::string{} : deck.files[0]},
                     "buckling needs a subcase with LOAD or TEMPERATURE(LOAD), found none",
                     "put SUBCASE 1 with LOAD before SUBCASE 2 with METHOD, as in SOL 105");
  }
  return cases;
}

std::string describe_load(const records::Subcase& statics) {
  std::string text = "load factors of ";
  if (statics.load != 0) text += records::name_load(statics);
  if (statics.temperature != 0)
    text += (statics.load ? ", " : "") + std::string("TEMPERATURE ") + std::to_string(statics.temperature);
  return text + (statics.id > 0 ? " (subcase " + std::to_string(statics.id) + ")" : "");
}

records::Subcase get_preloaded(const records::Deck& deck, const BucklingCases& cases) {
  auto subcase = cases.buckling;
  // STATSUB of a deck for modes, read for its load factors: what it names is scaled.
  if (subcase.preload == subcase.statsub && !is_buckling_solution(deck)) subcase.preload = 0;
  return subcase;
}

EigenPairs solve_buckling(const records::Deck& deck, const BucklingCases& cases, fe::ModelOptions model_options,
                          const fe::Model& model, EigenOptions eigen, Diagnostics& diagnostics) {
  // The static subcase may be held in another way, as for antisymmetric buckling under a symmetric load.
  std::optional<fe::Model> own;
  const auto& b = cases.buckling;
  const bool is_same = ((b.spc == 0 && b.mpc == 0) || (b.spc == cases.statics.spc && b.mpc == cases.statics.mpc)) &&
                       model.subcase().initial_temperature == cases.statics.initial_temperature &&
                       model.subcase().material_temperature == cases.statics.material_temperature;
  // The load to scale acts on the preloaded structure, unless its subcase names a separate preload.
  const int preload = cases.statics.preload;
  const bool is_own = preload != 0 && preload != get_preloaded(deck, cases).preload;
  if (is_own) model_options.prestress = fe::calc_subcase_prestress(deck, model_options, cases.statics, diagnostics);
  if (!is_same || is_own) {
    model_options.subcase = cases.statics.id;
    own.emplace(fe::build_model(deck, model_options, diagnostics));
  }
  const fe::Model& statics = own ? *own : model;
  auto load = fe::calc_static_load(statics, deck, cases.statics, diagnostics);
  fe::report_dead_loads(deck, cases.statics.load, diagnostics);
  fe::report_unstiffened(statics, deck, diagnostics);
  diagnostics.throw_if_errors();
  const auto relief = fe::read_inertia_relief(deck, diagnostics);
  auto held = fe::choose_suport(statics, deck, relief, diagnostics);
  diagnostics.throw_if_errors();
  std::optional<fe::System> system;
  if (!own && model.num_fdofs() > 0) system.emplace(model);
  const fe::StaticSolver solver(statics, system ? system->K : fe::get_stiffness(statics), held);
  const auto suport =
      fe::calc_suport(statics, solver, std::move(held), relief, fe::locate_relief(statics, deck), diagnostics);
  fe::add_relief(statics, suport, load);
  const VectorXd u = fe::solve_static_case(statics, solver, load, suport).displacement;
  if (system) {
    eigen.factor = solver.find_definite_factor();
    return calc_buckling_modes(*system, load, u, eigen, diagnostics, &load.initial);
  }
  const auto initial = fe::calc_thermal(model, deck, cases.statics.temperature, diagnostics);
  return calc_buckling_modes(model, load, u, eigen, diagnostics, &initial);
}

}  // namespace bough::modal
