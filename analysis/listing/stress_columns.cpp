#include "analysis/listing/stress_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>

#include <Eigen/Eigenvalues>

#include "analysis/listing/element_columns.hpp"
#include "fe/cards/element_properties.hpp"
#include "fe/elements/solid.hpp"
#include "fe/elements/spring_rows.hpp"
#include "formats/records/group_names.hpp"

namespace bough::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kBlank = std::numeric_limits<double>::quiet_NaN();

/// Nastran's element types; plates of plies have others.
int find_stress_type(const std::string& card, fe::StressKind kind) {
  static const std::map<std::string, int> types{{"CROD", 1},    {"CBEAM", 2},   {"CTUBE", 3},   {"CONROD", 10},
                                                {"CQUAD4", 33}, {"CBAR", 34},   {"CTETRA", 39}, {"CHEXA", 67},
                                                {"CPENTA", 68}, {"CTRIA3", 74}, {"CPYRAM", 255}};
  const std::string plain = records::get_card_of_group(card);
  if (kind == fe::StressKind::Ply) return plain == "CQUAD4" ? 95 : plain == "CTRIA3" ? 97 : 0;
  const auto found = types.find(plain);
  return found == types.end() ? 0 : found->second;
}

/// The points C D E F of an end, and the extremes of all that it has: sections of the library have up to six, a bar
/// without points its axis.
struct EndStress {
  EndStress(const VectorXd& stress, bool is_b) {
    const Index count = stress.size() / 2;
    const auto own = stress.segment(is_b ? count : 0, count);
    for (Index i = 0; i < 4; ++i) at[static_cast<std::size_t>(i)] = own(i < count ? i : 0);
    high = own.maxCoeff();
    low = own.minCoeff();
  }
  std::array<double, 4> at{};
  double high = 0, low = 0;
};

/// SA1 to SA4 (bending alone), axial, largest, smallest, margin of tension; then those of end B and of compression.
VectorXd make_bar_stresses(const fe::Element& element, const VectorXd& forces, const VectorXd& stress,
                           const StressLimits& limits, bool of_strain) {
  VectorXd pull = VectorXd::Zero(forces.size());
  pull(0) = forces(0);
  const fe::StressRecovery& recovery = *element.stress_recovery();
  double axial = of_strain ? recovery.calc_strains(pull)(0, 0) : recovery.calc_stresses(pull)(0, 0);
  // The mean free expansion of the points is axial strain.
  if (of_strain) axial += (stress - recovery.calc_strains(forces).col(0)).mean();
  VectorXd row(15);
  double max_stress = -HUGE_VAL, min_stress = HUGE_VAL;
  for (int end = 0; end < 2; ++end) {
    const EndStress s(stress, end == 1);
    const Index first = end == 0 ? 0 : 8;
    for (int i = 0; i < 4; ++i) row(first + i) = s.at[static_cast<std::size_t>(i)] - axial;
    row(end == 0 ? 5 : 12) = s.high;
    row(end == 0 ? 6 : 13) = s.low;
    max_stress = std::max(max_stress, s.high);
    min_stress = std::min(min_stress, s.low);
  }
  row(4) = axial;
  row(7) = calc_margin(std::max(max_stress, 0.0), limits.tension);
  row(14) = calc_margin(std::min(min_stress, 0.0), limits.compression);
  return row;
}

/// Row of both ends: SXC to SXF, largest, smallest, margins of tension and compression.
VectorXd make_beam_stresses(const VectorXd& stress, const StressLimits& limits) {
  VectorXd row(16);
  for (int end = 0; end < 2; ++end) {
    const EndStress s(stress, end == 1);
    row.segment<8>(8 * end) << s.at[0], s.at[1], s.at[2], s.at[3], s.high, s.low,
        calc_margin(std::max(s.high, 0.0), limits.tension), calc_margin(std::min(s.low, 0.0), limits.compression);
  }
  return row;
}

VectorXd make_rod_stresses(const VectorXd& stress, const StressLimits& limits) {
  VectorXd row(4);
  row << stress(0), calc_margin(stress(0), stress(0) > 0 ? limits.tension : limits.compression), stress(1),
      calc_margin(stress(1), limits.shear);
  return row;
}

/// Angle of the major principal stress in degrees, major, minor.
std::array<double, 3> calc_principal(double x, double y, double xy) {
  const double mean = 0.5 * (x + y), radius = std::hypot(0.5 * (x - y), xy);
  return {0.5 * std::atan2(2 * xy, x - y) * 180 / M_PI, mean + radius, mean - radius};
}

/// Z1 and Z2 of the PSHELL; without them half the thickness, which the stress of a unit force tells.
std::array<double, 2> find_surfaces(const fe::Element& element, const records::Pshell* pshell) {
  double t = pshell ? pshell->t.value_or(0) : 0;
  Eigen::VectorXd pull = VectorXd::Zero(element.stress_state()->num_internal_forces());
  const auto names = element.stress_state()->internal_force_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i].substr(0, names[i].find('@')) == "Nx") pull(static_cast<Index>(i)) = 1;
  if (const double stress = element.stress_recovery()->calc_stresses(pull)(0, 0); stress > 0) t = 1 / stress;
  return {pshell && pshell->z1 ? *pshell->z1 : -0.5 * t, pshell && pshell->z2 ? *pshell->z2 : 0.5 * t};
}

/// Distance, x y xy, angle, major, minor, von Mises of the lower, then of the upper surface, in axes turned by `angle`;
/// shears of strains are angles.
VectorXd make_plate_row(const std::array<double, 2>& z, const VectorXd& values, double angle, bool of_strain) {
  VectorXd row(16);
  for (int side = 0; side < 2; ++side) {
    Eigen::Vector3d s = values.segment<3>(3 * side);
    if (of_strain) s = fe::halve_shears(fe::StressKind::Plane, s);
    s = turn_plane(s, angle);
    const auto [at, major, minor] = calc_principal(s(0), s(1), s(2));
    if (of_strain) s(2) *= 2;
    row.segment<8>(8 * side) << z[static_cast<std::size_t>(side)], s, at, major, minor,
        of_strain ? fe::calc_plane_von_mises_strain(s) : fe::calc_plane_von_mises(s);
  }
  return row;
}

/// Values of make_plate_row that are strains of the reference surface and Nastran's curvatures -κ: strains of bending
/// at z = -1. `values` ends with those of StressKind::Mid.
VectorXd take_curvatures(const VectorXd& values) {
  VectorXd mid = values.tail<6>();
  mid.tail<3>() *= -1;
  return mid;
}

/// A row per ply: 11 22 12, the shear above it (none above the last), angle, major, minor, largest shear. Strains have
/// none above the plies.
MatrixXd make_ply_rows(const fe::Element& element, const VectorXd& stress, bool of_strain) {
  const auto points = element.stress_recovery()->stress_points();
  const Index count =
      std::count_if(points.begin(), points.end(), [](const auto& point) { return point.kind == fe::StressKind::Ply; });
  MatrixXd rows(count, 9);
  for (Index k = 0; k < count; ++k) {
    const Eigen::Vector3d s = stress.segment<3>(3 * k);
    const auto [at, major, minor] = calc_principal(s(0), s(1), of_strain ? 0.5 * s(2) : s(2));
    const Index bond = 3 * count + 2 * k;
    const Eigen::RowVector2d above =
        !of_strain && bond < stress.size() ? Eigen::RowVector2d(stress.segment<2>(bond)) : Eigen::RowVector2d::Zero();
    rows.row(k) << s.transpose(), above, at, major, minor, (of_strain ? 1 : 0.5) * (major - minor);
  }
  return rows;
}

/// The centre and the corners: xx xy, first principal and its cosines, mean pressure, von Mises; yy yz, second; zz zx,
/// third.
MatrixXd make_solid_rows(const VectorXd& centre, const MatrixXd& corners, bool of_strain) {
  MatrixXd rows(corners.cols() + 1, 20);
  for (Index k = 0; k < rows.rows(); ++k) {
    const VectorXd s = k == 0 ? centre : VectorXd(corners.col(k - 1));
    const VectorXd t = of_strain ? fe::halve_shears(fe::StressKind::Solid, s) : s;
    Eigen::Matrix3d sigma;
    sigma << t[0], t[3], t[5], t[3], t[1], t[4], t[5], t[4], t[2];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(sigma);
    const auto& value = principal.eigenvalues();
    const auto& axis = principal.eigenvectors();
    rows.row(k) << s[0], s[3], value[2], axis.col(2).transpose(), -sigma.trace() / 3,
        of_strain ? fe::calc_solid_von_mises_strain(s) : fe::calc_solid_von_mises(s),  //
        s[1], s[4], value[1], axis.col(1).transpose(), s[2], s[5], value[0], axis.col(0).transpose();
  }
  return rows;
}

/// The components of the points themselves, without what is derived.
VectorXd take_components(const fe::Element& element, const records::ElementStresses& stresses, Index row,
                         bool of_strain) {
  const auto& recovery = *element.stress_recovery();
  const auto points = of_strain ? recovery.strain_points() : recovery.stress_points();
  std::vector<double> values;
  for (const auto& point : points)
    for (const auto& component : fe::list_components(point.kind)) {
      const std::string name = point.name.empty() ? component : component + "@" + point.name;
      const auto& names = stresses.components;
      const auto at = std::find(names.begin(), names.end(), name) - names.begin();
      values.push_back(stresses.stress(row, at));
    }
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
}

/// Forces by element id, for bars and solids, whose columns need them.
std::unordered_map<int, VectorXd> index_forces(const std::vector<records::ElementForces>& forces,
                                               const std::string& card) {
  static const std::set<std::string> cards{"CBAR", "CTETRA", "CPENTA", "CHEXA", "CPYRAM"};
  std::unordered_map<int, VectorXd> index;
  if (cards.count(card) == 0) return index;
  for (const auto& block : forces) {
    if (records::get_card_of_group(block.card) != card) continue;
    for (std::size_t k = 0; k < block.id.size(); ++k)
      index[block.id[k]] = block.force.row(static_cast<Index>(k)).transpose();
  }
  return index;
}

double calc_turn(const fe::Model& model, const fe::Element& element) {
  if (element.card() != "CQUAD4") return 0;
  const auto nodes = element.shape().nodes;
  return calc_quad_angle(
      {model.node(nodes[0]).x, model.node(nodes[1]).x, model.node(nodes[2]).x, model.node(nodes[3]).x});
}

}  // namespace

std::map<int, StressLimits> list_stress_limits(const records::Deck& deck) {
  std::map<int, StressLimits> of_material, of_property, result;
  for (const auto& m : deck.mat1)
    if (m.st != 0 || m.sc != 0 || m.ss != 0) of_material[m.id] = {m.st, m.sc, m.ss};
  if (of_material.empty()) return result;
  const auto take = [&](const auto& cards, auto& into) {
    for (const auto& card : cards)
      if (const auto found = of_material.find(card.mid); found != of_material.end()) into[card.id] = found->second;
  };
  take(deck.pbar, of_property);
  take(deck.pbarl, of_property);
  take(deck.pbeam, of_property);
  take(deck.pbeaml, of_property);
  take(deck.prod, of_property);
  take(deck.ptube, of_property);
  take(deck.conrod, result);
  for (const auto& [element, property] : fe::list_element_properties(deck))
    if (const auto found = of_property.find(property); found != of_property.end()) result[element] = found->second;
  return result;
}

double calc_margin(double stress, double limit) {
  return limit == 0 || stress == 0 ? kBlank : std::abs(limit) / std::abs(stress) - 1;
}

std::optional<records::ListedElements> make_listed_stresses(
    const fe::Model& model, const ElementIndex& elements, const records::Deck& deck,
    const records::ElementStresses& stresses, const std::vector<records::ElementForces>& forces,
    const std::map<int, StressLimits>& limits, const std::function<bool(int)>& is_wanted, records::PointTable table) {
  records::ListedElements block;
  block.card = records::get_card_of_group(stresses.card);
  block.table = table;
  const bool of_strain = block.is_strain(), has_curvatures = table == records::PointTable::CurvatureStrain;
  if (stresses.id.empty()) return std::nullopt;
  const auto kind = elements.at({block.card, stresses.id.front()})->stress_recovery()->stress_points().front().kind;
  block.type = find_stress_type(block.card, kind);
  if (block.type == 0) return std::nullopt;
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < stresses.id.size(); ++k)
    if (is_wanted(stresses.id[k])) order.push_back(k);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return stresses.id[a] < stresses.id[b]; });
  const auto find_pshell = [&](int id) {
    const auto found = std::find_if(deck.pshell.begin(), deck.pshell.end(), [id](const auto& p) { return p.id == id; });
    return found == deck.pshell.end() ? nullptr : &*found;
  };
  const auto force_rows = index_forces(forces, block.card);
  std::vector<VectorXd> rows;
  for (const auto k : order) {
    const int id = stresses.id[k];
    const fe::Element& element = *elements.at({block.card, id});
    const VectorXd stress = take_components(element, stresses, static_cast<Index>(k), of_strain);
    const auto found = limits.find(id);
    const StressLimits own = of_strain || found == limits.end() ? StressLimits{} : found->second;
    const auto add = [&](const VectorXd& row, int point) {
      block.id.push_back(id);
      block.point.push_back(point);
      rows.push_back(row);
    };
    const auto& nodes = element.nodes();
    switch (kind) {
      case fe::StressKind::Rod:
        add(make_rod_stresses(stress, own), 0);
        break;
      case fe::StressKind::Axial:
        if (block.type == 2) {
          const auto ends = element.shape().nodes;
          block.ends.push_back({model.node(ends[0]).id, model.node(ends[1]).id});
          add(make_beam_stresses(stress, own), 0);
        } else {
          add(make_bar_stresses(element, force_rows.at(id), stress, own, of_strain), 0);
        }
        break;
      case fe::StressKind::Plane:
        add(make_plate_row(
                has_curvatures ? std::array{0.0, -1.0} : find_surfaces(element, find_pshell(stresses.property[k])),
                has_curvatures ? take_curvatures(stress) : stress, calc_turn(model, element), of_strain),
            0);
        break;
      case fe::StressKind::Ply: {
        const MatrixXd plies = make_ply_rows(element, stress, of_strain);
        for (Index p = 0; p < plies.rows(); ++p) add(plies.row(p).transpose(), static_cast<int>(p) + 1);
        break;
      }
      case fe::StressKind::Solid: {
        const MatrixXd corners =
            of_strain ? MatrixXd(stresses.corner.row(static_cast<Index>(k)).reshaped(6, stresses.corner.cols() / 6))
                      : element.as_solid()->calc_corner_stresses(force_rows.at(id));
        const MatrixXd points = make_solid_rows(stress, corners, of_strain);
        for (Index p = 0; p < points.rows(); ++p)
          add(points.row(p).transpose(), p == 0 ? 0 : model.node(nodes[static_cast<std::size_t>(p - 1)]).id);
        break;
      }
      default:
        return std::nullopt;
    }
  }
  block.real.resize(static_cast<Index>(rows.size()), rows.empty() ? 0 : rows.front().size());
  for (std::size_t r = 0; r < rows.size(); ++r) block.real.row(static_cast<Index>(r)) = rows[r].transpose();
  return block;
}

std::optional<records::ListedElements> make_listed_bushes(const ElementIndex& elements, const records::Deck& deck,
                                                          const records::ElementForces& forces,
                                                          const Eigen::Ref<const VectorXd>& u_g,
                                                          const std::function<bool(int)>& is_wanted,
                                                          records::PointTable table) {
  if (forces.card != "CBUSH") return std::nullopt;
  records::ListedElements block;
  block.card = forces.card;
  block.type = 102;
  block.table = table;
  std::map<int, std::array<double, 4>> coefficients;
  for (const auto& p : deck.pbush) coefficients[p.id] = p.rcv;
  std::map<int, VectorXd> rows;
  for (std::size_t k = 0; k < forces.id.size(); ++k) {
    const int id = forces.id[k];
    if (!is_wanted(id)) continue;
    VectorXd six = forces.force.row(static_cast<Index>(k)).transpose();
    const fe::Element& element = *elements.at({block.card, id});
    if (block.is_strain()) {
      const auto* springs = dynamic_cast<const fe::SpringRows*>(&element);
      BOUGH_DEMAND(springs);
      six = springs->calc_spring_rows() * u_g(element.gdofs());
    }
    const auto found = coefficients.find(forces.property[k]);
    const auto factor = found == coefficients.end() ? records::Pbush{}.rcv : found->second;
    six.head<3>() *= factor[block.is_strain() ? 2 : 0];
    six.tail<3>() *= factor[block.is_strain() ? 3 : 1];
    rows[id] = six;
  }
  block.real.resize(static_cast<Index>(rows.size()), 6);
  for (const auto& [id, six] : rows) {
    block.real.row(static_cast<Index>(block.id.size())) = six.transpose();
    block.id.push_back(id);
    block.point.push_back(0);
  }
  return block;
}

void keep_linear_columns(records::ListedElements& block) {
  static const std::map<int, std::vector<int>> columns{{1, {0, 2}},
                                                       {2, {0, 1, 2, 3, 8, 9, 10, 11}},
                                                       {33, {0, 1, 2, 3, 8, 9, 10, 11}},
                                                       {34, {0, 1, 2, 3, 4, 8, 9, 10, 11}},
                                                       {39, {0, 8, 14, 1, 9, 15}},
                                                       {95, {0, 1, 2, 3, 4}}};
  static const std::map<int, int> alike{{3, 1}, {10, 1}, {74, 33}, {67, 39}, {68, 39}, {255, 39}, {97, 95}};
  const auto like = alike.find(block.type);
  block.real = MatrixXd(block.real(Eigen::all, columns.at(like == alike.end() ? block.type : like->second)));
}

}  // namespace bough::analysis
