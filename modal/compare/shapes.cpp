#include "modal/compare/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

namespace bough::modal {

using Eigen::Index;

namespace {

constexpr double kTolerance = 1e-6;

double calc_size(const MatrixXd& xyz) {
  if (xyz.rows() == 0) return 0;
  return (xyz.colwise().maxCoeff() - xyz.colwise().minCoeff()).norm();
}

/// Translations (first = 0) or rotations (3) at the chosen nodes, 3k x n.
MatrixXd stack(const ModalModel& model, const std::vector<int>& nodes, Index first) {
  MatrixXd all(3 * static_cast<Index>(nodes.size()), model.num_modes());
  for (std::size_t k = 0; k < nodes.size(); ++k)
    all.middleRows(3 * static_cast<Index>(k), 3) = model.phi[static_cast<std::size_t>(nodes[k])].middleRows(first, 3);
  return all;
}

/// Shapes of both models at the matched nodes.
struct Shapes {
  MatrixXd a, b;                       ///< translations
  MatrixXd turn_a, turn_b;             ///< rotations times the size of the model
  std::vector<bool> turns_a, turns_b;  ///< modes without translations

  Shapes(const ModalModel& x, const ModalModel& y, const NodeMatch& match) {
    std::vector<int> of_x, of_y;
    for (const auto& [i, j] : match.pairs) {
      of_x.push_back(i);
      of_y.push_back(j);
    }
    const double size = std::max(calc_size(x.node_xyz), calc_size(y.node_xyz));
    a = stack(x, of_x, 0);
    b = stack(y, of_y, 0);
    turn_a = size * stack(x, of_x, 3);
    turn_b = size * stack(y, of_y, 3);
    turns_a = find_turning(a, turn_a);
    turns_b = find_turning(b, turn_b);
  }

  const MatrixXd& get_a(Index i, Index j) const { return use_turns(i, j) ? turn_a : a; }
  const MatrixXd& get_b(Index i, Index j) const { return use_turns(i, j) ? turn_b : b; }
  bool use_turns(Index i, Index j) const { return turns_a[std::size_t(i)] && turns_b[std::size_t(j)]; }

 private:
  static std::vector<bool> find_turning(const MatrixXd& moves, const MatrixXd& turns) {
    std::vector<bool> found;
    for (Index j = 0; j < moves.cols(); ++j) found.push_back(moves.col(j).norm() < kTolerance * turns.col(j).norm());
    return found;
  }
};

double calc_share(double product, double a, double b) { return a > 0 && b > 0 ? product * product / (a * b) : 0; }

using Cell = std::array<long, 3>;

}  // namespace

ModalModel ModalModel::from(const records::FlexBody& body) {
  ModalModel m;
  m.name = body.name;
  m.mass = body.mass;
  m.cg = body.cg;
  m.rigid << body.mass, body.mass, body.mass, body.inertia.diagonal();
  m.node_id = body.node_id;
  m.node_xyz = body.node_xyz;
  m.phi = body.phi;
  m.frequency_hz = body.frequency_hz;
  m.modal_mass = body.modal_mass.diagonal();
  m.effective_mass = body.effective_mass;
  return m;
}

ModalModel ModalModel::from(const records::ModesResult& modes) {
  ModalModel m;
  m.mass = modes.mass_properties.mass;
  m.cg = modes.mass_properties.cg;
  m.rigid = modes.mass_properties.rigid_mass.diagonal();
  m.node_id = modes.node_id;
  m.node_xyz = modes.node_xyz;
  m.phi = modes.phi;
  m.is_buckling = modes.load_factor.size() > 0;
  m.frequency_hz = m.is_buckling ? modes.load_factor : modes.frequency_hz;
  m.modal_mass = modes.modal_mass;
  m.effective_mass = modes.effective_mass;
  return m;
}

NodeMatch match_nodes(const ModalModel& a, const ModalModel& b) {
  NodeMatch match;
  const double tolerance = kTolerance * std::max(calc_size(a.node_xyz), calc_size(b.node_xyz));
  std::unordered_map<int, int> place_of_b;
  for (std::size_t k = 0; k < b.node_id.size(); ++k) place_of_b[b.node_id[k]] = static_cast<int>(k);
  std::vector<std::pair<int, int>> common;
  std::vector<Vector3d> shift;
  for (std::size_t k = 0; k < a.node_id.size(); ++k) {
    const auto found = place_of_b.find(a.node_id[k]);
    if (found == place_of_b.end()) continue;
    common.emplace_back(static_cast<int>(k), found->second);
    shift.push_back((b.node_xyz.row(found->second) - a.node_xyz.row(static_cast<Index>(k))).transpose());
  }
  const auto is_near = [&](const Vector3d& d) { return (d - match.offset).norm() <= tolerance; };
  const bool any_at_home = std::any_of(shift.begin(), shift.end(), is_near);
  if (!any_at_home && shift.size() > 1) {
    match.offset = shift.front();
    if (!std::all_of(shift.begin(), shift.end(), is_near)) match.offset.setZero();
  }
  std::vector<bool> used_a(a.node_id.size()), used_b(b.node_id.size());
  for (std::size_t k = 0; k < common.size(); ++k) {
    if (!is_near(shift[k])) continue;
    match.pairs.push_back(common[k]);
    used_a[std::size_t(common[k].first)] = used_b[std::size_t(common[k].second)] = true;
  }
  match.by_id = static_cast<int>(match.pairs.size());

  // Cells twice as wide as the tolerance: a near node is in the same cell or in a neighbour.
  const double width = tolerance > 0 ? 2 * tolerance : 1;
  const auto find_cell = [&](const Vector3d& x) {
    return Cell{std::lround(x[0] / width), std::lround(x[1] / width), std::lround(x[2] / width)};
  };
  std::map<Cell, std::vector<int>> cells;
  for (std::size_t k = 0; k < b.node_id.size(); ++k)
    if (!used_b[k]) cells[find_cell(b.node_xyz.row(static_cast<Index>(k)).transpose())].push_back(static_cast<int>(k));
  for (std::size_t k = 0; k < a.node_id.size(); ++k) {
    if (used_a[k]) continue;
    const Vector3d x = a.node_xyz.row(static_cast<Index>(k)).transpose() + match.offset;
    const Cell cell = find_cell(x);
    int best = -1;
    double distance = tolerance;
    for (long i = -1; i <= 1; ++i)
      for (long j = -1; j <= 1; ++j)
        for (long l = -1; l <= 1; ++l) {
          const auto found = cells.find({cell[0] + i, cell[1] + j, cell[2] + l});
          if (found == cells.end()) continue;
          for (const int other : found->second) {
            const double d = (b.node_xyz.row(other).transpose() - x).norm();
            if (used_b[std::size_t(other)] || d > distance) continue;
            best = other;
            distance = d;
          }
        }
    if (best < 0) continue;
    match.pairs.emplace_back(static_cast<int>(k), best);
    used_b[std::size_t(best)] = true;
    ++match.by_place;
  }
  return match;
}

MatrixXd calc_mac(const ModalModel& a, const ModalModel& b, const NodeMatch& match) {
  const Shapes s(a, b, match);
  MatrixXd mac(a.num_modes(), b.num_modes());
  for (Index i = 0; i < mac.rows(); ++i)
    for (Index j = 0; j < mac.cols(); ++j) {
      mac(i, j) = 0;
      if (s.turns_a[std::size_t(i)] != s.turns_b[std::size_t(j)]) continue;  // rounding against a shape
      const auto x = s.get_a(i, j).col(i);
      const auto y = s.get_b(i, j).col(j);
      mac(i, j) = calc_share(x.dot(y), x.squaredNorm(), y.squaredNorm());
    }
  return mac;
}

MassMac calc_mass_mac(const ModalModel& a, const ModalModel& b, const NodeMatch& match,
                      const records::SparseMatrix& mass, const Eigen::MatrixXi& dof_map) {
  std::unordered_map<int, std::pair<int, int>> place;
  for (const auto& pair : match.pairs) place[a.node_id[std::size_t(pair.first)]] = pair;
  const Index ndof = dof_map.rows();
  MatrixXd x = MatrixXd::Zero(ndof, a.num_modes()), y = MatrixXd::Zero(ndof, b.num_modes());
  MassMac result;
  for (Index r = 0; r < ndof; ++r) {
    const int code = dof_map(r, 1);
    const auto found = place.find(dof_map(r, 0));
    if (code >= 1 && code <= 6 && found != place.end()) {
      x.row(r) = a.phi[std::size_t(found->second.first)].row(code - 1);
      y.row(r) = b.phi[std::size_t(found->second.second)].row(code - 1);
    } else if (mass.indptr[std::size_t(r) + 1] > mass.indptr[std::size_t(r)]) {
      ++result.num_missing;
    }
  }
  if (result.num_missing > 0) return result;
  const auto times = [&](const MatrixXd& v) {
    MatrixXd product = MatrixXd::Zero(v.rows(), v.cols());
    for (Index r = 0; r < ndof; ++r)
      for (auto k = mass.indptr[std::size_t(r)]; k < mass.indptr[std::size_t(r) + 1]; ++k)
        product.row(r) += mass.data[std::size_t(k)] * v.row(mass.indices[std::size_t(k)]);
    return product;
  };
  const MatrixXd My = times(y), cross = x.transpose() * My;
  const VectorXd xx = x.cwiseProduct(times(x)).colwise().sum(), yy = y.cwiseProduct(My).colwise().sum();
  result.mac = MatrixXd(cross.rows(), cross.cols());
  for (Index i = 0; i < cross.rows(); ++i)
    for (Index j = 0; j < cross.cols(); ++j) (*result.mac)(i, j) = calc_share(cross(i, j), xx[i], yy[j]);
  return result;
}

std::vector<ModePair> pair_modes(const ModalModel& a, const ModalModel& b, const NodeMatch& match,
                                 const MatrixXd& mac) {
  constexpr double kMinMac = 0.05;
  const Shapes s(a, b, match);
  std::vector<ModePair> all, pairs;
  for (Index i = 0; i < mac.rows(); ++i)
    for (Index j = 0; j < mac.cols(); ++j)
      if (mac(i, j) >= kMinMac) all.push_back({static_cast<int>(i), static_cast<int>(j), mac(i, j), 0, 1});
  // Where shapes are as good as equal (a double root), the nearer number.
  std::sort(all.begin(), all.end(), [](const ModePair& p, const ModePair& q) {
    if (std::abs(p.mac - q.mac) > 1e-9) return p.mac > q.mac;
    return std::abs(p.a - p.b) < std::abs(q.a - q.b);
  });
  std::vector<bool> used_a(std::size_t(mac.rows())), used_b(std::size_t(mac.cols()));
  for (auto& p : all) {
    if (used_a[std::size_t(p.a)] || used_b[std::size_t(p.b)]) continue;
    used_a[std::size_t(p.a)] = used_b[std::size_t(p.b)] = true;
    const auto x = s.get_a(p.a, p.b).col(p.a);
    p.sign = x.dot(s.get_b(p.a, p.b).col(p.b)) < 0 ? -1 : 1;
    const Eigen::CompleteOrthogonalDecomposition<MatrixXd> span(s.get_b(p.a, p.b));
    const VectorXd rest = x - s.get_b(p.a, p.b) * span.solve(VectorXd(x));
    p.in_span = 1 - rest.squaredNorm() / x.squaredNorm();
    pairs.push_back(p);
  }
  std::sort(pairs.begin(), pairs.end(), [](const ModePair& p, const ModePair& q) { return p.a < q.a; });
  return pairs;
}

}  // namespace bough::modal
