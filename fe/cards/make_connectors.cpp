#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>

#include "base/number_text.hpp"
#include "fe/cards/shell_card.hpp"
#include "fe/cards/shell_patch.hpp"
#include "fe/elements/beam.hpp"
#include "fe/elements/bush.hpp"
#include "fe/elements/connector.hpp"

namespace bough::fe {
namespace {

constexpr int kMaxShrinks = 4;        ///< halvings of the square of a connector at the rim of its patch
constexpr double kNoLength = 1e-6;    ///< of the diameter: ends that coincide
constexpr double kMaxAngleDeg = 20;   ///< between the shells (GSPROJ of SWLDPRM)
constexpr double kEqualAxes = 1e-6;   ///< difference of components of a unit vector
constexpr double kShearFactor = 0.9;  ///< of a round section (PWELD)

using PatchEnds = std::array<PatchEnd, 2>;

/// One end: the shells on which it is, and its point.
struct End {
  FacetList patch;  ///< empty with `of_property`
  const FacetTree* of_property = nullptr;
  std::string name;  ///< "shell 7", "property 3"
  FacetPoint at;
};

class ConnectorMaker {
 public:
  explicit ConnectorMaker(Maker& maker)
      : maker_(maker),
        facets_(maker.deck(), maker.nodes()),
        pfast_(maker.deck().special.pfast),
        pweld_(maker.deck().special.pweld),
        pshell_(maker.deck().pshell),
        pcomp_(maker.deck().pcomp),
        shell_cards_(maker.deck().shells) {}

  void make(const records::Cfast& card) {
    begin("CFAST", card.id, card.at);
    const auto* property = pfast_.find(card.pid);
    if (!property) return maker_.report_missing_property(card.pid, "PFAST", who_, card.at);
    if (card.gb == 0 && !check_sides(card.ida, card.idb, card.by_elements ? "shell" : "property")) return;
    if (has_no_stiffness(*property) && reported_.insert(property->id).second)
      maker_.diagnostics().warning(
          "fe.connector-stiffness", maker_.deck().locate(property->at),
          "PFAST " + std::to_string(property->id) +
              " has no stiffness: KT1 to KR3 are zero or blank, and its fasteners join nothing",
          "give KT1 to KR3, or delete the fasteners");
    std::array<End, 2> ends;
    const std::array<int, 2> ids{card.ida, card.idb};
    for (std::size_t k = 0; k < 2; ++k)
      if (!(card.by_elements ? find_around(ids[k], ends[k]) : find_property(ids[k], ends[k]))) return;
    if (!place(ends, card.gs, card.ga, card.gb, card.xs)) return;
    const auto motion = fit_ends(ends, property->d);
    if (!motion) return;
    BushData data;
    const auto axes = find_axes(*property, ends);
    if (!axes) return;
    data.R_basic_element = *axes;
    for (std::size_t i = 0; i < 3; ++i) data.k[i] = property->kt[i], data.k[3 + i] = property->kr[i];
    const Vector3d middle = 0.5 * (ends[0].at.x + ends[1].at.x);
    data.arm_a = middle - ends[0].at.x;
    data.arm_b = middle - ends[1].at.x;
    add(card.id, "CFAST", *motion, property->mass,
        std::make_unique<Bush>(card.id, "CFAST", std::vector<int>{0, 1}, list_core_dofs(), data), property->ge);
  }

  void make(const records::Cweld& card) {
    begin("CWELD", card.id, card.at);
    const auto* property = pweld_.find(card.pid);
    if (!property) return maker_.report_missing_property(card.pid, "PWELD", who_, card.at);
    const auto* material = maker_.find_material(property->mid, "PWELD " + std::to_string(property->id), property->at);
    if (!material) return;
    std::array<End, 2> ends;
    std::array<ShellFacet, 2> own;
    if (card.format == "ALIGN") {
      make_between_grids(card, *property, *material);
      return;
    }
    if (card.format == "GRIDID" && card.grids_b.empty()) return fail_point();
    if (card.format != "GRIDID" && card.idb == 0) return fail_point();
    if (card.format != "GRIDID" && card.gb == 0 &&
        !check_sides(card.ida, card.idb, card.format == "PARTPAT" ? "property" : "shell"))
      return;
    const std::array<int, 2> ids{card.ida, card.idb};
    for (std::size_t k = 0; k < 2; ++k) {
      bool is_found = false;
      if (card.format == "PARTPAT") is_found = find_property(ids[k], ends[k]);
      if (card.format == "ELPAT") is_found = find_around(ids[k], ends[k]);
      if (card.format == "ELEMID") {
        is_found = find_around(ids[k], ends[k]);
        if (is_found) ends[k].patch.resize(1);
      }
      if (card.format == "GRIDID") is_found = make_facet(card, k, own[k], ends[k]);
      if (!is_found) return;
    }
    if (!place(ends, card.gs, card.ga, card.gb, card.xs)) return;
    std::optional<PatchEnds> motion;
    if (card.format == "ELPAT" || card.format == "PARTPAT")
      motion = fit_ends(ends, property->d);
    else
      motion = {follow_facet(ends[0].at), follow_facet(ends[1].at)};
    if (!motion) return;
    double length = (ends[1].at.x - ends[0].at.x).norm();
    add_beam(card, *property, *material, *motion, ends[0].at.x, ends[1].at.x,
             length > kNoLength * property->d ? Vector3d((ends[1].at.x - ends[0].at.x) / length) : ends[0].at.normal,
             property->is_spot ? 0.5 * (find_thickness(ends[0]) + find_thickness(ends[1])) : 0);
  }

 private:
  void begin(const char* card, int id, const records::CardLocation& at) {
    who_ = std::string(card) + " " + std::to_string(id);
    at_ = at;
    shells_.clear();
  }

  static std::vector<int> list_core_dofs() { return {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}; }

  static bool has_no_stiffness(const records::Pfast& p) {
    const auto is_zero = [](double k) { return k == 0; };
    return std::all_of(p.kt.begin(), p.kt.end(), is_zero) && std::all_of(p.kr.begin(), p.kr.end(), is_zero);
  }

  /// A patch that is joined to itself has both ends at one point.
  bool check_sides(int a, int b, const char* what) {
    if (a != b) return true;
    maker_.error("fe.connector-sides", at_,
                 who_ + " names " + what + " " + std::to_string(a) + " on both sides: it would join a point to itself",
                 std::string("name the ") + what + " of the other side");
    return false;
  }

  void fail_point() {
    maker_.error("fe.connector-form", at_, who_ + " joins a point to a patch: side B names no shell",
                 "give the shells of both sides, or an RBE3 with a CBUSH");
  }

  bool find_property(int pid, End& end) {
    end.of_property = facets_.find_property(pid);
    end.name = "property " + std::to_string(pid);
    if (end.of_property) return true;
    maker_.error("fe.connector-shell", at_,
                 who_ + " names property " + std::to_string(pid) + ", of which the deck has no shell",
                 "correct the id");
    return false;
  }
  bool find_around(int id, End& end) {
    const auto* facet = facets_.find_element(id);
    end.name = "shell " + std::to_string(id);
    if (!facet) {
      maker_.error("fe.connector-shell", at_,
                   who_ + " names shell " + std::to_string(id) + ", which the deck does not define", "correct the id");
      return false;
    }
    end.patch = facets_.list_around(*facet);
    shells_.insert(id);
    return true;
  }
  /// GRIDID: a facet of the grids of the card.
  bool make_facet(const records::Cweld& card, std::size_t side, ShellFacet& facet, End& end) {
    const auto& grids = side == 0 ? card.grids_a : card.grids_b;
    const char type = card.types[std::min(side, card.types.size() - 1)];
    const std::size_t corners = type == 'T' ? 3 : 4;
    end.name = std::string("the grids of side ") + (side == 0 ? "A" : "B");
    for (const int g : grids)
      if (maker_.find_grid(g, who_, at_) < 0) return false;
    if (grids.size() < corners || grids.size() > 2 * corners) {
      maker_.error("fe.connector-shell", at_,
                   who_ + " has " + std::to_string(grids.size()) + " grids on side " + (side == 0 ? "A" : "B") +
                       ", expected " + std::to_string(corners) + " to " + std::to_string(2 * corners) + " by SPTYP",
                   "correct SPTYP or the grids");
      return false;
    }
    std::vector<int> midsides(grids.begin() + static_cast<std::ptrdiff_t>(corners), grids.end());
    if (!midsides.empty()) midsides.resize(corners, 0);
    facets_.fill(facet, {grids.begin(), grids.begin() + static_cast<std::ptrdiff_t>(corners)}, midsides);
    end.patch = {&facet};
    return true;
  }

  std::optional<Vector3d> find_place(int grid) {
    const int index = maker_.find_grid(grid, who_, at_);
    return index < 0 ? std::nullopt : std::optional(maker_.nodes().node(index).x);
  }

  /// Points of the ends: projections of GS or XS, or of GA and GB.
  bool place(std::array<End, 2>& ends, int gs, int ga, int gb, const Vector3d& xs) {
    Vector3d from = xs;
    if (gs > 0 || ga > 0) {
      const auto found = find_place(gs > 0 ? gs : ga);
      if (!found) return false;
      from = *found;
    }
    for (std::size_t k = 0; k < 2; ++k) {
      const int own = k == 0 ? ga : gb;
      const auto place = own > 0 ? find_place(own) : std::optional(k == 0 || own > 0 || gs > 0 ? from : ends[0].at.x);
      if (!place) return false;
      const auto found = ends[k].of_property ? ends[k].of_property->project(*place) : project(ends[k].patch, *place);
      if (!found) {
        maker_.error("fe.connector-projection", at_, who_ + ": its place has no projection on " + ends[k].name,
                     "move it onto the shells of both sides, or name other shells");
        return false;
      }
      ends[k].at = *found;
      add_shell(*found);
    }
    const double cosine = std::abs(ends[0].at.normal.dot(ends[1].at.normal));
    if (cosine < std::cos(kMaxAngleDeg * std::numbers::pi / 180))
      maker_.diagnostics().warning("fe.connector-angle", maker_.deck().locate(at_),
                                   who_ + ": the shells of its sides enclose " +
                                       show_number(std::acos(std::min(cosine, 1.0)) * 180 / std::numbers::pi) +
                                       " degrees, expected at most 20",
                                   "check its place and the shells");
    return true;
  }

  void add_shell(const FacetPoint& point) {
    if (point.facet->element > 0) shells_.insert(point.facet->element);
  }

  /// Motion of both ends by the squares of the area of the section around them.
  std::optional<PatchEnds> fit_ends(const std::array<End, 2>& ends, double diameter) {
    const Vector3d chord = ends[1].at.x - ends[0].at.x;
    PatchEnds motion;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto& end = ends[k];
      const Vector3d axis = chord.norm() > kNoLength * diameter ? Vector3d(chord.normalized()) : end.at.normal;
      // Along the first side of the shell, as far as it is across the axis.
      Vector3d along = end.at.facet->x.col(1) - end.at.facet->x.col(0);
      along = (along - along.dot(axis) * axis).normalized();
      const Vector3d across = axis.cross(along);
      // Facets that the square may be on.
      const FacetList near =
          end.of_property ? end.of_property->list_near(end.at.x, diameter) : list_near(end.patch, end.at.x, diameter);
      double half = 0.25 * std::sqrt(std::numbers::pi) * diameter;
      std::vector<FacetPoint> points;
      for (int i = 0; i <= kMaxShrinks && points.size() < 4; ++i, half /= 2) {
        points.clear();
        for (const auto& [a, b] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
          const auto found = project(near, end.at.x + half * (a * along + b * across));
          if (found) points.push_back(*found);
        }
      }
      if (points.size() < 4) {
        maker_.error("fe.connector-projection", at_,
                     who_ + ": the square of its section reaches beyond " + end.name + ", also with " +
                         show_number(diameter / (1 << kMaxShrinks)) + " in place of the diameter " +
                         show_number(diameter) + ": its place is on the rim",
                     "move its place away from the rim, or name shells that continue there");
        return std::nullopt;
      }
      motion[k] = fit_points(points, end.at.x);
      for (const auto& point : points) add_shell(point);
    }
    return motion;
  }

  /// Axes of the springs: x from A to B, or normal to the shell of A where the ends coincide.
  std::optional<Matrix3d> find_axes(const records::Pfast& property, const std::array<End, 2>& ends) {
    const Vector3d chord = ends[1].at.x - ends[0].at.x;
    const Vector3d e1 = chord.norm() > kNoLength * property.d ? Vector3d(chord.normalized()) : ends[0].at.normal;
    Matrix3d of_card = Matrix3d::Identity();
    if (property.mcid >= 0) {
      const int before = maker_.diagnostics().num_errors();
      of_card = maker_.nodes().calc_axes(property.mcid, ends[0].at.x, maker_.deck().locate(property.at),
                                         maker_.diagnostics());
      if (maker_.diagnostics().num_errors() > before) return std::nullopt;
      if (property.mflag == 0) return of_card;
    }
    Vector3d e3;
    if (property.mcid >= 0) {
      const Vector3d y = of_card.col(1), z = of_card.col(2);
      e3 = e1.cross(e1.cross(y).norm() > 1e-6 ? y : z);
    } else {
      Eigen::Index axis = 0;  // the first of components that differ by round-off
      while (std::abs(e1[axis]) > e1.cwiseAbs().minCoeff() + kEqualAxes) ++axis;
      e3 = e1.cross(Vector3d(Vector3d::Unit(axis)));
    }
    e3.normalize();
    Matrix3d R;
    R << e1, e3.cross(e1), e3;
    return R;
  }

  /// Thickness of the shell of an end: mean of T1... of the element, as its stiffness has it, T of PSHELL, plies.
  double find_thickness(const End& end) const {
    const int pid = end.at.facet->property;
    if (const auto* laminate = pcomp_.find(pid)) {
      double sum = 0;
      for (const auto& ply : laminate->plies) sum += ply.t;
      return sum;
    }
    const auto* property = pshell_.find(pid);
    const double own = property && property->t ? *property->t : 0;
    const auto* shell = shell_cards_.find(end.at.facet->element);
    if (!shell || shell->t.empty()) return own;
    const auto corners = list_thicknesses(*shell, own);
    return std::accumulate(corners.begin(), corners.end(), 0.0) / static_cast<double>(corners.size());
  }

  /// ALIGN: the beam is between the grids themselves.
  void make_between_grids(const records::Cweld& card, const records::Pweld& property, const records::Mat1& material) {
    const int a = maker_.find_grid(card.ga, who_, at_), b = maker_.find_grid(card.gb, who_, at_);
    if (a < 0 || b < 0) return;
    const Vector3d x_a = maker_.nodes().node(a).x, x_b = maker_.nodes().node(b).x;
    if (!((x_b - x_a).norm() > kNoLength * property.d)) {
      maker_.error("fe.zero-length", at_, who_ + " has its grids at the same place", "correct the grids");
      return;
    }
    whole_ = {a, b};
    add_beam(card, property, material, {}, x_a, x_b, (x_b - x_a).normalized(), 0);
    whole_.reset();
  }

  /// \param e1  along the beam. \param spot_length  SPOT: length of the stiffness; 0: by LDMIN and LDMAX.
  void add_beam(const records::Cweld& card, const records::Pweld& property, const records::Mat1& material,
                const PatchEnds& motion, const Vector3d& x_a, const Vector3d& x_b, const Vector3d& e1,
                double spot_length) {
    const double d = property.d, length = (x_b - x_a).norm(), area = std::numbers::pi * d * d / 4,
                 inertia = std::numbers::pi * std::pow(d, 4) / 64;
    const double effective =
        spot_length > 0 ? spot_length : std::clamp(length, property.ld_min * d, property.ld_max * d);
    Matrix3d R;
    const Vector3d e2 = e1.unitOrthogonal();
    R << e1, e2, e1.cross(e2);
    std::unique_ptr<const Element> core;
    if (length > kNoLength * d) {
      auto beam = std::make_shared<BeamProperty>();
      const double scale = length / effective;
      beam->material.E = material.E * scale;
      beam->material.G = material.G * scale;
      beam->k1 = beam->k2 = kShearFactor;
      BeamSection section;
      section.A = area, section.I1 = section.I2 = inertia, section.J = 2 * inertia;
      beam->stations = {section};
      BeamGeometry geometry;
      geometry.R_basic_element = R;
      geometry.length = length;
      core =
          std::make_unique<Beam>(card.id, "CWELD", std::vector<int>{0, 1}, list_core_dofs(), std::move(beam), geometry);
    } else {  // a beam of the effective length between ends at one place: shear and bending of its middle
      BushData data;
      data.R_basic_element = R;
      const double shear =
          1 / (std::pow(effective, 3) / (12 * material.E * inertia) + effective / (kShearFactor * material.G * area));
      data.k = {material.E * area / effective,
                shear,
                shear,
                2 * material.G * inertia / effective,
                material.E * inertia / effective,
                material.E * inertia / effective};
      core = std::make_unique<Bush>(card.id, "CWELD", std::vector<int>{0, 1}, list_core_dofs(), data);
    }
    add(card.id, "CWELD", motion, material.rho * area * length, std::move(core), material.ge);
  }

  void add(int id, const char* card, const PatchEnds& motion, double mass, std::unique_ptr<const Element> core,
           double ge) {
    std::map<int, Eigen::Index> slots;
    if (whole_) slots = {{(*whole_)[0], 0}, {(*whole_)[1], 1}};
    for (const auto& end : motion)
      for (const auto& [node, shares] : end.shares) slots.try_emplace(node, static_cast<Eigen::Index>(slots.size()));
    std::vector<int> nodes(slots.size());
    for (const auto& [node, slot] : slots) nodes[static_cast<std::size_t>(slot)] = node;
    ConnectorData data;
    data.mass = mass;
    data.shells.assign(shells_.begin(), shells_.end());
    data.G = MatrixXd::Zero(12, 6 * static_cast<Eigen::Index>(nodes.size()));
    data.weights = MatrixXd::Zero(2, static_cast<Eigen::Index>(nodes.size()));
    if (whole_) {
      data.G.setIdentity();
      data.weights.setIdentity();
    }
    for (int k = 0; k < 2 && !whole_; ++k) {
      const PatchEnd& end = motion[static_cast<std::size_t>(k)];
      auto& [x, shares, rotation] = data.ends.emplace_back();
      x = end.x;
      shares = MatrixXd::Zero(4, static_cast<Eigen::Index>(nodes.size()));
      rotation = end.rotation;
      for (const auto& [node, of_points] : end.shares) {
        const Eigen::Index slot = slots.at(node);
        shares.col(slot) = of_points;
        auto block = data.G.block<6, 3>(6 * k, 6 * slot);
        for (Eigen::Index p = 0; p < 4; ++p) block += of_points[p] * end.motion.middleCols<3>(3 * p);
        data.weights(k, slot) = block.topRows<3>().trace() / 3;
      }
    }
    auto gdofs = maker_.list_gdofs(nodes);
    maker_.add(
        std::make_unique<Connector>(id, card, std::move(nodes), std::move(gdofs), std::move(data), std::move(core)),
        ge);
  }

  Maker& maker_;
  ShellFacets facets_;
  RecordIndex<records::Pfast> pfast_;
  RecordIndex<records::Pweld> pweld_;
  RecordIndex<records::Pshell> pshell_;
  RecordIndex<records::Pcomp> pcomp_;
  RecordIndex<records::ShellElement> shell_cards_;
  std::set<int> reported_;  ///< PFAST
  std::string who_;
  records::CardLocation at_;
  std::set<int> shells_;                     ///< that the ends of the card are on
  std::optional<std::array<int, 2>> whole_;  ///< ends that are grids, with their rotations
};

}  // namespace

void make_connectors(Maker& maker) {
  const auto& special = maker.deck().special;
  if (special.cfast.empty() && special.cweld.empty()) return;
  ConnectorMaker connectors(maker);
  for (const auto& card : special.cfast) connectors.make(card);
  for (const auto& card : special.cweld) connectors.make(card);
}

}  // namespace bough::fe
