#include "analysis/common/superelements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "analysis/listing/recovery_rows.hpp"
#include "fe/cards/temperature_set.hpp"
#include "fe/linear/petsc.hpp"
#include "fe/loads/loads.hpp"
#include "fe/loads/second_order.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/matrices/system.hpp"
#include "fe/model/coordinates.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/reactions.hpp"
#include "formats/matrices/superelements.hpp"
#include "modal/bases/fixed_interface.hpp"
#include "stiffening/reduce.hpp"

namespace bough::analysis {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using records::Deck;
using records::DeckSection;
using records::Superelement;

/// Distance of grids that are one, if no card gives it (TOL of SEBULK).
constexpr double kTolerance = 1e-5;
/// Boundary dofs up to which geometric stiffness is condensed: N matrices N x N, 27 MB.
constexpr Index kMaxStiffenedDofs = 150;
/// Elements times motions up to which forces and stresses of a section are recovered: some 16 numbers each, 128 MB.
constexpr Index kMaxElementRows = 1'000'000;

bool has_elements(const Deck& deck) {
  return !(deck.beams.empty() && deck.shells.empty() && deck.solids.empty() && deck.crod.empty() &&
           deck.conrod.empty() && deck.ctube.empty() && deck.shear_panels.empty() && deck.springs.empty() &&
           deck.cbush.empty() && deck.cbush1d.empty() && deck.conm1.empty() && deck.conm2.empty() &&
           deck.scalar_masses.empty());
}

/// Grid ids of a deck by place.
class Places {
 public:
  Places(const Deck& deck, Diagnostics& diagnostics) {
    const fe::CoordinateSystems systems(deck, Vector3d::Zero(), diagnostics);
    for (std::size_t k = 0; k < deck.grids.size(); ++k)
      places_.emplace_back(deck.grids[k].id, systems.get_grid_position(static_cast<int>(k)));
    std::stable_sort(places_.begin(), places_.end(),
                     [](const auto& a, const auto& b) { return a.second.x() < b.second.x(); });
  }
  const std::vector<std::pair<int, Vector3d>>& all() const { return places_; }
  /// Grids at x, ascending.
  std::vector<int> find_all(const Vector3d& x, double tolerance) const {
    std::vector<int> found;
    auto at = std::lower_bound(places_.begin(), places_.end(), x.x() - tolerance,
                               [](const auto& place, double limit) { return place.second.x() < limit; });
    for (; at != places_.end() && at->second.x() <= x.x() + tolerance; ++at)
      if ((at->second - x).norm() <= tolerance) found.push_back(at->first);
    std::sort(found.begin(), found.end());
    return found;
  }
  /// A grid at x, or 0.
  int find(const Vector3d& x, double tolerance) const {
    const auto found = find_all(x, tolerance);
    return found.empty() ? 0 : found.front();
  }

 private:
  std::vector<std::pair<int, Vector3d>> places_;  ///< id and position, by x
};

class PartReducer {
 public:
  PartReducer(Deck& deck, Diagnostics& diagnostics) : deck_(deck), diagnostics_(diagnostics) {}

  void reduce_all() {
    std::vector<const DeckSection*> parts;
    for (const auto& section : deck_.super.sections)
      if (is_part(section)) parts.push_back(&section);
    if (parts.empty()) return;
    const Places main(deck_, diagnostics_);
    std::map<int, Places> own;
    for (const auto* part : parts) own.emplace(part->id, Places(*part->deck, diagnostics_));
    std::vector<std::map<int, int>> joined, scalars;
    for (const auto* part : parts) {
      joined.push_back(find_boundary(*part, main, own));
      scalars.push_back(extract_scalar_points(*part, joined.back()));
    }
    for (std::size_t k = 0; k < parts.size(); ++k)
      reduce(*parts[k], joined[k], scalars[k], list_neighbors(parts, joined, k));
    // The grids that sections and main bulk data share, for what needs them all.
    for (std::size_t k = 0; k < parts.size(); ++k)
      deck_.super.seconct.push_back({parts[k]->id, 0, 0, {joined[k].begin(), joined[k].end()}, parts[k]->at});
  }

 private:
  void error(const char* id, const records::CardLocation& at, std::string what, std::string advice) {
    diagnostics_.error(id, deck_.locate(at), std::move(what), std::move(advice));
  }

  /// Returns true for sections with elements that no SEBULK makes external.
  bool is_part(const DeckSection& section) const {
    const auto bulk = std::find_if(deck_.super.sebulk.begin(), deck_.super.sebulk.end(),
                                   [&](const auto& one) { return one.id == section.id; });
    const bool is_external = bulk != deck_.super.sebulk.end() && bulk->type != "PRIMARY";
    return !is_external && section.deck->super.extrn.empty() && has_elements(*section.deck);
  }

  double get_tolerance(int id) const {
    for (const auto& bulk : deck_.super.sebulk)
      if (bulk.id == id && bulk.tolerance > 0) return bulk.tolerance;
    return kTolerance;
  }

  /// The main bulk data (id -1) and the other sections with their grids that section k shares: its shells continue
  /// there.
  records::SuperelementCards list_neighbors(const std::vector<const DeckSection*>& parts,
                                            const std::vector<std::map<int, int>>& joined, std::size_t k) const {
    records::SuperelementCards cards;
    std::map<int, int> own;  // by grid of the main bulk data
    for (const auto& [id, grid] : joined[k]) own[grid] = id;
    const auto add = [&](int id, const std::shared_ptr<const Deck>& deck, const std::map<int, int>& grids) {
      records::Seconct shared{id, 0, 0, {}, parts[k]->at};
      for (const auto& [other, grid] : grids)
        if (const auto found = own.find(grid); found != own.end()) shared.points.emplace_back(other, found->second);
      if (shared.points.empty() || deck->shells.empty()) return;
      cards.sections.push_back({id, deck, parts[k]->at});
      cards.seconct.push_back(std::move(shared));
    };
    std::map<int, int> identity;
    for (const auto& [id, grid] : joined[k]) identity[grid] = grid;
    add(-1, std::shared_ptr<const Deck>(std::shared_ptr<const Deck>(), &deck_), identity);
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (i != k) add(parts[i]->id, parts[i]->deck, joined[i]);
    return cards;
  }

  /// Grids of the section and the grids of the main bulk data that they join.
  std::map<int, int> find_boundary(const DeckSection& section, const Places& main, const std::map<int, Places>& own) {
    std::map<int, int> joined;
    bool is_manual = false;
    for (const auto& bulk : deck_.super.sebulk)
      if (bulk.id == section.id) is_manual = !bulk.is_auto;
    for (const auto& card : deck_.super.seconct) {
      if (card.a != section.id && card.b != section.id) continue;
      if (card.a != 0 && card.b != 0) {
        if (!card.points.empty() && card.points.front().second == 0) continue;  // SEBNDRY with another section
        error("fe.part-boundary", card.at,
              fmt::format("SECONCT joins superelements {} and {} to each other", card.a, card.b),
              "join both to grids of the main bulk data (SEIDB = 0)");
        continue;
      }
      for (const auto& [a, b] : card.points)
        if (a != 0 && b != 0) joined[card.a == section.id ? a : b] = card.a == section.id ? b : a;
    }
    if (is_manual) return joined;
    const double tolerance = get_tolerance(section.id);
    const auto searched = find_searched(section, own.at(section.id));
    for (const auto& [id, x] : own.at(section.id).all()) {
      if (joined.count(id) > 0 || (searched && searched->count(id) == 0)) continue;
      if (const auto found = main.find_all(x, tolerance); !found.empty()) {
        joined[id] = found.front();
        if (found.size() > 1)
          error("fe.part-boundary", section.at,
                fmt::format("grids {} and {} of the main bulk data are at grid {} of superelement {}", found[0],
                            found[1], id, section.id),
                "name the one that it joins by SECONCT");
        continue;
      }
      for (const auto& [other, places] : own)
        if (other != section.id && places.find(x, tolerance) != 0 && reported_.insert(id).second)
          error("fe.part-boundary", section.at,
                fmt::format("grid {} of superelement {} is at grid {} of superelement {}, and no grid of the main bulk "
                            "data is there",
                            id, section.id, places.find(x, tolerance), other),
                "add a grid of the main bulk data at this place: parts join through it");
    }
    return joined;
  }

  /// Moves the scalar points of the section out of the pairs that SECONCT joins; every other pair is to name a grid of
  /// the section. Kinds of the points of the main bulk data are checked when the superelement is made.
  std::map<int, int> extract_scalar_points(const DeckSection& section, std::map<int, int>& joined) {
    const Deck& deck = *section.deck;
    std::set<int> grids, scalars(deck.scalar_points.begin(), deck.scalar_points.end());
    for (const auto& grid : deck.grids) grids.insert(grid.id);
    std::map<int, int> found;
    for (auto pair = joined.begin(); pair != joined.end();) {
      if (grids.count(pair->first) > 0) {
        ++pair;
        continue;
      }
      if (scalars.count(pair->first) > 0)
        found.insert(*pair);
      else
        error("fe.part-boundary", section.at,
              fmt::format("SECONCT names point {}, which superelement {} does not have", pair->first, section.id),
              "correct the id, or add its GRID or SPOINT to the section");
      pair = joined.erase(pair);
    }
    return found;
  }

  /// Grids of a section that SEBNDRY names, 0 or more; without SEBNDRY all grids are searched.
  std::optional<std::set<int>> find_searched(const DeckSection& section, const Places& own) {
    std::optional<std::set<int>> searched;
    std::set<int> known;
    for (const auto& [id, x] : own.all()) known.insert(id);
    for (const auto& card : deck_.super.seconct)
      for (const auto& [a, b] : card.points) {
        if (card.a != section.id || b != 0) continue;
        if (!searched) searched.emplace();
        searched->insert(a);
        if (known.count(a) == 0)
          error("fe.part-boundary", card.at,
                fmt::format("SEBNDRY names grid {}, which superelement {} does not have", a, section.id),
                "correct the id");
      }
    return searched;
  }

  /// \param joined   grids of the section and of the main bulk data, \param scalars its scalar points and theirs.
  void reduce(const DeckSection& section, const std::map<int, int>& joined, const std::map<int, int>& scalars,
              records::SuperelementCards neighbors) {
    if (joined.empty())
      return error("fe.part-boundary", section.at,
                   fmt::format("superelement {} joins no grid of the main bulk data", section.id),
                   "give its boundary grids to the main bulk data at the same places, or join them by SECONCT");
    if (const auto load = find_load(*section.deck); !load.empty())
      return error("fe.part-load", section.at,
                   fmt::format("superelement {} has {} on its interior, which are not condensed", section.id, load),
                   "put the loads on its boundary in the main bulk data, or the elements into it");
    Deck part = *section.deck;
    // The last of a PARAM counts: that of the section.
    part.params.insert(part.params.begin(), deck_.params.begin(), deck_.params.end());
    part.super = std::move(neighbors);
    Superelement s;
    s.id = section.id;
    s.at = section.at;
    s.section = section.deck;
    s.joined = joined;
    s.joined.insert(scalars.begin(), scalars.end());
    s.tolerance = get_tolerance(section.id);
    condense(part, section, s);
    if (s.K.size() > 0) deck_.superelements.push_back(std::move(s));
  }

  /// Ids of the load sets of a section, LOAD cards included.
  static std::set<int> list_load_sets(const Deck& deck) {
    std::set<int> sets;
    const auto add = [&](const auto& cards) {
      for (const auto& card : cards) sets.insert(card.sid);
    };
    const auto& more = deck.load_cards;
    add(deck.point_loads);
    add(deck.gravity);
    add(deck.loads);
    add(deck.special.accelerations);
    add(more.directed);
    add(more.beams);
    add(more.grid_pressures);
    add(more.pressures);
    add(more.rotations);
    add(more.scalar);
    return sets;
  }

  /// Loads of a section that are not condensed: "temperatures" that a subcase selects, "DAREA cards"; empty: none.
  std::string find_load(const Deck& deck) const {
    if (!deck.load_cards.spcd.empty()) return "SPCD cards";
    for (const char* card : {"DAREA", "LSEQ", "RLOAD1", "RLOAD2", "TLOAD1", "TLOAD2"})
      if (deck.card_counts.count(card) > 0) return std::string(card) + " cards";
    const auto& t = deck.temperatures;
    for (const auto& subcase : deck_.subcases) {
      const int set = subcase.temperature;
      const auto is_of = [set](const auto& card) { return card.sid == set; };
      if (set != 0 &&
          (std::any_of(t.grids.begin(), t.grids.end(), is_of) ||
           std::any_of(t.defaults.begin(), t.defaults.end(), is_of) ||
           std::any_of(t.bars.begin(), t.bars.end(), is_of) || std::any_of(t.plates.begin(), t.plates.end(), is_of)))
        return "temperatures";
    }
    return {};
  }

  /// Selects the temperatures at which materials of the section are evaluated: its cards of the set. False after an
  /// error.
  bool select_material_temperature(const Deck& part, const DeckSection& section, records::Subcase& subcase) {
    if (part.temperatures.materials.empty()) return true;
    const int errors = diagnostics_.num_errors();
    subcase.material_temperature = choose_set(
        section,
        [](const auto& one) {
          return one.material_temperature != 0 ? one.material_temperature : one.initial_temperature;
        },
        "temperature sets of the materials");
    if (diagnostics_.num_errors() > errors) return false;
    const int set = subcase.material_temperature;
    if (set == 0 || !fe::TemperatureSet(part.temperatures, set).is_empty()) return true;
    error("fe.part-temperature", section.at,
          fmt::format("superelement {} has no TEMP, TEMPD, TEMPRB or TEMPP1 card of temperature set {}, at which its "
                      "materials are evaluated",
                      section.id, set),
          "add the cards to its section: those of the main bulk data heat the grids of the main bulk data");
    return false;
  }

  void condense(const Deck& part, const DeckSection& section, Superelement& s) {
    linear::initialize_petsc();
    Deck constrained = part;
    // The points of the q-set have no structure.
    std::set<int> points;
    for (const auto& term : part.qset) points.insert(term.g);
    std::erase_if(constrained.scalar_points, [&](int id) { return points.count(id) > 0; });
    std::erase_if(constrained.aset, [&](const auto& term) { return points.count(term.g) > 0; });
    constrained.subcases.clear();
    constrained.qset.clear();
    constrained.bset.clear();
    constrained.cset.clear();
    auto& subcase = constrained.subcases.emplace_back();
    subcase.spc =
        choose_set(section, [&](const auto& one) { return has_set(part.spc, part.spcadd, one.spc) ? one.spc : 0; });
    subcase.mpc =
        choose_set(section, [&](const auto& one) { return has_set(part.mpc, part.mpcadd, one.mpc) ? one.mpc : 0; });
    if (!select_material_temperature(part, section, subcase)) return;
    const auto model = fe::build_model(constrained, {}, diagnostics_);
    const fe::System system(model);
    std::vector<int> grids;
    for (const auto& [id, other] : s.joined)
      if (points.count(id) == 0) grids.push_back(id);
    const modal::bases::FixedInterface fixed(system, grids, diagnostics_);
    const MatrixXd constraint_modes = fixed.calc_constraint_modes();
    const auto nb = constraint_modes.cols();
    for (const auto& [id, component] : fixed.partition().boundary) {
      if (s.points.empty() || s.points.back().id != id) s.points.push_back({id, 0});
      if (is_scalar(model, id)) continue;
      s.points.back().c |= 1U << static_cast<unsigned>(component - 1);
    }
    const auto modes = calc_component_modes(part, section, fixed, constraint_modes.rows());
    const auto nq = modes.Phi.cols();
    add_generalized(nq, points, s);
    MatrixXd Psi(constraint_modes.rows(), nb + nq);
    Psi << constraint_modes, modes.Phi;
    report_supported_mass(model, fixed, Psi, section);
    const auto symmetrize = [](const MatrixXd& A) { return MatrixXd(0.5 * (A + A.transpose())); };
    const MatrixXd force = fe::calc_stiffness_times(model, Psi);
    s.K = symmetrize(Psi.transpose() * force);
    s.K.topLeftCorner(nb, nb) = remove_roundoff(s.K.topLeftCorner(nb, nb), calc_boundary_stiffness(model, fixed));
    // Constraint modes and fixed-interface modes have no common strain energy.
    s.K.topRightCorner(nb, nq).setZero();
    s.K.bottomLeftCorner(nq, nb).setZero();
    s.K.bottomRightCorner(nq, nq) = modes.lambda.asDiagonal();
    s.M = symmetrize(Psi.transpose() * fe::calc_mass_times(model, model.mass_kind(), Psi));
    const auto condense_to = [&](MatrixXd& A, const MatrixXd& times_Psi) {
      if (times_Psi.size() > 0 && !times_Psi.isZero(0)) A = symmetrize(Psi.transpose() * times_Psi);
    };
    condense_to(s.B, fe::calc_damping_times(model, Psi));
    condense_to(s.K4, fe::calc_structural_damping_times(model, 0, Psi));
    // Loads: their forces on the exterior DOFs, and the displacements with fixed exterior DOFs.
    const auto sets = list_load_sets(part);
    MatrixXd F(Psi.rows(), static_cast<Index>(sets.size()));
    std::vector<fe::AppliedLoad> applied;
    for (const int set : sets) {
      const auto column = static_cast<int>(s.load_columns.size());
      s.load_columns[set] = column;
      applied.push_back(fe::calc_applied_load(model, part, set, diagnostics_));
      F.col(column) = applied.back().F;
    }
    MatrixXd held(Psi.rows(), 0);
    if (F.cols() > 0) {
      s.P = Psi.transpose() * F;
      held = fixed.solve(F);
      if (nq > 0) held -= modes.Phi * modes.lambda.cwiseInverse().asDiagonal() * (modes.Phi.transpose() * F);
    }
    if (Psi.cols() <= kMaxStiffenedDofs) set_geometric_stiffness(model, fixed, {Psi, held, force}, applied, s);
    add_displacements(model, Psi, held, s);
    add_element_results(model, part, {Psi, held, force}, section, s);
    add_reactions(model, force, fe::calc_stiffness_times(model, held) - F, s);
    diagnostics_.note("fe.static-reduction", deck_.locate(section.at),
                      fmt::format("superelement {} is condensed to {} boundary degrees of freedom and {} component "
                                  "modes of its {} degrees of freedom",
                                  section.id, nb, nq, model.num_fdofs()),
                      "its further frequencies with the boundary held should be above those of interest");
  }

  /// Reports mass that does not follow the rigid-body motion of the boundary, because the section has supports: mass
  /// properties and effective masses of the assembly do not contain it.
  void report_supported_mass(const fe::Model& model, const modal::bases::FixedInterface& fixed, const MatrixXd& Psi,
                             const DeckSection& section) {
    const MatrixXd Phi_R = model.calc_rigid_modes().leftCols(3);
    const auto& boundary = fixed.partition().boundary;
    MatrixXd moved = MatrixXd::Zero(Phi_R.rows(), 3);
    for (Index i = 0; i < static_cast<Index>(boundary.size()); ++i) {
      const auto& [id, component] = boundary[static_cast<std::size_t>(i)];
      const fe::Node& node = model.node(model.find_node(id));
      if (node.num_dofs == 1) continue;
      const int c = (component - 1) % 3, half = component > 3 ? 3 : 0;
      moved += Psi.col(i) * (node.R_basic_cd.col(c).transpose() * Phi_R.middleRows(node.first_gdof + half, 3));
    }
    const auto calc_mass = [&](const MatrixXd& X) {
      return X.cwiseProduct(fe::calc_mass_times(model, model.mass_kind(), X)).sum() / 3;
    };
    const double mass = calc_mass(Phi_R), seen = calc_mass(moved);
    constexpr double kLost = 1e-6;
    if (mass > 0 && std::abs(mass - seen) > kLost * mass)
      diagnostics_.warning("fe.part-mass", deck_.locate(section.at),
                           fmt::format("superelement {} is supported inside: mass properties and effective masses of "
                                       "the assembly count {:.6g} of its mass {:.6g}",
                                       section.id, seen, mass),
                           "put its supports on boundary grids, in the main bulk data, if these numbers are needed");
  }

  /// Motions of a section: Ψ; of its loads with the exterior dofs held; K Ψ. num_gdofs x their number.
  struct Motions {
    const MatrixXd &Psi, &held, &force;
  };

  /// K_G of each motion, and of the stress of each load with the exterior dofs held: K_G(σ) condensed by Ψ.
  static void set_geometric_stiffness(const fe::Model& model, const modal::bases::FixedInterface& fixed,
                                      const Motions& motions, const std::vector<fe::AppliedLoad>& applied,
                                      Superelement& s) {
    const auto& boundary = fixed.partition().boundary;
    const auto nb = static_cast<Index>(boundary.size()), n = motions.Psi.cols(), nq = n - nb;
    const auto m = static_cast<Index>(applied.size());
    // Reactions in each mode, and the loads with fixed exterior DOFs.
    fe::AppliedLoads loads{MatrixXd::Zero(motions.Psi.rows(), n + m), MatrixXd::Zero(12, n + m), {}, {}};
    loads.arms.resize(static_cast<std::size_t>(n));
    loads.followers.resize(static_cast<std::size_t>(n));
    for (Index j = 0; j < m; ++j) {
      const auto& load = applied[static_cast<std::size_t>(j)];
      loads.F.col(n + j) = load.F;
      loads.A_I.col(n + j) = load.A_I;
      loads.arms.push_back(load.arms);
      loads.followers.push_back(load.followers);
    }
    for (Index i = 0; i < nb; ++i) {
      const auto& [id, component] = boundary[static_cast<std::size_t>(i)];
      const fe::Node& node = model.node(model.find_node(id));
      const auto [first, unit] = make_unit(node, component);
      loads.F.middleRows(first, unit.size()).leftCols(n) += unit * s.K.row(i);
      if (m > 0) loads.F.middleRows(first, unit.size()).rightCols(m) -= unit * s.P.row(i);
    }
    loads.F.middleCols(nb, nq) = motions.force.rightCols(nq);
    if (m > 0 && nq > 0)
      loads.F.rightCols(m) -= motions.force.rightCols(nq) *
                              s.K.bottomRightCorner(nq, nq).diagonal().cwiseInverse().asDiagonal() * s.P.bottomRows(nq);
    MatrixXd U(motions.Psi.rows(), n + m);
    U << motions.Psi, motions.held;
    s.K_G = stiffening::calc_generalized_geometric_stiffness(model, loads, U, motions.Psi);
  }

  /// Forces (MEF1) and stresses (MES1) of all elements of the section.
  void add_element_results(const fe::Model& model, const Deck& part, const Motions& motions, const DeckSection& section,
                           Superelement& s) {
    const auto n = motions.Psi.cols(), m = motions.held.cols();
    if (static_cast<Index>(model.elements().size()) * (n + m) > kMaxElementRows)
      return diagnostics_.note(
          "fe.part-recovery", deck_.locate(section.at),
          fmt::format("superelement {} has too many elements to recover their forces and stresses", section.id),
          "divide it into several sections, or take its displacements MUG1");
    MatrixXd U(motions.Psi.rows(), n + m);
    U << motions.Psi, motions.held;
    std::vector<int> loads(static_cast<std::size_t>(n + m), 0);
    for (const auto& [set, column] : s.load_columns) loads[static_cast<std::size_t>(n + column)] = set;
    const auto all = [](int) { return true; };
    for (auto& table : make_recovery_rows(model, part, U, loads, all, all)) {
      if (m > 0) s.recovery.push_back({table.name + "O", table.items, table.rows.rightCols(m)});
      s.recovery.push_back({table.name, std::move(table.items), table.rows.leftCols(n)});
    }
  }

  static bool is_scalar(const fe::Model& model, int id) { return model.node(model.find_node(id)).num_dofs == 1; }

  /// Unit displacement of a component in the displacement axes of its node, basic axes: the first g-dof and 3 values,
  /// or 1 of a scalar point.
  static std::pair<Index, VectorXd> make_unit(const fe::Node& node, int component) {
    if (node.num_dofs == 1) return {node.first_gdof, VectorXd::Ones(1)};
    return {node.first_gdof + (component > 3 ? 3 : 0), node.R_basic_cd.col((component - 1) % 3)};
  }

  /// Diagonal of K before condensation at the dofs of the boundary.
  static VectorXd calc_boundary_stiffness(const fe::Model& model, const modal::bases::FixedInterface& fixed) {
    const auto& boundary = fixed.partition().boundary;
    MatrixXd unit = MatrixXd::Zero(model.num_gdofs(), static_cast<Index>(boundary.size()));
    for (Index i = 0; i < unit.cols(); ++i) {
      const auto& [id, component] = boundary[static_cast<std::size_t>(i)];
      const auto [first, direction] = make_unit(model.node(model.find_node(id)), component);
      unit.col(i).segment(first, direction.size()) = direction;
    }
    return unit.cwiseProduct(fe::calc_stiffness_times(model, unit)).colwise().sum();
  }

  /// K without what condensation leaves of motions that it does not resist, as rigid-body motions of a section on one
  /// grid: shares of the stiffness before, in whose range the geometric stiffness would be looked for.
  static MatrixXd remove_roundoff(const MatrixXd& K, const VectorXd& before) {
    constexpr double kRoundoff = 1e-11;
    const VectorXd size = before.cwiseMax(0).cwiseSqrt();
    const VectorXd inverse = size.unaryExpr([](double x) { return x > 0 ? 1 / x : 0.0; });
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(MatrixXd(inverse.asDiagonal() * K * inverse.asDiagonal()));
    const VectorXd kept = (eigen.eigenvalues().array() > kRoundoff).select(eigen.eigenvalues(), 0.0);
    MatrixXd share = eigen.eigenvectors() * kept.asDiagonal() * eigen.eigenvectors().transpose();
    share = (share.array().abs() > kRoundoff).select(share, 0.0);
    return size.asDiagonal() * share * size.asDiagonal();
  }

  /// Component modes with the boundary held: EIGRL or EIGR of the section that METHOD selects, as many as the points of
  /// QSET.
  modal::bases::ModeSet calc_component_modes(const Deck& part, const DeckSection& section,
                                             const modal::bases::FixedInterface& fixed, Index num_gdofs) {
    modal::bases::ModeSet modes;
    modes.Phi.resize(num_gdofs, 0);
    std::set<int> points;
    for (const auto& term : part.qset) points.insert(term.g);
    const auto count = static_cast<Index>(points.size());
    if (count == 0) return modes;
    const auto at = part.qset.front().at;
    if (!part.cset.empty()) {
      error("fe.part-modes", part.cset.front().at,
            fmt::format("CSET of superelement {} frees boundary degrees of freedom for its component modes, which is "
                        "not supported",
                        section.id),
            "remove CSET: the modes are those with the boundary held");
      return modes;
    }
    const int set =
        choose_set(section, [&](const auto& one) { return find_method(part, one.method) ? one.method : 0; });
    const auto* method = find_method(part, set);
    if (!method) {
      error("fe.part-modes", at,
            fmt::format("superelement {} has {} generalized coordinates, and METHOD selects no EIGRL of its section",
                        section.id, count),
            fmt::format("write EIGRL with the id of METHOD in the section, METHOD above all subcases or in a subcase "
                        "of SUPER = {}",
                        section.id));
      return modes;
    }
    const int number = method->num_modes > 0 ? static_cast<int>(std::min<Index>(method->num_modes, count)) : 0;
    modes = fixed.calc_modes(number, method->f2, diagnostics_);
    if (modes.lambda.size() > count) {
      modes.lambda.conservativeResize(count);
      modes.Phi.conservativeResize(Eigen::NoChange, count);
      diagnostics_.note("fe.part-modes", deck_.locate(at),
                        fmt::format("superelement {} has more modes in the range of METHOD than its {} generalized "
                                    "coordinates: the highest are left out",
                                    section.id, count),
                        "name more SPOINTs in QSET1");
    }
    return modes;
  }

  static const records::EigenMethod* find_method(const Deck& deck, int set) {
    const auto found = std::find_if(deck.eigen_methods.begin(), deck.eigen_methods.end(),
                                    [set](const auto& one) { return one.sid == set; });
    return set == 0 || found == deck.eigen_methods.end() ? nullptr : &*found;
  }

  /// Generalized coordinates in ascending order of the points of QSET. One that SECONCT joins is a scalar point of the
  /// main bulk data; the others become scalar points with ids above all others.
  void add_generalized(Index number, const std::set<int>& points, Superelement& s) {
    Index used = 0;
    for (const int id : points) {
      if (s.joined.count(id) == 0) continue;
      if (used++ < number)
        s.points.push_back({id, 0});
      else
        s.joined.erase(id);  // fewer modes than points
    }
    number -= std::min(used, number);
    if (number == 0) return;
    int highest = 0;
    for (const Deck* deck : {static_cast<const Deck*>(&deck_), s.section.get()}) {
      for (const auto& grid : deck->grids) highest = std::max(highest, grid.id);
      for (const int id : deck->scalar_points) highest = std::max(highest, id);
    }
    for (Index k = 0; k < number; ++k) {
      const int id = ++highest;
      deck_.scalar_points.push_back(id);
      s.points.push_back({id, 0});
      s.joined[id] = id;
    }
  }

  /// Components of `values` (num_gdofs x n, basic) at `nodes`, in their displacement axes.
  static MatrixXd list_rows(const std::vector<const fe::Node*>& nodes, const MatrixXd& values) {
    Index size = 0;
    for (const auto* node : nodes) size += node->num_dofs;
    MatrixXd rows(size, values.cols());
    for (Index first = 0; const auto* node : nodes) {
      if (node->num_dofs == 1) {
        rows.row(first++) = values.row(node->first_gdof);
        continue;
      }
      for (const Index half : {0, 3})
        rows.middleRows(first + half, 3) = node->R_basic_cd.transpose() * values.middleRows(node->first_gdof + half, 3);
      first += 6;
    }
    return rows;
  }
  /// Adds a table and, with loads, that of the displacements with fixed exterior DOFs.
  static void add_tables(const std::string& name, const std::vector<const fe::Node*>& nodes, const MatrixXd& values,
                         const MatrixXd& of_loads, Superelement& s) {
    std::vector<records::RecoveryItem> items;
    items.reserve(nodes.size());
    int row = 0;
    for (const auto* node : nodes) {
      items.push_back({node->num_dofs == 1 ? 2 : 1, node->id, node->num_dofs, row});
      row += node->num_dofs;
    }
    s.recovery.push_back({name, items, list_rows(nodes, values)});
    if (of_loads.cols() > 0) s.recovery.push_back({name + "O", items, list_rows(nodes, of_loads)});
  }

  static void add_displacements(const fe::Model& model, const MatrixXd& Psi, const MatrixXd& held, Superelement& s) {
    std::vector<const fe::Node*> nodes;
    for (const auto& node : model.nodes()) nodes.push_back(&node);
    add_tables("MUG1", nodes, Psi, held, s);
  }

  /// Forces of the single-point constraints of the section: K u - F at the dofs that they hold.
  static void add_reactions(const fe::Model& model, const MatrixXd& force, const MatrixXd& of_loads, Superelement& s) {
    std::set<std::pair<int, int>> without_stiffness;
    for (const auto& entry : model.autospc()) without_stiffness.emplace(entry.node, entry.component);
    std::vector<const fe::Node*> nodes;
    const std::set<int> fixed(model.fixed_dofs().begin(), model.fixed_dofs().end());
    for (const auto& node : model.nodes()) {
      bool is_held = false;
      for (int c = 0; c < node.num_dofs; ++c)
        is_held = is_held || (fixed.count(node.first_gdof + c) > 0 && without_stiffness.count({node.id, c + 1}) == 0);
      if (is_held && node.num_dofs == 6) nodes.push_back(&node);
    }
    const auto calc_all = [&](const MatrixXd& residuals) {
      MatrixXd reactions(residuals.rows(), residuals.cols());
      for (Index c = 0; c < residuals.cols(); ++c)
        reactions.col(c) = fe::calc_reactions(model, Eigen::VectorXd(residuals.col(c)));
      return reactions;
    };
    if (!nodes.empty()) add_tables("MQG1", nodes, calc_all(force), calc_all(of_loads), s);
  }

  /// The set of constraints of the section that the subcases select; they may not select several.
  template <class Get>
  int choose_set(const DeckSection& section, const Get& get, const char* kind = "constraint sets") {
    // Subcases of SUPER = n are of the section alone.
    const auto& own = section.deck->subcases;
    const bool has_own = std::any_of(own.begin(), own.end(), [](const auto& subcase) { return subcase.id > 0; });
    std::set<int> sets;
    for (const auto& subcase : has_own ? own : deck_.subcases)
      if (const int set = get(subcase)) sets.insert(set);
    if (sets.size() > 1)
      error("fe.part-boundary", section.at,
            fmt::format("the subcases select {} {} and {} of superelement {}, which is condensed once", kind,
                        *sets.begin(), *sets.rbegin(), section.id),
            "give the section one set, and analyze the others in another deck");
    return sets.empty() ? 0 : *sets.begin();
  }
  template <class Cards>
  static bool has_set(const Cards& cards, const std::vector<records::SetUnion>& unions, int set) {
    const auto is_of = [set](const auto& card) { return card.sid == set; };
    return std::any_of(cards.begin(), cards.end(), is_of) || std::any_of(unions.begin(), unions.end(), is_of);
  }

  Deck& deck_;
  Diagnostics& diagnostics_;
  std::set<int> reported_;
};

}  // namespace

void join_superelements(Deck& deck, Diagnostics& diagnostics) {
  if (diagnostics.num_errors() == 0) {
    PartReducer(deck, diagnostics).reduce_all();
    diagnostics.throw_if_errors();  // reading a section that is not condensed would report it again
  }
  matrices::read_superelements(deck, diagnostics);
}

}  // namespace bough::analysis
