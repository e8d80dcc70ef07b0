#include "analysis/listing/listing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/common/inputs.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/superelements.hpp"
#include "analysis/listing/element_columns.hpp"
#include "analysis/listing/grid_stresses.hpp"
#include "fe/loads/load_sets.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/matrices/grid_point_weight.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/element_results.hpp"
#include "fe/statics/reactions.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/nastran/dynamic_reader.hpp"
#include "formats/records/group_names.hpp"
#include "formats/records/params.hpp"

namespace bough::analysis {

using Eigen::Index;
using Eigen::VectorXd;
using records::ListedKind;
using records::ListedStep;

records::CaseRequests read_requests_once(const std::string& path, Diagnostics& diagnostics) {
  return is_one_of_many() ? nastran::read_packed_requests(share([&] { return nastran::pack_deck(path); }), diagnostics)
                          : nastran::read_requests(path, diagnostics);
}

const records::DynamicSelection* find_selection(const records::CaseRequests& requests, int subcase) {
  const auto& all = requests.selections;
  for (const auto& combination : requests.combinations)
    if (combination.control.id == subcase) return &combination.selection;
  const auto found = all.find(all.count(0) > 0 ? 0 : subcase);
  return found == all.end() ? nullptr : &found->second;
}

bool asks_for(const records::CaseRequests& requests, const std::string& command) {
  const auto asks = [&](const records::DynamicSelection& selection) {
    const auto request = selection.outputs.find(command);
    return request != selection.outputs.end() && !request->second.is_none;
  };
  return std::any_of(requests.selections.begin(), requests.selections.end(),
                     [&](const auto& selection) { return asks(selection.second); }) ||
         std::any_of(requests.combinations.begin(), requests.combinations.end(),
                     [&](const auto& combination) { return asks(combination.selection); });
}

namespace {

/// Notes the requests with PUNCH, of which static and modes write no file.
void note_punch(const records::Deck& deck, const records::CaseRequests& requests, Diagnostics& diagnostics) {
  std::set<std::string> commands;
  for (const auto& [id, selection] : requests.selections)
    for (const auto& [command, request] : selection.outputs)
      if (request.is_punched && !request.is_none) commands.insert(command + "(PUNCH)");
  if (commands.empty()) return;
  std::string list;
  for (const auto& command : commands) list += (list.empty() ? "" : ", ") + command;
  diagnostics.note("cli.request-by-option", deck.locate({}),
                   "the deck requests " + list + ", and no punch file of statics or modes is written",
                   "--op2 FILE and -o FILE.h5 give these results; frequency and transient have --punch FILE");
}

}  // namespace

void note_requests(const records::Deck& deck, const records::CaseRequests& requests,
                   const std::vector<std::pair<std::string, std::string>>& options, Diagnostics& diagnostics) {
  const bool is_first = std::any_of(options.begin(), options.end(), [](const auto& one) { return one.first == "ESE"; });
  if (is_first) note_punch(deck, requests, diagnostics);
  for (const auto& [command, option] : options) {
    if (!asks_for(requests, command)) continue;
    diagnostics.note("cli.request-by-option", deck.locate({}), "the deck requests " + command, option + " gives it");
  }
}

records::DynamicDeck read_loads_deck_or_throw(const std::string& path, const fe::ModelOptions& options,
                                              bool is_response, Diagnostics& diagnostics, bool is_complex) {
  auto deck = read_dynamic_deck_once(path, {options.ignore_cards, is_response, is_complex}, diagnostics);
  if (diagnostics.num_errors() > 0) fe::build_model(deck, options, diagnostics);
  diagnostics.throw_if_errors();
  return deck;
}

ListingMaker::ListingMaker(const records::Deck& deck, const records::CaseRequests& requests, Diagnostics& diagnostics)
    : deck_(deck), requests_(requests), limits_(list_stress_limits(deck)) {
  for (const auto& [id, selection] : requests_.selections) lists_all_ = lists_all_ && selection.outputs.empty();
  if (lists_all_)
    diagnostics.note("cli.listing-default", deck.locate({}), "the deck requests no result: the listing has all of them",
                     "write DISPLACEMENT = ALL, SPCFORCES = ALL, FORCE = ALL, STRESS = ALL in the case control");
  report_sets(diagnostics);
  note_punch(deck, requests, diagnostics);
}

void ListingMaker::report_sets(Diagnostics& diagnostics) const {
  std::set<std::string> known;
  for (const auto& [id, selection] : requests_.selections)
    for (const auto& [command, request] : selection.outputs) {
      const bool of_fields = command == "GPSTRESS" || command == "STRFIELD";
      if (of_fields && !request.is_none && requests_.stress_fields.empty() && known.insert(command).second)
        diagnostics.warning("cli.missing-set", deck_.locate(request.at),
                            command + " lists surfaces and volumes, of which the case control has none",
                            "write OUTPUT(POST), SET 9 = elements and SURFACE 1 SET 9 NORMAL X3");
      if (request.is_all || request.is_none) continue;
      if (of_fields ? requests_.post_sets.contains(request.set) : selection.sets.contains(request.set)) continue;
      const auto text = fmt::format("{} = {} names a SET that the case control does not define", command, request.set);
      if (known.insert(text).second)
        diagnostics.error("cli.missing-set", deck_.locate(request.at), text,
                          fmt::format("write SET {} = ids{}, or {} = ALL", request.set,
                                      of_fields ? " of surfaces and volumes after OUTPUT(POST)" : "", command));
    }
  for (const auto& field : requests_.stress_fields)
    if (field.set != 0 && !requests_.post_sets.contains(field.set))
      diagnostics.error("cli.missing-set", deck_.locate(field.at),
                        fmt::format("{} {} names SET {}, which OUTPUT(POST) does not define",
                                    field.is_volume ? "VOLUME" : "SURFACE", field.id, field.set),
                        fmt::format("write SET {} = elements after OUTPUT(POST)", field.set));
}

std::optional<int> ListingMaker::find_effective_mass_grid(int subcase) const {
  const auto* found = find_selection(requests_, subcase);
  return found == nullptr ? std::nullopt : found->effective_mass_grid;
}

std::optional<ListingMaker::Choice> ListingMaker::choose(int subcase, const std::string& command) const {
  if (lists_all_) return Choice{};
  const auto* selection = find_selection(requests_, subcase);
  if (selection == nullptr) return std::nullopt;
  const auto request = selection->outputs.find(command);
  if (request == selection->outputs.end() || request->second.is_none) return std::nullopt;
  if (request->second.is_all) return Choice{nullptr, request->second.is_printed, request->second.is_fibre};
  const auto set = selection->sets.find(request->second.set);
  if (set == selection->sets.end()) return std::nullopt;
  return Choice{&set->second, request->second.is_printed, request->second.is_fibre};
}

ListedStep ListingMaker::make_step(int subcase) const {
  ListedStep step;
  step.subcase = subcase;
  const auto take = [&](const records::Subcase& s) {
    if (s.id != subcase) return;
    step.title = s.title;
    step.subtitle = s.subtitle;
    step.label = s.label;
  };
  for (const auto& s : deck_.subcases) take(s);
  for (const auto& combination : requests_.combinations) take(combination.control);
  // Without SUBCASE there is one, of number 1 in what Nastran writes.
  step.subcase = std::max(subcase, 1);
  return step;
}

void ListingMaker::add_weight(const fe::Model& model) {
  if (listing_.weight) return;
  int grid = 0;
  if (deck_.find_param("GRDPNT")) {
    Diagnostics known;  // of PARAM, reported when the deck was read
    grid = static_cast<int>(std::min(records::get_real_param(deck_, "GRDPNT", 0, known), 1e9));
  }
  if (grid < 0) return;
  if (grid > 0 && model.find_node(grid) < 0) grid = 0;
  const auto w = fe::calc_grid_point_weight(model, grid);
  listing_.weight = records::ListedWeight{w.grid, w.MO, w.S, w.cg, w.I_S, w.Q, w.mass, w.I_Q};
}

void ListingMaker::add_vector(const fe::Model& model, const std::string& command, ListedKind kind,
                              const Eigen::Ref<const VectorXd>& u_g, ListedStep& step) const {
  const auto choice = choose(step.subcase, command);
  if (!choice || u_g.size() == 0) return;
  std::vector<const fe::Node*> nodes;
  for (const auto& node : model.nodes())
    if (choice->contains(node.id)) nodes.push_back(&node);
  std::sort(nodes.begin(), nodes.end(), [](const auto* a, const auto* b) { return a->id < b->id; });
  records::ListedVector vector;
  vector.kind = kind;
  vector.is_printed = choice->is_printed;
  vector.real = Eigen::MatrixXd::Zero(static_cast<Index>(nodes.size()), 6);
  for (const auto* node : nodes) {
    const auto row = static_cast<Index>(vector.id.size());
    vector.id.push_back(node->id);
    vector.is_scalar.push_back(node->num_dofs == 1);
    if (node->num_dofs == 1) {
      vector.real(row, 0) = u_g[node->first_gdof];
      continue;
    }
    for (const int part : {0, 3})
      vector.real.row(row).segment<3>(part) =
          (node->R_basic_cd.transpose() * u_g.segment<3>(node->first_gdof + part)).transpose();
  }
  if (!vector.id.empty()) step.vectors.push_back(std::move(vector));
}

void ListingMaker::note_unlisted(const std::string& what, Diagnostics& diagnostics) {
  if (left_out_.insert(what).second)
    diagnostics.note("cli.unlisted-elements", deck_.locate({}), "the listing has no " + what,
                     "bough static --full and its HDF5 file have them");
}

void ListingMaker::add_elements(const fe::Model& model, const ElementIndex& elements,
                                const std::vector<records::ElementForces>& forces, const BeamLoads& loads,
                                ListedStep& step, Diagnostics& diagnostics) {
  const auto choice = choose(step.subcase, "FORCE");
  if (!choice) return;
  for (const auto& of_card : forces) {
    auto block = make_listed_forces(model, elements, of_card, loads, [&](int id) { return choice->contains(id); });
    if (block)
      block->is_printed = choice->is_printed;
    else
      note_unlisted("forces of " + of_card.card, diagnostics);
    if (block && !block->id.empty()) step.forces.push_back(std::move(*block));
  }
}

BeamLoads ListingMaker::sum_beam_loads(const fe::Model& model, const records::StaticSubcase& solved) const {
  std::vector<std::pair<double, int>> sets{{1, solved.load_set}};
  for (const auto& combination : requests_.combinations) {
    if (combination.control.id != solved.id) continue;
    sets.clear();
    for (const auto& [factor, id] : combination.terms)
      for (const auto& subcase : deck_.subcases)
        if (subcase.id == id) sets.emplace_back(factor, subcase.load);
  }
  BeamLoads sums;
  Diagnostics known;  // by the solution
  for (const auto& [factor, set] : sets)
    for (const auto& [e, load] : fe::calc_beam_end_loads(model, deck_, set, known)) {
      const int id = model.elements()[static_cast<std::size_t>(e)]->id();
      sums.try_emplace(id, Eigen::Vector4d::Zero()).first->second += factor * (load.head<4>() + load.segment<4>(6));
    }
  return sums;
}

void ListingMaker::add_bushes(const ElementIndex& elements, const std::vector<records::ElementForces>& forces,
                              const Eigen::Ref<const VectorXd>& u_g, ListedStep& step) const {
  using enum records::PointTable;
  for (const auto& [command, blocks] :
       {std::pair("STRESS", &ListedStep::stresses), std::pair("STRAIN", &ListedStep::strains)}) {
    const bool of_strain = blocks == &ListedStep::strains;
    const auto choice = choose(step.subcase, command);
    if (!choice || (of_strain && lists_all_)) continue;
    for (const auto& of_card : forces) {
      auto block = make_listed_bushes(
          elements, deck_, of_card, u_g, [&](int id) { return choice->contains(id); },
          of_strain ? FibreStrain : Stress);
      if (!block || block->id.empty()) continue;
      block->is_printed = choice->is_printed;
      (step.*blocks).push_back(std::move(*block));
    }
  }
}

void ListingMaker::add_grid_stresses(const fe::Model& model, const ElementIndex& elements,
                                     const std::vector<records::ElementForces>& forces, ListedStep& step,
                                     Diagnostics& diagnostics) {
  if (lists_all_) return;
  const auto* selection = find_selection(requests_, step.subcase);
  if (selection == nullptr) return;
  for (const auto& field : requests_.stress_fields) {
    bool is_selected = false, is_printed = false;
    for (const char* command : {"GPSTRESS", "STRFIELD"}) {
      const auto request = selection->outputs.find(command);
      if (request == selection->outputs.end() || request->second.is_none) continue;
      const auto set = requests_.post_sets.find(request->second.set);
      if (!request->second.is_all && (set == requests_.post_sets.end() || !set->second.contains(field.id))) continue;
      is_selected = true;
      is_printed = is_printed || (command == std::string("GPSTRESS") && request->second.is_printed);
    }
    if (!is_selected) continue;
    const auto members = requests_.post_sets.find(field.set);
    std::set<std::string> skipped;
    auto block = calc_grid_stresses(
        model, elements, deck_, field, forces, [&](int id) { return field.set == 0 || members->second.contains(id); },
        skipped);
    for (const auto& card : skipped) note_unlisted("grid point stresses of " + card, diagnostics);
    block.is_printed = is_printed;
    step.grid_stresses.push_back(std::move(block));
  }
}

void ListingMaker::add_strains(const fe::Model& model, const ElementIndex& elements,
                               const std::vector<records::ElementStresses>& strains,
                               const std::vector<records::ElementForces>& forces, ListedStep& step,
                               Diagnostics& diagnostics) {
  const auto choice = choose(step.subcase, "STRAIN");
  if (lists_all_ || !choice) return;
  using enum records::PointTable;
  for (const auto& of_card : strains) {
    auto block = make_listed_stresses(
        model, elements, deck_, of_card, forces, limits_, [&](int id) { return choice->contains(id); },
        choice->is_fibre ? FibreStrain : CurvatureStrain);
    if (block)
      block->is_printed = choice->is_printed;
    else
      note_unlisted("strains of " + of_card.card, diagnostics);
    if (block && !block->id.empty()) step.strains.push_back(std::move(*block));
  }
}

void ListingMaker::add_stresses(const fe::Model& model, const ElementIndex& elements,
                                const std::vector<records::ElementStresses>& stresses,
                                const std::vector<records::ElementForces>& forces, ListedStep& step,
                                Diagnostics& diagnostics) {
  const auto choice = choose(step.subcase, "STRESS");
  if (!choice) return;
  for (const auto& of_card : forces)
    if (records::get_card_of_group(of_card.card) == "CBUSH1D" && left_out_.insert("CBUSH1D").second)
      diagnostics.note("cli.unlisted-elements", deck_.locate({}), "the listing has no stresses of " + of_card.card,
                       "write FORCE = ALL: its force is listed");
  for (const auto& of_card : stresses) {
    auto block = make_listed_stresses(model, elements, deck_, of_card, forces, limits_,
                                      [&](int id) { return choice->contains(id); });
    if (block)
      block->is_printed = choice->is_printed;
    else
      note_unlisted("stresses of " + of_card.card, diagnostics);
    if (block && !block->id.empty()) step.stresses.push_back(std::move(*block));
  }
}

void ListingMaker::add_energies(const std::vector<records::ElementForces>& elements, double total,
                                records::ListedStep& step) const {
  const auto choice = choose(step.subcase, "ESE");
  if (lists_all_ || !choice || !choice->is_printed) return;
  for (const auto& of_card : elements) {
    std::vector<std::pair<int, double>> energies;
    for (std::size_t k = 0; k < of_card.id.size(); ++k)
      if (choice->contains(of_card.id[k]))
        energies.emplace_back(of_card.id[k], of_card.strain_energy[static_cast<Index>(k)]);
    if (energies.empty()) continue;
    std::sort(energies.begin(), energies.end());
    records::ListedEnergies block{of_card.card, {}, VectorXd(static_cast<Index>(energies.size())), total};
    for (const auto& [id, energy] : energies) {
      block.energy[static_cast<Index>(block.id.size())] = energy;
      block.id.push_back(id);
    }
    step.energies.push_back(std::move(block));
  }
}

void ListingMaker::add_grid_forces(const fe::Model& model, const std::vector<records::GridForce>& forces,
                                   records::ListedStep& step) const {
  const auto choice = choose(step.subcase, "GPFORCE");
  if (lists_all_ || !choice || !choice->is_printed) return;
  static const std::map<std::string, std::string> names{{"LOAD", "APP-LOAD"}, {"SPC", "F-OF-SPC"}, {"MPC", "F-OF-MPC"}};
  for (const auto& f : forces) {
    if (!choice->contains(f.node)) continue;
    const auto& R = model.node(model.find_node(f.node)).R_basic_cd;
    records::ListedGridForce row{f.node, f.element, f.source, f.force};
    if (const auto name = names.find(f.source); f.element == 0 && name != names.end()) row.source = name->second;
    for (const int part : {0, 3}) row.force.segment<3>(part) = R.transpose() * f.force.segment<3>(part);
    step.grid_forces.push_back(std::move(row));
  }
  std::stable_sort(step.grid_forces.begin(), step.grid_forces.end(), [](const auto& a, const auto& b) {
    return std::pair(a.grid, a.element > 0) < std::pair(b.grid, b.element > 0);
  });
}

void ListingMaker::add_static(const fe::Model& model, const records::StaticSubcase& solved, Diagnostics& diagnostics) {
  auto step = make_step(solved.id);
  step.load_set = solved.load_set;
  add_vector(model, "DISPLACEMENT", ListedKind::Displacement, solved.displacement, step);
  add_vector(model, "OLOAD", ListedKind::Load, solved.load, step);
  add_vector(model, "SPCFORCES", ListedKind::SpcForce, solved.reaction, step);
  add_vector(model, "MPCFORCES", ListedKind::MpcForce, solved.mpc_force, step);
  const auto elements = index_elements(model);
  add_elements(model, elements, solved.elements, sum_beam_loads(model, solved), step, diagnostics);
  add_stresses(model, elements, solved.stresses, solved.elements, step, diagnostics);
  add_strains(model, elements, solved.strains, solved.elements, step, diagnostics);
  add_bushes(elements, solved.elements, solved.displacement, step);
  add_grid_stresses(model, elements, solved.elements, step, diagnostics);
  add_energies(solved.elements, solved.strain_energy, step);
  add_grid_forces(model, solved.grid_forces, step);
  listing_.steps.push_back(std::move(step));
}

void ListingMaker::add_modes(const fe::Model& model, const modal::EigenPairs& pairs, int num_residual,
                             Diagnostics& diagnostics) {
  const int subcase = model.subcase().id;
  const Eigen::MatrixXd M_Phi = fe::calc_mass_times(model, model.mass_kind(), pairs.Phi);
  const auto step = make_step(subcase);
  records::ListedRoots roots{step};
  roots.eigenvalue = pairs.lambda;
  roots.num_residual = num_residual;
  roots.mass = pairs.Phi.cwiseProduct(M_Phi).colwise().sum();
  roots.stiffness = roots.mass.cwiseProduct(pairs.lambda);
  const auto grid = lists_all_ ? std::optional<int>(0) : find_effective_mass_grid(subcase);
  if (grid) {
    records::ListedEffectiveMass mass;
    mass.subcase = step.subcase;
    mass.grid = *grid;
    const int node = *grid > 0 ? model.find_node(*grid) : -1;
    if (*grid > 0 && (node < 0 || model.node(node).num_dofs != 6))
      throw InputError("modal.unknown-grid", deck_.locate({}),
                       fmt::format("MEFFMASS(GRID={}) names a grid that the deck does not have", *grid),
                       "name a GRID of the deck");
    const fe::Vector3d point = node < 0 ? fe::Vector3d::Zero() : model.node(node).x;
    mass.participation = M_Phi.transpose() * model.calc_rigid_modes(point);
    mass.mass = roots.mass.cwiseInverse().asDiagonal() * mass.participation.cwiseAbs2();
    mass.participation = (roots.mass.cwiseInverse().asDiagonal() * mass.participation).eval();
    mass.whole = fe::calc_mass_properties(model, model.mass_kind(), point).rigid_mass.diagonal();
    mass.cycles = pairs.lambda.cwiseAbs().cwiseSqrt() / (2 * M_PI);
    listing_.effective_mass.push_back(std::move(mass));
  }
  add_shapes(
      model, pairs, roots,
      [&](Index j) -> VectorXd {
        return fe::calc_stiffness_times(model, pairs.Phi.col(j)) - pairs.lambda(j) * M_Phi.col(j);
      },
      diagnostics);
  listing_.roots.push_back(std::move(roots));
}

void ListingMaker::add_buckling(const fe::Model& model, const modal::EigenPairs& pairs, int subcase,
                                Diagnostics& diagnostics) {
  records::ListedRoots roots{make_step(subcase)};
  roots.eigenvalue = pairs.lambda;
  roots.stiffness = pairs.Phi.cwiseProduct(fe::calc_stiffness_times(model, pairs.Phi)).colwise().sum();
  roots.mass = roots.stiffness.cwiseQuotient(pairs.lambda);
  if (!lists_all_ && choose(subcase, "SPCFORCES") && left_out_.insert("SPCFORCES").second)
    diagnostics.note("cli.unlisted-elements", deck_.locate({}),
                     "the listing has no constraint forces of buckling shapes",
                     "nothing to do: its forces and stresses are those of the shapes");
  add_shapes(model, pairs, roots, {}, diagnostics);
  listing_.roots.push_back(std::move(roots));
}

void ListingMaker::add_shapes(const fe::Model& model, const modal::EigenPairs& pairs, const records::ListedRoots& roots,
                              const std::function<VectorXd(Index)>& reactions, Diagnostics& diagnostics) {
  const int subcase = roots.subcase;
  ListedStep step;
  static_cast<records::ListedHeading&>(step) = roots;
  const bool has_reactions = reactions && choose(subcase, "SPCFORCES").has_value();
  const bool has_forces = choose(subcase, "FORCE").has_value(), has_stresses = choose(subcase, "STRESS").has_value();
  const bool has_energies = !lists_all_ && choose(subcase, "ESE").has_value();
  const bool has_strains = !lists_all_ && choose(subcase, "STRAIN").has_value();
  const auto* selection = lists_all_ ? nullptr : find_selection(requests_, subcase);
  const bool has_grid_stresses =
      selection && (selection->outputs.contains("GPSTRESS") || selection->outputs.contains("STRFIELD"));
  const auto elements =
      has_forces || has_stresses || has_strains || has_grid_stresses ? index_elements(model) : ElementIndex{};
  for (Index j = 0; j < pairs.lambda.size(); ++j) {
    ListedStep mode = step;
    mode.kind = ListedStep::Kind::Mode;
    mode.mode = static_cast<int>(j) + 1;
    mode.eigenvalue = pairs.lambda(j);
    mode.cycles = std::sqrt(std::abs(pairs.lambda(j))) / (2 * M_PI);
    add_vector(model, "DISPLACEMENT", ListedKind::Eigenvector, pairs.Phi.col(j), mode);
    if (has_reactions) {
      VectorXd reaction = fe::calc_reactions(model, reactions(j));
      add_vector(model, "SPCFORCES", ListedKind::SpcForce, reaction, mode);
    }
    if (has_forces || has_stresses || has_energies || has_strains || has_grid_stresses) {
      const auto forces = fe::calc_element_forces(model, pairs.Phi.col(j), deck_, 0, diagnostics);
      add_elements(model, elements, forces, {}, mode, diagnostics);
      if (has_stresses)
        add_stresses(model, elements, fe::calc_element_stresses(model, pairs.Phi.col(j), deck_, 0), forces, mode,
                     diagnostics);
      if (has_strains)
        add_strains(model, elements, fe::calc_element_strains(model, pairs.Phi.col(j), deck_, 0), forces, mode,
                    diagnostics);
      if (has_stresses || has_strains) add_bushes(elements, forces, pairs.Phi.col(j), mode);
      if (has_grid_stresses) add_grid_stresses(model, elements, forces, mode, diagnostics);
      add_energies(forces, 0.5 * roots.stiffness(j), mode);
    }
    listing_.steps.push_back(std::move(mode));
  }
}

}  // namespace bough::analysis
