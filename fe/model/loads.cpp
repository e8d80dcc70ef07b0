#include <algorithm>

#include "bough/fe/assembly.hpp"

namespace bough::fe {
namespace {

/// Adds `scale` times the plain cards of one set; false when there are none.
bool add_plain_set(const Model& model, const records::Deck& deck, int set, double scale, VectorXd& F,
                   Diagnostics& diagnostics) {
  bool is_found = false;
  for (const auto& load : deck.point_loads) {
    if (load.sid != set) continue;
    is_found = true;
    const SourceLocation at = deck.locate(load.at);
    const int index = model.find_node(load.g);
    if (index < 0 || model.node(index).num_dofs != 6) {
      diagnostics.error("fe.missing-grid", at,
                        std::string(load.is_moment ? "MOMENT" : "FORCE") + " names grid " + std::to_string(load.g) +
                            ", which the deck does not define",
                        "add the GRID or correct the id");
      continue;
    }
    const Node& node = model.node(index);
    const Matrix3d R = model.calc_axes(load.cid, node.x, at, diagnostics);
    F.segment<3>(node.first_gdof + (load.is_moment ? 3 : 0)) += scale * load.f * (R * load.n);
  }
  Vector3d acceleration = Vector3d::Zero();
  for (const auto& gravity : deck.gravity) {
    if (gravity.sid != set) continue;
    is_found = true;
    const SourceLocation at = deck.locate(gravity.at);
    const Vector3d origin = model.calc_point(0, Vector3d::Zero(), at, diagnostics);
    acceleration += scale * gravity.a * (model.calc_axes(gravity.cid, origin, at, diagnostics) * gravity.n);
  }
  if (!acceleration.isZero(0))
    F += calc_mass_times(model, model.mass_kind(), model.calc_rigid_modes().leftCols<3>() * acceleration);
  return is_found;
}

}  // namespace

VectorXd Model::calc_load(const records::Deck& deck, int set, Diagnostics& diagnostics) const {
  VectorXd F = VectorXd::Zero(num_gdofs_);
  const auto report_missing = [&](int sid, const SourceLocation& at) {
    diagnostics.error("fe.missing-load", at,
                      "load set " + std::to_string(sid) + " has no FORCE, MOMENT, GRAV or LOAD card",
                      "correct the set id or add its cards");
  };
  const auto combination =
      std::find_if(deck.loads.begin(), deck.loads.end(), [&](const auto& l) { return l.sid == set; });
  if (combination == deck.loads.end()) {
    if (!add_plain_set(*this, deck, set, 1, F, diagnostics)) report_missing(set, deck.locate({}));
    return F;
  }
  for (const auto& [scale, sid] : combination->terms)
    if (!add_plain_set(*this, deck, sid, combination->s * scale, F, diagnostics))
      report_missing(sid, deck.locate(combination->at));
  return F;
}

}  // namespace bough::fe
