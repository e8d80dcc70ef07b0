#include "fe/statics/deformed_deck.hpp"

#include <algorithm>

#include <Eigen/SVD>

namespace bough::fe {
namespace {

using records::CoordKind;

class Turner {
 public:
  Turner(const records::Deck& deck, const Model& model, const DeformedState& state, Diagnostics& diagnostics)
      : old_(deck), model_(model), state_(state), diagnostics_(diagnostics), deck_(deck) {
    for (const auto& system : deck.coord_systems) last_system_ = std::max(last_system_, system.id);
  }

  records::Deck turn() && {
    refuse_fixed_cards();
    fix_coordinates();
    for (auto& grid : deck_.grids) move(grid);
    for (auto& card : deck_.beams) turn(card);
    for (auto& card : deck_.cbush) turn(card);
    for (auto& card : deck_.cbush1d)
      if (card.cid && card.gb != 0) card.cid = turn_axes(*card.cid, card.ga, {card.ga, card.gb}, card.at);
    for (auto& card : deck_.shells)
      if (card.mcid) card.mcid = turn_material(card);
    for (auto& card : deck_.conm1) card.cid = turn_axes(card.cid, card.g, {card.g}, card.at);
    for (auto& card : deck_.conm2) turn(card);
    return std::move(deck_);
  }

 private:
  /// Cards whose directions in space the deck cannot state otherwise.
  void refuse_fixed_cards() {
    const auto refuse = [&](const auto& cards, const std::string& name, const std::string& advice) {
      if (!cards.empty())
        diagnostics_.error("fe.nonlinear-preload", old_.locate(cards.front().at),
                           name + " cannot start from a deformed shape", advice);
    };
    const std::string advice = "use other elements there, or a preload without nonlinear = true";
    refuse(old_.special.cbend, "CBEND", advice);
    refuse(old_.special.genel, "GENEL", advice);
    refuse(old_.special.cgap, "CGAP", advice);
    refuse(old_.special.rspline, "RSPLINE", advice);
    refuse(old_.direct_matrices, "DMIG", advice);
    if (!old_.superelements.empty())
      diagnostics_.error("fe.nonlinear-preload", old_.locate({}), "superelements cannot start from a deformed shape",
                         advice);
    for (const auto& solid : old_.psolid) {
      const bool has_axes = std::any_of(old_.mat9.begin(), old_.mat9.end(),
                                        [&](const auto& material) { return material.id == solid.mid; });
      if (has_axes && solid.cordm >= 0)
        diagnostics_.error("fe.nonlinear-preload", old_.locate(solid.at),
                           "PSOLID " + std::to_string(solid.id) +
                               " has anisotropic material in axes that do not turn with its elements",
                           "give CORDM -1, or a preload without nonlinear = true");
    }
  }

  /// Systems by grids keep their place; axes that depend on the place are those of the undeformed grids.
  void fix_coordinates() {
    for (auto& system : deck_.coord_systems)
      if (system.by_grids) {
        system.by_grids = false;
        system.rid = 0;
        for (auto [point, grid] : {std::pair(&system.a, 0), std::pair(&system.b, 1), std::pair(&system.c, 2)})
          *point = find_node(system.grids[static_cast<std::size_t>(grid)]).x;
      }
    for (auto& load : deck_.point_loads)
      if (is_curved(load.cid)) {
        load.n = model_.calc_axes(load.cid, find_node(load.g).x, old_.locate(load.at), diagnostics_) * load.n;
        load.cid = 0;
      }
  }

  bool is_curved(int cid) const {
    return std::any_of(old_.coord_systems.begin(), old_.coord_systems.end(),
                       [&](const auto& system) { return system.id == cid && system.kind != CoordKind::Rectangular; });
  }
  const Node& find_node(int id) const { return model_.node(model_.find_node(id)); }
  const Matrix3d& get_rotation(int id) const { return state_.R[static_cast<std::size_t>(model_.find_node(id))]; }

  /// The rotation nearest to those of some grids.
  Matrix3d calc_mean_rotation(const std::vector<int>& grids) const {
    Matrix3d sum = Matrix3d::Zero();
    for (const int id : grids) sum += get_rotation(id);
    const Eigen::JacobiSVD<Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
    return svd.matrixU() * svd.matrixV().transpose();
  }

  /// Id of a new rectangular system with these axes at the origin.
  int add_axes(const Matrix3d& axes, const records::CardLocation& at) {
    records::CoordSystem system;
    system.id = ++last_system_;
    system.b = axes.col(2);
    system.c = axes.col(0);
    system.at = at;
    deck_.coord_systems.push_back(system);
    return system.id;
  }
  /// Axes of system cid at a grid, turned with the mean of some grids.
  int turn_axes(int cid, int grid, const std::vector<int>& grids, const records::CardLocation& at) {
    const Matrix3d axes = model_.calc_axes(cid, find_node(grid).x, old_.locate(at), diagnostics_);
    return add_axes(calc_mean_rotation(grids) * axes, at);
  }
  /// A vector in the displacement axes of a grid, turned by R.
  Vector3d turn_in_displacement_axes(int grid, const Matrix3d& R, const Vector3d& v) const {
    const Matrix3d& axes = find_node(grid).R_basic_cd;
    return axes.transpose() * (R * (axes * v));
  }

  void move(records::Grid& grid) {
    const Node& node = find_node(grid.id);
    grid.cp = 0;
    grid.x = node.x + state_.u.segment<3>(node.first_gdof);
    if (is_curved(grid.cd)) grid.cd = add_axes(node.R_basic_cd, grid.at);
  }

  void turn(records::BeamElement& card) {
    const Node& a = find_node(card.ga);
    const Matrix3d mean = calc_mean_rotation({card.ga, card.gb});
    Vector3d v = card.offt[0] == 'B' ? card.v : Vector3d(a.R_basic_cd * card.v);
    if (card.g0 > 0) v = find_node(card.g0).x - a.x;
    card.g0 = 0;
    card.offt[0] = 'B';
    card.v = mean * v;
    if (card.offt[1] == 'G') card.wa = turn_in_displacement_axes(card.ga, get_rotation(card.ga), card.wa);
    if (card.offt[2] == 'G') card.wb = turn_in_displacement_axes(card.gb, get_rotation(card.gb), card.wb);
  }

  void turn(records::Cbush& card) {
    if (card.gb == 0) return;  // grounded: its axes stay
    const std::vector<int> grids{card.ga, card.gb};
    if (card.ocid >= 0) card.ocid = turn_axes(card.ocid, card.ga, {card.ga}, card.at);
    if (card.cid) {
      card.cid = turn_axes(*card.cid, card.ga, grids, card.at);
      return;
    }
    const Matrix3d mean = calc_mean_rotation(grids);
    if (card.g0 > 0) {
      const Node& a = find_node(card.ga);
      card.v = a.R_basic_cd.transpose() * (mean * (find_node(card.g0).x - a.x));
      card.g0 = 0;
    } else if (card.v) {
      card.v = turn_in_displacement_axes(card.ga, mean, *card.v);
    }
  }

  int turn_material(const records::ShellElement& card) {
    Vector3d centre = Vector3d::Zero();
    for (const int id : card.grids) centre += find_node(id).x / static_cast<double>(card.grids.size());
    const Matrix3d axes = model_.calc_axes(*card.mcid, centre, old_.locate(card.at), diagnostics_);
    return add_axes(calc_mean_rotation(card.grids) * axes, card.at);
  }

  void turn(records::Conm2& card) {
    if (card.cid < 0) {  // the place of the mass
      card.x -= find_node(card.g).x;
      card.cid = 0;
    }
    card.cid = turn_axes(card.cid, card.g, {card.g}, card.at);
  }

  const records::Deck& old_;
  const Model& model_;
  const DeformedState& state_;
  Diagnostics& diagnostics_;
  records::Deck deck_;
  int last_system_ = 0;
};

}  // namespace

records::Deck make_deformed_deck(const records::Deck& deck, const Model& model, const DeformedState& state,
                                 Diagnostics& diagnostics) {
  return Turner(deck, model, state, diagnostics).turn();
}

}  // namespace bough::fe
