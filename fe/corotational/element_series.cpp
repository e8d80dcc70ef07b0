// Forces and deformations of an element along curves (docs/theory/third-order.md, "Along a curve"). Series end at the
// order that the caller requests: the products of a force of order k are k² of those of order 1.
#include "fe/corotational/fitted_core.hpp"
#include "fe/corotational/series.hpp"
#include "fe/linear/blas.hpp"

namespace bough::fe {

using Eigen::Index;

namespace {

constexpr Index kCurvesAtOnce = 16;  ///< their products with P stay in the cache
/// Rank of the internal forces: rows scaled to unit length by the size of the dofs.
constexpr double kRankTolerance = 1e-13;

template <std::size_t M>
void add(double factor, const VectorSeries<M>& v, VectorSeries<M>& sum) {
  for (std::size_t i = 0; i < M; ++i) sum[i] += factor * v[i];
}

}  // namespace

/// Frame and nodes along one curve.
template <int Top>
struct CorotationalElement::Motion {
  static constexpr std::size_t kSize = Top + 1;
  MatrixSeries<kSize> R, H;                   ///< the frame, and Rᵀ B
  std::vector<VectorSeries<kSize>> y, turn;   ///< places and rotation vectors of the nodes, seen from the frame
  std::vector<MatrixSeries<kSize>> turned;    ///< exp of turn
  std::vector<VectorSeries<kSize>> rotation;  ///< rotation vectors in basic
};

template <int Top>
void CorotationalElement::calc_motions(const Eigen::Ref<const MatrixXd>& u, std::vector<Motion<Top>>& motions,
                                       MatrixXd& d) const {
  constexpr std::size_t kSize = Motion<Top>::kSize;
  const std::size_t num_nodes = translations_.size();
  const Index num_curves = u.cols() / Top;
  motions.resize(static_cast<std::size_t>(num_curves));
  d.resize(u.rows(), u.cols());
  std::vector<VectorSeries<kSize>> x(num_nodes);
  for (Index curve = 0; curve < num_curves; ++curve) {
    Motion<Top>& motion = motions[static_cast<std::size_t>(curve)];
    const auto u_c = u.middleCols<Top>(curve * Top);
    VectorSeries<kSize> mean = make_zero_vector<kSize>();
    for (std::size_t k = 0; k < num_nodes; ++k) {
      x[k] = get_vector<kSize>(u_c, translations_[k]);
      add(1 / static_cast<double>(num_nodes), x[k], mean);
    }
    MatrixSeries<kSize> B = make_zero_matrix<kSize>();
    motion.rotation.resize(num_nodes);
    motion.turned.resize(num_nodes);
    for (std::size_t k = 0; k < num_nodes; ++k) {
      const Vector3d arm = arms_.col(static_cast<Index>(k));
      add(-1, mean, x[k]);
      x[k][0] += arm;
      for (std::size_t i = 0; i < kSize; ++i) B[i].noalias() += x[k][i] * arm.transpose();
      if (rotations_[k] < 0) continue;
      motion.rotation[k] = get_vector<kSize>(u_c, rotations_[k]);
      motion.turned[k] = calc_exponential(motion.rotation[k]);
      for (std::size_t i = 0; i < kSize; ++i) B[i] += rotation_weight_ * motion.turned[k][i];
    }
    find_nearest_rotation(B, frame_inverse_, motion.R, motion.H);
    motion.y.resize(num_nodes);
    motion.turn.resize(num_nodes);
    auto d_c = d.middleCols<Top>(curve * Top);
    for (std::size_t k = 0; k < num_nodes; ++k) {
      motion.y[k] = rotate_back(motion.R, x[k]);
      put_vector(motion.y[k], translations_[k], d_c);  // from order 1; the arm is order 0
      if (rotations_[k] < 0) continue;
      motion.turned[k] = rotate_back(motion.R, motion.turned[k]);
      motion.turn[k] = calc_logarithm(motion.turned[k]);
      put_vector(motion.turn[k], rotations_[k], d_c);
    }
  }
}

CorotationalElement::SecondStrains CorotationalElement::reduce_second_strains() const {
  const Index N = num_dofs(), s = F_.rows();
  SecondStrains second;
  if (s == 0) return second;
  VectorXd size = K_.diagonal().cwiseMax(0).cwiseSqrt();
  size = (size.array() > 0).select(size.cwiseInverse(), 1);
  MatrixXd rows = F_ * size.asDiagonal();
  const VectorXd length = rows.rowwise().norm();
  const VectorXd unit = (length.array() > 0).select(length.cwiseInverse(), 0);
  rows = unit.asDiagonal() * rows;
  Eigen::ColPivHouseholderQR<MatrixXd> qr(rows.transpose());
  qr.setThreshold(kRankTolerance);
  const Index rank = qr.rank();
  const Eigen::VectorXi order = qr.colsPermutation().indices();
  // F = U F_p: rows p are independent.
  MatrixXd U = MatrixXd::Zero(s, rank);
  const MatrixXd others = qr.matrixR()
                              .topLeftCorner(rank, rank)
                              .triangularView<Eigen::Upper>()
                              .solve(qr.matrixR().block(0, rank, rank, s - rank));
  for (Index a = 0; a < rank; ++a) U(order[a], a) = 1;
  for (Index m = rank; m < s; ++m)
    for (Index a = 0; a < rank; ++a) U(order[m], a) = length[order[m]] * others(a, m - rank) * unit[order[a]];
  const Eigen::VectorXi kept = order.head(rank);
  second.F = F_(kept, Eigen::all);
  second.E = E_(kept, kept);
  MatrixXd P(N * N, s);
  for (Index m = 0; m < s; ++m) P.col(m) = P_[static_cast<std::size_t>(m)].reshaped();
  second.P.resize(N, N * rank);
  linear::multiply_dense(false, P, U, 0, Eigen::Map<MatrixXd>(second.P.data(), N * N, rank));
  return second;
}

/// ∂V/∂d = K d + ½ Fᵀw + Σ_m (F d + ½ E w)_m P_m d
template <int Top>
void CorotationalElement::calc_local_gradient(const SecondStrains& second, const MatrixXd& d, MatrixXd& g) const {
  const Index N = d.rows(), m = d.cols() / Top, r = second.F.rows();
  g.resize(N, d.cols());
  linear::multiply_dense(false, K_, d, 0, g);
  if (r == 0) return;
  MatrixXd low(N, (Top - 1) * m), Pd(N * r, (Top - 1) * m);
  for (Index c = 0; c < m; ++c) low.middleCols<Top - 1>((Top - 1) * c) = d.middleCols<Top - 1>(Top * c);
  linear::multiply_dense(true, second.P, low, 0, Pd);
  const auto P_times = [&](Index c, int order) {  // P_a d of each a
    return Eigen::Map<const MatrixXd>(Pd.col((Top - 1) * c + order - 1).data(), N, r);
  };
  MatrixXd w = MatrixXd::Zero(r, d.cols());
  for (Index c = 0; c < m; ++c)
    for (int i = 1; i < Top; ++i)
      for (int j = i; i + j <= Top; ++j)
        w.col(Top * c + i + j - 1).noalias() += (i == j ? 1 : 2) * (P_times(c, i).transpose() * d.col(Top * c + j - 1));
  w *= 0.5;
  MatrixXd h(r, d.cols());
  linear::multiply_dense(false, second.F, d, 0, h);
  linear::multiply_dense(false, second.E, w, 1, h);
  linear::multiply_dense(true, second.F, w, 1, g);
  for (Index c = 0; c < m; ++c)
    for (int i = 1; i < Top; ++i)
      for (int j = 1; i + j <= Top; ++j) g.col(Top * c + i + j - 1).noalias() += P_times(c, j) * h.col(Top * c + i - 1);
}

template <int Top>
void CorotationalElement::calc_series(const SecondStrains& second, const Eigen::Ref<const MatrixXd>& u,
                                      Eigen::Ref<MatrixXd> f) const {
  constexpr std::size_t kSize = Motion<Top>::kSize;
  const std::size_t num_nodes = translations_.size();
  std::vector<Motion<Top>> motions;
  MatrixXd d, g;
  calc_motions<Top>(u, motions, d);
  calc_local_gradient<Top>(second, d, g);
  std::vector<VectorSeries<kSize>> force(num_nodes), moment(num_nodes);
  for (Index curve = 0; curve < u.cols() / Top; ++curve) {
    const Motion<Top>& motion = motions[static_cast<std::size_t>(curve)];
    const auto g_c = g.middleCols<Top>(curve * Top);
    auto f_c = f.middleCols<Top>(curve * Top);
    VectorSeries<kSize> tau = make_zero_vector<kSize>();
    for (std::size_t k = 0; k < num_nodes; ++k) {
      force[k] = get_vector<kSize>(g_c, translations_[k]);
      add(1, cross(motion.y[k], force[k]), tau);
      if (rotations_[k] < 0) continue;
      moment[k] = apply_inverse_tangent_transpose(motion.turn[k], get_vector<kSize>(g_c, rotations_[k]));
      add(1, moment[k], tau);
    }
    // The frame turns by (tr H 1 - H)⁻¹ (Σ a × Rᵀδx + c Σ (tr Q 1 - Q) Rᵀδφ), Q the node seen from the frame.
    const VectorSeries<kSize> mu = solve(subtract_from_trace(motion.H), frame_inverse_, tau);
    VectorSeries<kSize> mean = make_zero_vector<kSize>();
    for (std::size_t k = 0; k < num_nodes; ++k) {
      const Vector3d arm = arms_.col(static_cast<Index>(k));
      for (std::size_t i = 0; i < kSize; ++i) force[k][i] -= mu[i].cross(arm);
      add(1 / static_cast<double>(num_nodes), force[k], mean);
    }
    for (std::size_t k = 0; k < num_nodes; ++k) {
      add(-1, mean, force[k]);
      put_vector(rotate(motion.R, force[k]), translations_[k], f_c);
      if (rotations_[k] < 0) continue;
      add(-rotation_weight_, multiply(transpose(subtract_from_trace(motion.turned[k])), mu), moment[k]);
      put_vector(apply_tangent_transpose(motion.rotation[k], rotate(motion.R, moment[k])), rotations_[k], f_c);
    }
  }
}

MatrixXd CorotationalElement::calc_forces(const Eigen::Ref<const MatrixXd>& u, int top) const {
  BOUGH_DEMAND(u.rows() == num_dofs() && top >= 2 && top <= kSeriesTop && u.cols() % top == 0);
  if (!follows_nodes_) return K_ * u;
  if (fitted_) return fitted_->calc_forces(u, top);
  const SecondStrains second = reduce_second_strains();
  MatrixXd f(u.rows(), u.cols());
  for (Index first = 0; first < u.cols(); first += kCurvesAtOnce * top) {
    const Index num = std::min(kCurvesAtOnce * top, u.cols() - first);
    const auto u_c = u.middleCols(first, num);
    auto f_c = f.middleCols(first, num);
    switch (top) {
      case 2:
        calc_series<2>(second, u_c, f_c);
        break;
      case 3:
        calc_series<3>(second, u_c, f_c);
        break;
      case 4:
        calc_series<4>(second, u_c, f_c);
        break;
      default:
        calc_series<5>(second, u_c, f_c);
    }
  }
  return f;
}

LocalSeries CorotationalElement::calc_local(const Eigen::Ref<const MatrixXd>& u) const {
  BOUGH_DEMAND(u.rows() == num_dofs() && u.cols() % kSeriesTop == 0);
  LocalSeries local;
  local.d = u;
  if (!follows_nodes_) return local;
  std::vector<Motion<kSeriesTop>> motions;
  calc_motions<kSeriesTop>(u, motions, local.d);
  if (fitted_) {
    local.internal = fitted_->calc_internal(u);
    return local;
  }
  local.internal = F_ * local.d;
  for (Index m = 0; m < local.internal.rows(); ++m) {
    const MatrixXd Pd = P_[static_cast<std::size_t>(m)] * local.d;
    for (Index c = 0; c < u.cols(); c += kSeriesTop)
      for (int i = 1; i < kSeriesTop; ++i)
        for (int j = 1; i + j <= kSeriesTop; ++j)
          local.internal.col(c + i + j - 1) += 0.5 * local.d.col(c + i - 1).dot(Pd.col(c + j - 1)) * E_.col(m);
  }
  return local;
}

}  // namespace bough::fe
