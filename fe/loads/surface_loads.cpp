#include <algorithm>
#include <unordered_map>

#include "fe/loads/load_sets.hpp"
#include "fe/shape/face_load.hpp"
#include "fe/shape/solid_shape.hpp"

namespace bough::fe {
namespace {

/// A face as grid ids: corners in the order of its normal, the midside grid after each corner (0: none), or the two
/// grids of each side of a cubic brick.
struct Face {
  std::vector<int> corners, midside;
};

// Faces of the solids by corner position, outward normal by the right-hand rule.
using FaceTable = std::vector<std::vector<int>>;
const FaceTable& get_faces(SolidKind kind) {
  static const FaceTable hexa{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  static const FaceTable penta{{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
  static const FaceTable tetra{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  static const FaceTable pyramid{{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  if (kind == SolidKind::Pyramid) return pyramid;
  return kind == SolidKind::Hexa ? hexa : kind == SolidKind::Penta ? penta : tetra;
}

/// The grids between corners i and j, on the way from i to j.
void add_side(const records::SolidElement& solid, SolidKind kind, int i, int j, std::vector<int>& midside) {
  const bool is_third = is_cubic(solid.midsides);
  const auto& edges = get_edges(kind);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const bool is_along = edges[e].first == i && edges[e].second == j;
    if (!is_along && !(edges[e].first == j && edges[e].second == i)) continue;
    if (is_third) {
      midside.push_back(solid.midsides[2 * e + (is_along ? 0 : 1)]);
      midside.push_back(solid.midsides[2 * e + (is_along ? 1 : 0)]);
    } else {
      midside.push_back(e < solid.midsides.size() ? solid.midsides[e] : 0);
    }
  }
}

/// The face that G1 with G3 or G4 names (Nastran Quick Reference Guide, PLOAD4), begun at G1; empty when none.
Face find_solid_face(const records::SolidElement& solid, int g1, int g34) {
  const SolidKind kind = solid.corners.size() == 8   ? SolidKind::Hexa
                         : solid.corners.size() == 6 ? SolidKind::Penta
                         : solid.corners.size() == 5 ? SolidKind::Pyramid
                                                     : SolidKind::Tetra;
  const auto position = [&](int grid) {
    return static_cast<int>(std::find(solid.corners.begin(), solid.corners.end(), grid) - solid.corners.begin());
  };
  const int a = position(g1), b = g34 > 0 ? position(g34) : -1;
  for (const auto& face : get_faces(kind)) {
    const auto start = std::find(face.begin(), face.end(), a);
    if (start == face.end()) continue;
    const int n = static_cast<int>(face.size()), first = static_cast<int>(start - face.begin());
    const bool has_b = std::find(face.begin(), face.end(), b) != face.end();
    // A triangle of a pyramid: G1 with the next corner of the base, counted either way, and the apex.
    const bool is_side = kind == SolidKind::Pyramid && n == 3;
    const bool matches = kind == SolidKind::Tetra ? b >= 0 && b < 4 && !has_b
                         : is_side                ? b >= 0 && a < 4 && has_b && b < 4
                         : n == 3                 ? b < 0
                                                  : b >= 0 && face[static_cast<std::size_t>((first + 2) % 4)] == b;
    if (!matches) continue;
    Face result;
    for (int k = 0; k < n; ++k) {
      const int i = face[static_cast<std::size_t>((first + k) % n)],
                j = face[static_cast<std::size_t>((first + k + 1) % n)];
      result.corners.push_back(solid.corners[static_cast<std::size_t>(i)]);
      add_side(solid, kind, i, j, result.midside);
    }
    return result;
  }
  return {};
}

class SurfaceLoads {
 public:
  explicit SurfaceLoads(const LoadTarget& target) : t_(target) {
    for (const auto& shell : t_.deck.shells) shells_[shell.id] = &shell;
    for (const auto& solid : t_.deck.solids) solids_[solid.id] = &solid;
    const auto* param = t_.deck.find_param("FOLLOWK");
    follows_ = param && (param->value == "YES" || param->value == "Y");
  }

  void add(const records::GridPressure& load) {
    std::vector<double> p(load.grids.size(), load.p);
    add_face({load.grids, {}}, p, "PLOAD", load.at, 1,
             [](double value, const Vector3d&, const Vector3d& n) { return Vector3d(value * n); });
  }

  void add(const records::ElementPressure& load) {
    const std::string card = "pressure on element " + std::to_string(load.element);
    const auto shell = shells_.find(load.element);
    const auto solid = solids_.find(load.element);
    Face face;
    double sign = 1;
    if (shell != shells_.end() && solid != solids_.end()) {
      t_.diagnostics.error("fe.ambiguous-element", t_.deck.locate(load.at),
                           card + ": a shell and a " + solid->second->card + " have this id",
                           "give one of them another id");
      return;
    }
    if (shell != shells_.end()) {
      face.corners = shell->second->grids;
      face.midside = shell->second->midsides;
    } else if (solid != solids_.end()) {
      face = find_solid_face(*solid->second, load.g1, load.g34);
      sign = -1;  // inward
      if (face.corners.empty()) {
        t_.diagnostics.error("fe.bad-face", t_.deck.locate(load.at),
                             card +
                                 (load.g1 == 0 ? std::string(" names no face of the ")
                                               : " names grids " + std::to_string(load.g1) + " and " +
                                                     std::to_string(load.g34) + ", which are no face of the ") +
                                 solid->second->card,
                             load.g1 == 0
                                 ? "solids take PLOAD4 with G1 at a corner of the face and G3 diagonally opposite on it"
                                 : "give G1 at a corner, with G3 diagonally opposite on the face (CTETRA: G4 "
                                   "off the face)");
        return;
      }
    } else {
      if (!load.skip_if_missing)
        t_.diagnostics.error("fe.missing-element", t_.deck.locate(load.at), card + ": no shell or solid has this id",
                             "correct the element id");
      return;
    }
    if (solid != solids_.end()) turn_outward(*solid->second, face);
    std::vector<double> p(load.p.begin(), load.p.begin() + static_cast<std::ptrdiff_t>(face.corners.size()));
    const SourceLocation at = t_.deck.locate(load.at);
    add_face(face, p, card, load.at, load.n ? 0 : sign,
             [&](double value, const Vector3d& x, const Vector3d& n) -> Vector3d {
               if (!load.n) return sign * value * n;
               return value * (t_.model.calc_axes(load.cid, x, at, t_.diagnostics) * load.n->normalized());
             });
  }

 private:
  /// Reverses a face of a left-handed solid, whose normal points inward; the first corner stays first.
  void turn_outward(const records::SolidElement& solid, Face& face) const {
    const auto sum = [&](const std::vector<int>& grids) {
      Vector3d x = Vector3d::Zero();
      for (int grid : grids)
        if (const int k = t_.model.find_node(grid); k >= 0) x += t_.model.node(k).x / static_cast<double>(grids.size());
      return x;
    };
    const Vector3d inside = sum(solid.corners), middle = sum(face.corners);
    Vector3d normal = Vector3d::Zero();
    const std::size_t n = face.corners.size();
    for (std::size_t i = 0; i < n; ++i)
      normal += (sum({face.corners[i]}) - middle).cross(sum({face.corners[(i + 1) % n]}) - middle);
    if (normal.dot(middle - inside) >= 0) return;
    std::reverse(face.corners.begin() + 1, face.corners.end());
    std::reverse(face.midside.begin(), face.midside.end());
  }

  /// `follows`: times the normal, the direction of a traction that turns with the face; 0: it does not.
  void add_face(const Face& face, const std::vector<double>& p, const std::string& card,
                const records::CardLocation& at, double follows, const Traction& traction) {
    std::vector<int> nodes;
    std::vector<Vector3d> corners, midside;
    std::vector<char> has_midside;
    bool is_valid = true;
    const auto add_node = [&](int grid) {
      const int index = t_.find_grid(grid, card, at);
      is_valid = is_valid && index >= 0;
      nodes.push_back(index);
      return index >= 0 ? t_.model.node(index).x : Vector3d(Vector3d::Zero());
    };
    for (int grid : face.corners) corners.push_back(add_node(grid));
    for (int grid : face.midside) {
      has_midside.push_back(grid > 0);
      midside.push_back(grid > 0 ? add_node(grid) : Vector3d(Vector3d::Zero()));
    }
    if (!is_valid) return;
    const Eigen::Matrix3Xd f = calc_face_load(corners, midside, has_midside, p, traction);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      t_.F.segment<3>(t_.model.node(nodes[i]).first_gdof) += t_.scale * f.col(static_cast<Eigen::Index>(i));
    if (follows == 0) return;
    if (t_.moving) {
      FollowerPressure& moving = t_.moving->pressures.emplace_back();
      moving.nodes = nodes;
      moving.has_midside = has_midside;
      for (const double value : p) moving.p.push_back(follows * t_.scale * value);
    }
    if (!follows_) return;
    const MatrixXd whole = follows * t_.scale * calc_follower_stiffness(corners, midside, has_midside, p),
                   K = 0.5 * (whole + whole.transpose());
    const auto size = static_cast<int>(K.rows());
    QuadraticForm form{{}, MatrixXd::Identity(size, size), MatrixXd(size * (size + 1) / 2, 1)};
    for (const int node : nodes)
      for (int a = 0; a < 3; ++a) form.gdofs.push_back(t_.model.node(node).first_gdof + a);
    for (int j = 0; j < size; ++j)
      for (int i = j; i < size; ++i) form.weights(find_weight(size, i, j), 0) = K(i, j);
    t_.followers.push_back(std::move(form));
  }

  const LoadTarget& t_;
  bool follows_ = false;
  std::unordered_map<int, const records::ShellElement*> shells_;
  std::unordered_map<int, const records::SolidElement*> solids_;
};

}  // namespace

bool add_surface_loads(const LoadTarget& t) {
  const auto& cards = t.deck.load_cards;
  const auto is_here = [&](const auto& load) { return load.sid == t.set; };
  if (std::none_of(cards.grid_pressures.begin(), cards.grid_pressures.end(), is_here) &&
      std::none_of(cards.pressures.begin(), cards.pressures.end(), is_here))
    return false;
  SurfaceLoads loads(t);
  for (const auto& load : cards.grid_pressures)
    if (is_here(load)) loads.add(load);
  for (const auto& load : cards.pressures)
    if (is_here(load)) loads.add(load);
  return true;
}

}  // namespace bough::fe
