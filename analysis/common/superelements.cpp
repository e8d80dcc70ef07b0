#include "analysis/common/superelements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "fe/linear/petsc.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/matrices/system.hpp"
#include "fe/model/coordinates.hpp"
#include "fe/statics/build_model.hpp"
#include "formats/matrices/superelements.hpp"
#include "modal/bases/fixed_interface.hpp"
#include "stiffening/reduce.hpp"

namespace bough::analysis {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using records::Deck;
using records::DeckSection;
using records::Superelement;

/// Distance of grids that are one, if no card gives it (TOL of SEBULK).
constexpr double kTolerance = 1e-5;
/// Boundary dofs up to which geometric stiffness is condensed: N matrices N x N, 27 MB.
constexpr Index kMaxStiffenedDofs = 150;

bool has_elements(const Deck& deck) {
  return !(deck.beams.empty() && deck.shells.empty() && deck.solids.empty() && deck.crod.empty() &&
           deck.conrod.empty() && deck.springs.empty() && deck.cbush.empty() && deck.conm2.empty());
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
    for (const auto* part : parts) reduce(*part, main, own);
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

  /// Grids of the section and the grids of the main bulk data that they join.
  std::map<int, int> find_boundary(const DeckSection& section, const Places& main, const std::map<int, Places>& own) {
    std::map<int, int> joined;
    bool is_manual = false;
    for (const auto& bulk : deck_.super.sebulk)
      if (bulk.id == section.id) is_manual = !bulk.is_auto;
    for (const auto& card : deck_.super.seconct) {
      if (card.a != section.id && card.b != section.id) continue;
      if (card.a != 0 && card.b != 0) {
        error("fe.part-boundary", card.at,
              fmt::format("SECONCT joins superelements {} and {} to each other", card.a, card.b),
              "join both to grids of the main bulk data (SEIDB = 0)");
        continue;
      }
      for (const auto& [a, b] : card.points) joined[card.a == section.id ? a : b] = card.a == section.id ? b : a;
    }
    if (is_manual) return joined;
    const double tolerance = get_tolerance(section.id);
    for (const auto& [id, x] : own.at(section.id).all()) {
      if (joined.count(id) > 0) continue;
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

  void reduce(const DeckSection& section, const Places& main, const std::map<int, Places>& own) {
    const auto joined = find_boundary(section, main, own);
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
    Superelement s;
    s.id = section.id;
    s.at = section.at;
    s.section = section.deck;
    s.joined = joined;
    s.tolerance = get_tolerance(section.id);
    condense(part, section, s);
    if (s.K.size() > 0) deck_.superelements.push_back(std::move(s));
  }

  /// Name of the loads of a section: "loads", "temperatures" that a subcase selects, "DAREA cards"; empty: none.
  std::string find_load(const Deck& deck) const {
    const auto& more = deck.load_cards;
    if (!(deck.point_loads.empty() && deck.gravity.empty() && more.directed.empty() && more.beams.empty() &&
          more.grid_pressures.empty() && more.pressures.empty() && more.rotations.empty() && more.spcd.empty() &&
          more.scalar.empty()))
      return "loads";
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

  void condense(const Deck& part, const DeckSection& section, Superelement& s) {
    linear::initialize_petsc();
    Deck constrained = part;
    auto& subcase = constrained.subcases.front();
    subcase.spc =
        choose_set(section, [&](const auto& one) { return has_set(part.spc, part.spcadd, one.spc) ? one.spc : 0; });
    subcase.mpc =
        choose_set(section, [&](const auto& one) { return has_set(part.mpc, part.mpcadd, one.mpc) ? one.mpc : 0; });
    const auto model = fe::build_model(constrained, {}, diagnostics_);
    const fe::System system(model);
    std::vector<int> grids;
    for (const auto& [id, other] : s.joined) grids.push_back(id);
    const modal::bases::FixedInterface fixed(system, grids, diagnostics_);
    const MatrixXd Psi = fixed.calc_constraint_modes();
    const auto symmetrize = [](const MatrixXd& A) { return MatrixXd(0.5 * (A + A.transpose())); };
    s.K = symmetrize(Psi.transpose() * fe::calc_stiffness_times(model, Psi));
    s.M = symmetrize(Psi.transpose() * fe::calc_mass_times(model, model.mass_kind(), Psi));
    const auto condense_to = [&](MatrixXd& A, const MatrixXd& times_Psi) {
      if (times_Psi.size() > 0 && !times_Psi.isZero(0)) A = symmetrize(Psi.transpose() * times_Psi);
    };
    condense_to(s.B, fe::calc_damping_times(model, Psi));
    condense_to(s.K4, fe::calc_structural_damping_times(model, 0, Psi));
    if (Psi.cols() <= kMaxStiffenedDofs) {
      // The forces on the boundary that hold each of the constraint modes.
      fe::AppliedLoads loads{MatrixXd::Zero(Psi.rows(), Psi.cols()), MatrixXd::Zero(12, Psi.cols()), {}, {}};
      for (Index i = 0; i < s.K.rows(); ++i) {
        const auto& [id, component] = fixed.partition().boundary[static_cast<std::size_t>(i)];
        const fe::Node& node = model.node(model.find_node(id));
        const int c = (component - 1) % 3, half = component > 3 ? 3 : 0;
        loads.F.middleRows(node.first_gdof + half, 3) += node.R_basic_cd.col(c) * s.K.row(i);
      }
      s.K_G = stiffening::calc_generalized_geometric_stiffness(model, loads, Psi, Psi);
    }
    for (const auto& [id, component] : fixed.partition().boundary) {
      if (s.points.empty() || s.points.back().id != id) s.points.push_back({id, 0});
      s.points.back().c |= 1U << static_cast<unsigned>(component - 1);
    }
    records::RecoveryTable table{"MUG1", {}, MatrixXd(0, Psi.cols())};
    std::vector<const fe::Node*> nodes;
    for (const auto& node : model.nodes())
      if (node.num_dofs == 6) nodes.push_back(&node);
    table.rows.resize(6 * static_cast<Index>(nodes.size()), Psi.cols());
    for (const auto* node : nodes) {
      const auto first = static_cast<Index>(6 * table.items.size());
      for (const Index half : {0, 3})
        table.rows.middleRows(first + half, 3) =
            node->R_basic_cd.transpose() * Psi.middleRows(node->first_gdof + half, 3);
      table.items.push_back({1, node->id, 6, static_cast<int>(first)});
    }
    s.recovery.push_back(std::move(table));
    diagnostics_.note("fe.static-reduction", deck_.locate(section.at),
                      fmt::format("superelement {} is condensed to {} of its {} degrees of freedom", section.id,
                                  s.num_dofs(), model.num_fdofs()),
                      "its frequencies with the boundary held should be above those of interest");
  }

  /// The set of constraints of the section that the subcases select; they may not select several.
  template <class Get>
  int choose_set(const DeckSection& section, const Get& get) {
    std::set<int> sets;
    for (const auto& subcase : deck_.subcases)
      if (const int set = get(subcase)) sets.insert(set);
    if (sets.size() > 1)
      error("fe.part-boundary", section.at,
            fmt::format("the subcases select constraint sets {} and {} of superelement {}, which is condensed once",
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
