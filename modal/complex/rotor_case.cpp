#include "modal/complex/rotor_case.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "fe/elements/stress_state.hpp"
#include "fe/loads/second_order.hpp"
#include "fe/matrices/system.hpp"
#include "fe/statics/statics.hpp"
#include "formats/records/element_cards.hpp"
#include "formats/records/params.hpp"

namespace bough::modal::rotors {
namespace {

using fe::RotorAxis;
using fe::RotorDamping;
using fe::Vector3d;
using records::CardLocation;

/// Largest distance of a grid from the axis, over the length of the rotor.
constexpr double kMaxDistance = 1e-4;

template <class Record, class Id>
const Record* find(const std::vector<Record>& all, Id Record::*member, int id) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& r) { return r.*member == id; });
  return found == all.end() ? nullptr : &*found;
}

class Chooser {
 public:
  Chooser(const fe::Model& model, const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
          RotorUse use, Diagnostics& diagnostics)
      : model_(model),
        deck_(deck),
        cards_(deck.dynamics.rotors),
        subcase_(subcase),
        use_(use),
        diagnostics_(diagnostics),
        g_(records::get_real_param(deck, "G", 0, diagnostics)) {}

  std::optional<RotorCase> choose() {
    const auto& d = subcase_.dynamics;
    if (d.rgyro == 0 && d.rmethod == 0) return std::nullopt;
    if (d.rgyro != 0 && d.rmethod != 0)
      fail("modal.rotor-speeds", subcase_.find_command("RMETHOD"), "the subcase has RGYRO and RMETHOD",
           "leave one of them out");
    else if (d.rgyro != 0)
      choose_rgyro(d.rgyro);
    else
      choose_rotord(d.rmethod);
    check_shared();
    warn_of_tied();
    return case_;
  }

 private:
  void fail(const char* id, const CardLocation& at, const std::string& what, const std::string& advice) {
    diagnostics_.error(id, deck_.locate(at), what, advice);
  }

  /// The card that the command of the case control selects; nullptr with an error.
  template <class Record>
  const Record* find_selected(const std::vector<Record>& all, int sid, const std::string& command,
                              const std::string& card) {
    const Record* selected = find(all, &Record::sid, sid);
    if (selected == nullptr)
      fail("modal.missing-rotor", subcase_.find_command(command),
           command + " = " + std::to_string(sid) + " names no " + card + " card of the deck",
           "add the card or correct the id");
    return selected;
  }

  void choose_rgyro(int sid) {
    const auto* analysis = find_selected(cards_.analyses, sid, "RGYRO", "RGYRO");
    if (analysis == nullptr) return;
    case_.is_synchronous = analysis->is_synchronous;
    case_.reference = analysis->reference;
    case_.low = analysis->low * analysis->unit;
    case_.high = analysis->high * analysis->unit;
    if (!find(cards_.lines, &records::RotorLine::id, analysis->reference))
      fail("modal.missing-rotor", analysis->at,
           "RGYRO " + std::to_string(sid) + ": REFROTR " + std::to_string(analysis->reference) +
               " names no ROTORG card of the deck",
           "add the grids of the rotor by ROTORG, or correct the id");
    if (!case_.is_synchronous) choose_speeds(*analysis);
    for (const auto& spin : cards_.spins)
      if (!find(cards_.lines, &records::RotorLine::id, spin.rotor))
        fail("modal.missing-rotor", spin.at, "RSPINR of rotor " + std::to_string(spin.rotor) + " has no ROTORG card",
             "add the grids of the rotor by ROTORG, or correct the id");
    std::vector<int> ids;
    for (const auto& line : cards_.lines)
      if (std::find(ids.begin(), ids.end(), line.id) == ids.end()) ids.push_back(line.id);
    for (const int id : ids) add_rotor(id, *analysis);
  }

  void choose_speeds(const records::RotorAnalysis& analysis) {
    if (analysis.speeds == 0) {
      case_.speeds = {analysis.speed * analysis.unit};
      return;
    }
    const auto* list = find(cards_.speeds, &records::SpeedList::sid, analysis.speeds);
    if (list == nullptr)
      return fail("modal.missing-rotor", analysis.at,
                  "RGYRO " + std::to_string(analysis.sid) + ": SPEED " + std::to_string(analysis.speeds) +
                      " names no RSPEED card of the deck",
                  "add the card, or write a speed with a decimal point");
    for (int i = 0; i <= list->count; ++i) case_.speeds.push_back((list->first + i * list->step) * analysis.unit);
  }

  void add_rotor(int id, const records::RotorAnalysis& analysis) {
    const auto* line = find(cards_.lines, &records::RotorLine::id, id);
    const auto* spin = find(cards_.spins, &records::RotorSpin::rotor, id);
    if (spin == nullptr)
      return fail("modal.missing-rotor", line->at, "rotor " + std::to_string(id) + " has ROTORG and no RSPINR card",
                  "add RSPINR with two of its grids: from GRIDA to GRIDB is the direction of positive spin");
    const int a = model_.find_node(spin->grid_a), b = model_.find_node(spin->grid_b);
    const auto grids = list_grids(id);
    for (const int grid : {spin->grid_a, spin->grid_b})
      if (std::find(grids.begin(), grids.end(), grid) == grids.end())
        return fail("modal.rotor-line", spin->at,
                    "RSPINR of rotor " + std::to_string(id) + " names grid " + std::to_string(grid) +
                        ", which ROTORG does not list",
                    "name two grids of the rotor");
    const Vector3d from = model_.node(a).x, along = model_.node(b).x - from;
    if (!(along.norm() > 0))
      return fail("modal.rotor-line", spin->at,
                  "RSPINR of rotor " + std::to_string(id) + ": grids " + std::to_string(spin->grid_a) + " and " +
                      std::to_string(spin->grid_b) + " are at one point",
                  "name two grids that are apart");
    add_axis({id, grids, along.normalized(), deck_.locate(line->at)}, from);
    RotorDamping damping;
    damping.alpha1 = spin->alpha1;
    damping.alpha2 = spin->alpha2;
    const auto choose = [&](double own, const char* param) {
      return own > 0 ? own : records::get_real_param(deck_, param, 0, diagnostics_);
    };
    add_structural(damping, spin->gr, choose(spin->wr3, "WR3"), choose(spin->wr4, "WR4"), id, spin->at,
                   {"GR", "WR3R", "WR4R"});
    case_.damping.push_back(damping);
    if (spin->table != 0 && find(cards_.values, &records::ValueList::id, spin->table) == nullptr)
      fail("modal.missing-rotor", spin->at,
           "RSPINR of rotor " + std::to_string(id) + ": SPTID " + std::to_string(spin->table) +
               " names no DDVAL card of the deck",
           "add the card, or write a rate with a decimal point");
    add_relation(*spin, analysis);
  }

  struct Names {
    const char *g, *w3, *w4;
  };
  /// Structural damping that becomes viscous, or that acts at each frequency of a response.
  void add_structural(RotorDamping& damping, double g, double w3, double w4, int id, const CardLocation& at,
                      const Names& names) {
    damping.g = g;
    if (w3 > 0) damping.viscous_g = g / w3;
    if (w4 > 0) damping.viscous_ge = 1 / w4;
    if (use_ == RotorUse::Frequency) return;
    const auto& grids = case_.axes.back().grids;
    const bool has_ge = std::any_of(model_.elements().begin(), model_.elements().end(), [&](const auto& element) {
      return element->structural_damping() != 0 &&
             std::all_of(element->nodes().begin(), element->nodes().end(), [&](int node) {
               return std::find(grids.begin(), grids.end(), model_.node(node).id) != grids.end();
             });
    });
    const bool lacks_w3 = g != 0 && w3 <= 0, lacks_w4 = has_ge && w4 <= 0;
    if (!lacks_w3 && !lacks_w4) return;
    const std::string without = lacks_w3 ? names.w3 : names.w4;
    diagnostics_.warning("modal.rotor-damping", deck_.locate(at),
                         std::string(lacks_w3 ? names.g : "GE of the elements") + " of rotor " + std::to_string(id) +
                             " does not act on complex eigenvalues without " + without + ", as in Nastran",
                         "give " + without + ", the circular frequency at which it becomes viscous");
  }

  void add_relation(const records::RotorSpin& spin, const records::RotorAnalysis& analysis) {
    if (spin.rotor == analysis.reference) return case_.relations.emplace_back(1.0), void();
    const auto* reference = find(cards_.spins, &records::RotorSpin::rotor, analysis.reference);
    if (reference == nullptr) return case_.relations.emplace_back(1.0), void();  // reported
    const auto own = list_rates(spin), of_reference = list_rates(*reference);
    const auto is_ascending = [](const std::vector<double>& v) {
      return std::adjacent_find(v.begin(), v.end(), [](double x, double y) { return !(x < y); }) == v.end();
    };
    const bool is_wrong = own.size() != of_reference.size() || own.empty() || !is_ascending(of_reference) ||
                          (own.size() == 1 && of_reference[0] == 0);
    if (is_wrong) {
      fail("modal.rotor-speeds", spin.at,
           "rotor " + std::to_string(spin.rotor) + " has " + std::to_string(own.size()) +
               " spin rates, reference rotor " + std::to_string(analysis.reference) + " has " +
               std::to_string(of_reference.size()),
           "give both as many DDVAL, ascending ones of the reference rotor, or a number each, not 0 of the reference");
      case_.relations.emplace_back(1.0);
    } else if (own.size() == 1) {
      case_.relations.emplace_back(own[0] / of_reference[0]);
    } else {
      case_.relations.emplace_back(of_reference, own);
    }
    if (case_.is_synchronous && !case_.relations.back().find_line())
      fail("modal.rotor-speeds", spin.at,
           "the spin rates of rotor " + std::to_string(spin.rotor) + " and of reference rotor " +
               std::to_string(analysis.reference) + " are on no line, as synchronous analyses demand",
           "give rates in proportion, or use ASYNC");
  }

  /// [1/T]
  std::vector<double> list_rates(const records::RotorSpin& spin) {
    if (spin.table == 0) return {spin.rate * spin.unit};
    const auto* list = find(cards_.values, &records::ValueList::id, spin.table);
    if (list == nullptr) return {spin.unit};  // reported with the rotor
    auto rates = list->values;
    for (double& rate : rates) rate *= spin.unit;
    return rates;
  }

  void choose_rotord(int sid) {
    const auto* card = find_selected(cards_.sweeps, sid, "RMETHOD", "ROTORD");
    if (card == nullptr) return;
    for (int i = 0; i < card->count; ++i) case_.speeds.push_back(card->first + i * card->step);
    if (card->shapes_at > 0) case_.shapes_at = card->shapes_at;
    for (const auto& rotor : card->rotors) {
      const auto* line = find(cards_.lines, &records::RotorLine::id, rotor.line);
      if (line == nullptr) {
        fail("modal.missing-rotor", rotor.at,
             "ROTORD " + std::to_string(sid) + ": RSET " + std::to_string(rotor.line) +
                 " names no ROTORG card of the deck",
             "add the grids of the rotor by ROTORG, or correct the id");
        continue;
      }
      const auto grids = list_grids(rotor.line);
      if (grids.empty()) continue;
      const Vector3d from = model_.node(model_.find_node(grids.front())).x;
      const Vector3d axis = model_.calc_axes(rotor.cid, from, deck_.locate(rotor.at), diagnostics_).col(2);
      const Vector3d origin = model_.calc_point(rotor.cid, Vector3d::Zero(), deck_.locate(rotor.at), diagnostics_);
      add_axis({rotor.line, grids, axis, deck_.locate(line->at)}, has_grids_around(grids, axis, from) ? origin : from);
      case_.is_rotating = rotor.is_rotating;
      case_.axes.back().frame = rotor.is_rotating ? fe::RotorFrame::Rotating : fe::RotorFrame::Fixed;
      RotorDamping damping;
      add_structural(damping, g_, rotor.w3, rotor.w4, rotor.line, rotor.at, {"PARAM,G", "W3", "W4"});
      case_.damping.push_back(damping);
      case_.relations.emplace_back(rotor.speed);
    }
  }

  /// Grids of the ROTORG cards of a rotor, without repetition.
  std::vector<int> list_grids(int id) {
    std::vector<int> grids;
    const auto add = [&](int grid) {
      if (std::find(grids.begin(), grids.end(), grid) == grids.end()) grids.push_back(grid);
    };
    const CardLocation* at = nullptr;
    for (const auto& line : cards_.lines) {
      if (line.id != id) continue;
      at = &line.at;
      for (const auto& range : line.grids) {
        if (range.is_thru) {
          for (const auto& node : model_.nodes())
            if (node.num_dofs == 6 && node.id >= range.first && node.id <= range.last &&
                (node.id - range.first) % range.step == 0)
              add(node.id);
          continue;
        }
        const int index = model_.find_node(range.first);
        if (index >= 0 && model_.node(index).num_dofs == 6)
          add(range.first);
        else if (!model_.is_refused(range.first))
          fail("modal.rotor-line", line.at,
               "ROTORG " + std::to_string(id) + " names grid " + std::to_string(range.first) +
                   ", which the deck does not define",
               "add the GRID or correct the id");
      }
    }
    if (grids.size() < 2 && at != nullptr)
      fail("modal.rotor-line", *at, "ROTORG " + std::to_string(id) + " has fewer than two grids of the deck",
           "list the grids along the axis of the rotor");
    return grids;
  }

  /// Returns true if grids are around the axis: three or more, not in one plane with it.
  bool has_grids_around(const std::vector<int>& grids, const Vector3d& axis, const Vector3d& point) const {
    fe::Matrix3d spread = fe::Matrix3d::Zero();
    double largest = 0;
    for (const int id : grids) {
      Vector3d r = model_.node(model_.find_node(id)).x - point;
      largest = std::max(largest, r.norm());
      r -= axis * axis.dot(r);
      spread += r * r.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<fe::Matrix3d> sizes(spread, Eigen::EigenvaluesOnly);
    return sizes.eigenvalues()[1] > kMaxDistance * kMaxDistance * largest * largest;
  }

  void add_axis(RotorAxis axis, const Vector3d& from) {
    axis.point = from;
    axis.is_spatial = has_grids_around(axis.grids, axis.axis, from);
    if (axis.is_spatial) {
      case_.axes.push_back(std::move(axis));
      return;
    }
    double length = 0, farthest = 0;
    int grid = 0;
    for (const int id : axis.grids) {
      const Vector3d r = model_.node(model_.find_node(id)).x - from;
      length = std::max(length, std::abs(r.dot(axis.axis)));
      const double distance = (r - axis.axis * r.dot(axis.axis)).norm();
      if (distance > farthest) farthest = distance, grid = id;
    }
    if (farthest > kMaxDistance * length) {
      char text[64];
      std::snprintf(text, sizeof text, "%.6g", farthest);
      diagnostics_.error(
          "modal.rotor-line", axis.at,
          "grid " + std::to_string(grid) + " of rotor " + std::to_string(axis.id) + " is " + text + " from the axis",
          "list grids on one line, with the mass of discs by CONM2, or all grids of a body around it");
    }
    case_.axes.push_back(std::move(axis));
  }

  void check_shared() {
    std::map<int, int> owner;
    for (const auto& axis : case_.axes)
      for (const int grid : axis.grids)
        if (const auto [found, is_new] = owner.emplace(grid, axis.id); !is_new && found->second != axis.id) {
          diagnostics_.error("modal.rotor-shared", axis.at,
                             "grid " + std::to_string(grid) + " is on rotors " + std::to_string(found->second) +
                                 " and " + std::to_string(axis.id),
                             "give each rotor separate grids, joined by bearings (CBUSH, CELAS2)");
          break;
        }
  }

  /// Mass at grids that a rigid element ties to a rotor: it turns with the rotor, without gyroscopic matrix.
  void warn_of_tied() {
    std::map<int, int> rotor_of;
    for (const auto& axis : case_.axes)
      for (const int grid : axis.grids) rotor_of.emplace(grid, axis.id);
    struct Tie {
      int rotor = 0;
      std::string by;
    };
    std::map<int, Tie> tied;
    records::visit_elements(deck_, {records::ElementRole::Rigid}, [&](const records::ElementView& view) {
      if (!view.has_moments) return;
      const auto on = std::find_if(view.grids.begin(), view.grids.end(), [&](int g) { return rotor_of.contains(g); });
      if (on == view.grids.end()) return;
      for (const int grid : view.grids)
        if (!rotor_of.contains(grid)) tied.emplace(grid, Tie{rotor_of.at(*on), name_record(view.card, view.id)});
    });
    if (tied.empty()) return;
    std::map<int, std::pair<std::string, int>> found;  // by rotor: the first, and how many
    for (const auto& element : model_.elements()) {
      const auto& nodes = element->nodes();
      const auto at = std::find_if(nodes.begin(), nodes.end(), [&](int n) { return tied.contains(model_.node(n).id); });
      if (at == nodes.end()) continue;
      fe::MatrixXd M = fe::MatrixXd::Zero(element->num_dofs(), element->num_dofs());
      element->add_mass(model_.mass_kind(), 1, M);
      if (M.isZero(0)) continue;
      const int grid = model_.node(*at).id;
      const auto& [rotor, by] = tied.at(grid);
      auto& [text, count] = found[rotor];
      if (++count == 1)
        text = name_record(element->card(), element->id()) + " at grid " + std::to_string(grid) + ", which " + by +
               " ties to rotor " + std::to_string(rotor);
    }
    for (const auto& axis : case_.axes) {
      const auto entry = found.find(axis.id);
      if (entry == found.end()) continue;
      const auto& [text, count] = entry->second;
      diagnostics_.warning("modal.rotor-tied", axis.at,
                           text + ", is not on the rotor: it has no gyroscopic moment" +
                               (count > 1 ? ", nor have " + std::to_string(count - 1) + " more elements" : ""),
                           "give its mass and inertia by CONM2 at a grid of ROTORG");
    }
  }

  static std::string name_record(const std::string& card, int id) { return card + " " + std::to_string(id); }

  const fe::Model& model_;
  const records::DynamicDeck& deck_;
  const records::RotorCards& cards_;
  const records::DynamicSubcase& subcase_;
  RotorUse use_;
  Diagnostics& diagnostics_;
  double g_;
  RotorCase case_;
};

/// The matrix of the centrifugal force with K_G of the stress that it causes, per square of the spin: of the elements
/// of the rotor, of links, and of loads on arms.
fe::SparseColumns calc_centrifugal_stiffness(const fe::Model& model, const fe::Rotor& rotor,
                                             const fe::SparseColumns& of_force) {
  if (!rotor.is_spatial) return of_force;
  const auto load = fe::calc_centrifugal_load(model, rotor);
  if (load.F.isZero(0)) return of_force;
  const fe::StaticSolver solver(model, fe::get_stiffness(model));
  const fe::MatrixXd u = solver.solve(load.F);
  std::vector<Eigen::Triplet<double>> terms;
  const auto add = [&](const std::vector<int>& dofs, const fe::MatrixXd& K) {
    for (Eigen::Index j = 0; j < K.cols(); ++j)
      for (Eigen::Index i = 0; i < K.rows(); ++i)
        if (K(i, j) != 0)
          terms.emplace_back(dofs[static_cast<std::size_t>(i)], dofs[static_cast<std::size_t>(j)], K(i, j));
  };
  for (const fe::Element* element : rotor.elements) {
    const fe::StressState* state = element->stress_state();
    if (state == nullptr) continue;
    VectorXd force = VectorXd::Zero(state->num_internal_forces());
    state->calc_internal_forces(u(element->gdofs(), 0), force);
    fe::MatrixXd K = fe::MatrixXd::Zero(element->num_dofs(), element->num_dofs());
    state->add_geometric_stiffness(force, 1, K);
    add(element->gdofs(), K);
  }
  fe::AppliedLoads applied{load.F, fe::MatrixXd::Zero(12, 1), {}};
  for (const auto& form : fe::calc_second_order(model, applied, u)) add(form.gdofs, fe::calc_form(form, 0));
  fe::SparseColumns total(model.num_gdofs(), model.num_gdofs());
  total.setFromTriplets(terms.begin(), terms.end());
  return of_force + load.stiffness + total;
}

}  // namespace

double SpeedRelation::evaluate(double reference) const {
  if (reference_.empty()) return factor_ * reference;
  auto i =
      static_cast<std::size_t>(std::upper_bound(reference_.begin(), reference_.end(), reference) - reference_.begin());
  i = std::clamp<std::size_t>(i, 1, reference_.size() - 1);
  const double slope = (own_[i] - own_[i - 1]) / (reference_[i] - reference_[i - 1]);
  return own_[i - 1] + slope * (reference - reference_[i - 1]);
}

std::optional<std::pair<double, double>> SpeedRelation::find_line() const {
  if (reference_.empty()) return std::pair(0.0, factor_);
  const double slope = (own_.back() - own_.front()) / (reference_.back() - reference_.front());
  const double offset = own_.front() - slope * reference_.front();
  const double size = std::abs(own_.front()) + std::abs(own_.back());
  for (std::size_t i = 0; i < own_.size(); ++i)
    if (std::abs(offset + slope * reference_[i] - own_[i]) > 1e-6 * size) return std::nullopt;
  return std::pair(offset, slope);
}

std::optional<RotorCase> choose_rotors(const fe::Model& model, const records::DynamicDeck& deck,
                                       const records::DynamicSubcase& subcase, RotorUse use, Diagnostics& diagnostics) {
  return Chooser(model, deck, subcase, use, diagnostics).choose();
}

bool has_own_stress(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase) {
  const auto* card = find(deck.dynamics.rotors.sweeps, &records::RotorSweepCard::sid, subcase.dynamics.rmethod);
  return card != nullptr &&
         std::any_of(card->rotors.begin(), card->rotors.end(), [](const auto& r) { return r.has_stress; });
}

RotorTerms::RotorTerms(const fe::Model& model, const RotorCase& rotor_case, double g, Diagnostics& diagnostics)
    : case_(rotor_case),
      num_gdofs_(model.num_gdofs()),
      rotors_(fe::find_rotors(model, rotor_case.axes, diagnostics)),
      model_structural_(num_gdofs_, num_gdofs_) {
  diagnostics.throw_if_errors();
  for (std::size_t j = 0; j < rotors_.size(); ++j) {
    matrices_.push_back(fe::assemble_rotor(model, rotors_[j], case_.damping[j]));
    const auto& m = matrices_.back();
    if (rotors_[j].is_spatial && rotors_[j].frame == fe::RotorFrame::Fixed && m.circulation.norm() > 0)
      diagnostics.error(
          "modal.rotor-unsupported", case_.axes[j].at,
          "damping inside rotor " + std::to_string(rotors_[j].id) +
              ", whose grids are around its axis, is not supported in the fixed frame",
          "leave GR, GE, ALPHAR1, ALPHAR2 and its dampers out, or solve in the rotating frame (ROTORD with "
          "REFSYS = ROT)");
    // A_I: accelerations, angular accelerations, then squares and products of the spin.
    const fe::Prestress* prestress = model.prestress();
    if (rotors_[j].is_spatial && prestress != nullptr && !prestress->A_I.tail<6>().isZero(0))
      diagnostics.error("modal.rotor-unsupported", prestress->at,
                        "the preload by " + prestress->name +
                            " has the centrifugal load of RFORCE, whose stress rotor " + std::to_string(rotors_[j].id) +
                            " has already, at each speed",
                        "leave RFORCE out of STATSUB, or name its set in RFORCE of ROTORD");
    centrifugal_.push_back(calc_centrifugal_stiffness(model, rotors_[j], m.centrifugal));
    model_structural_ += fe::assemble_rotor_structural(model, rotors_[j], g);
  }
  diagnostics.throw_if_errors();
}

fe::SparseColumns RotorTerms::sum(const std::function<double(std::size_t)>& factor,
                                  fe::SparseColumns fe::RotorMatrices::*member) const {
  fe::SparseColumns total(num_gdofs_, num_gdofs_);
  for (std::size_t j = 0; j < matrices_.size(); ++j)
    if (const double f = factor(j); f != 0) total += f * matrices_[j].*member;
  return total;
}

fe::SparseColumns RotorTerms::calc_damping(double reference) const {
  return sum([&](std::size_t j) { return case_.relations[j].evaluate(reference); }, &fe::RotorMatrices::gyroscopic) +
         sum([](std::size_t) { return 1.0; }, &fe::RotorMatrices::damping);
}
fe::SparseColumns RotorTerms::calc_circulation(double reference) const {
  return sum([&](std::size_t j) { return case_.relations[j].evaluate(reference); }, &fe::RotorMatrices::circulation);
}

fe::SparseColumns RotorTerms::calc_centrifugal(double reference) const {
  return sum_centrifugal([&](std::size_t j) { return std::pow(case_.relations[j].evaluate(reference), 2); });
}

fe::SparseColumns RotorTerms::sum_centrifugal(const std::function<double(std::size_t)>& factor) const {
  fe::SparseColumns total(num_gdofs_, num_gdofs_);
  for (std::size_t j = 0; j < centrifugal_.size(); ++j)
    if (const double f = factor(j); f != 0) total += f * centrifugal_[j];
  return total;
}

RotorTerms::Synchronous RotorTerms::calc_synchronous() const {
  const auto offset = [&](std::size_t j) { return case_.relations[j].find_line().value_or(std::pair(0.0, 1.0)).first; };
  const auto rate = [&](std::size_t j) { return case_.relations[j].find_line().value_or(std::pair(0.0, 1.0)).second; };
  return {
      sum(offset, &fe::RotorMatrices::gyroscopic) + sum([](std::size_t) { return 1.0; }, &fe::RotorMatrices::damping),
      sum(offset, &fe::RotorMatrices::circulation),
      sum(rate, &fe::RotorMatrices::gyroscopic),
      sum(rate, &fe::RotorMatrices::circulation),
      sum_centrifugal([&](std::size_t j) { return offset(j) * offset(j); }),
      sum_centrifugal([&](std::size_t j) { return 2 * offset(j) * rate(j); }),
      sum_centrifugal([&](std::size_t j) { return rate(j) * rate(j); })};
}

fe::SparseColumns RotorTerms::calc_structural() const {
  return sum([](std::size_t) { return 1.0; }, &fe::RotorMatrices::structural);
}
fe::SparseColumns RotorTerms::calc_structural_circulation(double reference, double omega) const {
  return sum([&](std::size_t j) { return omega > 0 ? case_.relations[j].evaluate(reference) / omega : 0.0; },
             &fe::RotorMatrices::structural_circulation);
}

}  // namespace bough::modal::rotors
