#include <cmath>
#include <numbers>
#include <random>

#include "fe/linear/complex_factor.hpp"
#include "fe/linear/null_space.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "modal/complex/quadratic_pencil.hpp"
#include "modal/response/accuracy.hpp"
#include "modal/response/coordinates.hpp"
#include "modal/response/direct_model.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::response {
namespace {

using namespace std::complex_literals;
using Eigen::Index;
using Eigen::VectorXcd;

/// Frequencies whose solutions are held at a time.
constexpr Index kHeldFrequencies = 32;

class DirectSpectrum {
 public:
  DirectSpectrum(const fe::Model& model, const DirectModel& direct, const AddedStiffness& added)
      : direct_(direct), n_(model.num_fdofs()), probe_(make_probe(n_)), added_(added) {
    if (!added_) return;
    T_ = model.T();
    complex_modes::PencilBuilder builder(n_);
    builder.add_stiffness(direct.K, 1);
    if (direct.S) builder.add_stiffness(direct.S, 1i);
    if (direct.B) builder.add_damping(direct.B, 1);
    builder.add_mass(direct.M, 1);
    pencil_ = builder.build();
  }

  /// The f-set's motion for loads p and motions d of the supports.
  VectorXcd solve(double hz, const VectorXcd& p, const VectorXcd& d) {
    const double omega = 2 * std::numbers::pi * hz;
    const auto& m = direct_;
    const linear::SymmetricMatrix A = omega == 0 ? m.K : linear::add(m.K, -omega * omega, m.M);
    const linear::SymmetricMatrix imaginary = make_imaginary(omega);
    VectorXd D = m.K_diagonal + omega * omega * m.M_diagonal;
    const double largest = D.maxCoeff();
    D = (D.array() > detail::kIdleDof * largest).select(D, largest > 0 ? largest : 1.0);
    MatrixXcd sides(n_, 2);
    sides.col(0) = m.F * p - (m.K_X - omega * omega * m.M_X) * d - 1i * ((omega * m.B_X + m.S_X) * d);
    sides.col(1) = D.cwiseSqrt().cwiseProduct(probe_).cast<std::complex<double>>();
    linear::ComplexSparse Z;  // on the f-set
    if (added_) {
      const linear::ComplexSparse Z_g = added_(hz);
      const linear::ComplexSparse T = T_.cast<std::complex<double>>();
      Z = linear::ComplexSparse(T.transpose()) * linear::ComplexSparse(Z_g * T);
      if (d.size() > 0) sides.col(0) -= T_.transpose().cast<std::complex<double>>() * (Z_g * (m.X * d)).eval();
    }
    const MatrixXcd x = added_ ? solve_unsymmetric(hz, Z, sides) : solve_symmetric(hz, A, imaginary, sides);
    // Along a motion with almost no resistance, the answer to any load is round-off.
    const double energy = std::abs(x.col(1).dot(sides.col(1))), size = D.dot(x.col(1).cwiseAbs2());
    if (!(energy > linear::kMechanismEnergy * size)) throw_unbounded(hz, kWhy);
    VectorXcd A_x = multiply(A, x.col(0));
    if (imaginary) A_x += 1i * multiply(imaginary, x.col(0));
    if (added_) A_x += Z * x.col(0);
    residual_.add(D, x.col(0), A_x, sides.col(0));
    return x.col(0);
  }
  double residual() const { return residual_.worst(); }

 private:
  static constexpr const char* kWhy = "the model moves freely, or a mode at this frequency is not damped";

  static VectorXcd multiply(const linear::SymmetricMatrix& A, const VectorXcd& x) {
    MatrixXd parts(x.size(), 2);
    parts << x.real(), x.imag();
    const MatrixXd y = linear::multiply(A, parts);
    return y.col(0) + 1i * y.col(1);
  }

  static MatrixXcd solve_symmetric(double hz, const linear::SymmetricMatrix& A,
                                   const linear::SymmetricMatrix& imaginary, const MatrixXcd& sides) {
    const linear::ComplexFactor factor(A, imaginary);
    if (factor.is_singular()) throw_unbounded(hz, kWhy);
    return factor.solve(sides);
  }

  /// LU of all unknowns of the pencil; those after the f-set belong to matrices of low rank.
  MatrixXcd solve_unsymmetric(double hz, linear::ComplexSparse& Z, const MatrixXcd& sides) const {
    linear::ComplexSparse Q = pencil_.calc_matrix(2i * std::numbers::pi * hz), padded = Z;
    padded.conservativeResize(Q.rows(), Q.cols());
    Q += padded;
    const linear::ComplexLu factor(Q, false);
    if (factor.is_singular()) throw_unbounded(hz, kWhy);
    MatrixXcd all = MatrixXcd::Zero(Q.rows(), sides.cols());
    all.topRows(n_) = sides;
    return factor.solve(all).topRows(n_);
  }

  linear::SymmetricMatrix make_imaginary(double omega) const {
    const auto& m = direct_;
    if (!m.B || omega == 0) return m.S ? m.S : linear::SymmetricMatrix();
    return m.S ? linear::add(m.S, omega, m.B) : linear::scale(m.B, omega);
  }

  const DirectModel& direct_;
  Index n_;
  VectorXd probe_;
  const AddedStiffness& added_;
  Eigen::SparseMatrix<double> T_;
  complex_modes::QuadraticPencil pencil_;
  ResidualRecord residual_{false};
};

}  // namespace

VectorXd make_probe(Index n) {
  std::mt19937 random(20);
  VectorXd probe(n);
  for (double& value : probe) value = 0.5 + static_cast<double>(random()) / 4294967296.0;
  for (Index i = 1; i < n; i += 2) probe(i) = (random() & 1U) ? probe(i) : -probe(i);
  return probe;
}

double solve_spectrum(const fe::Model& model, const DirectModel& direct, const Excitation& excitation,
                      const VectorXd& hz, const std::function<void(const MotionBlock<MatrixXcd>&)>& take,
                      Diagnostics& diagnostics, const AddedStiffness& added) {
  const Index n = model.num_fdofs();
  DirectSpectrum solver(model, direct, added);
  BoundedFrequencies bounded;
  for (Index first = 0; first < hz.size(); first += kHeldFrequencies) {
    const VectorXd held = hz.segment(first, std::min(kHeldFrequencies, hz.size() - first));
    MotionBlock<MatrixXcd> block;
    block.u.resize(model.num_gdofs(), held.size());
    block.p.resize(excitation.F.cols(), held.size());
    std::vector<Index> kept;
    for (Index i = 0; i < held.size(); ++i) {
      const auto solve = [&] {
        VectorXcd d;
        block.p.col(i) = calc_amplitudes(excitation, held(i), d).head(excitation.F.cols());
        block.u.col(i) = direct.X * d;
        if (n > 0) block.u.col(i) += model.T() * solver.solve(held(i), block.p.col(i), d);
      };
      if (bounded.take(solve)) kept.push_back(i);
    }
    if (kept.empty()) continue;
    block.x = held(kept);
    block.u = block.u(Eigen::all, kept).eval();
    block.p = block.p(Eigen::all, kept).eval();
    const Eigen::RowVectorXcd rate = 2i * std::numbers::pi * block.x.transpose().cast<std::complex<double>>();
    block.u_dot = block.u * rate.asDiagonal();
    block.u_ddot = block.u_dot * rate.asDiagonal();
    take(block);
  }
  bounded.report(diagnostics);
  return solver.residual();
}

}  // namespace bough::modal::response
