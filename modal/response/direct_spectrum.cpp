#include <cmath>
#include <numbers>
#include <random>

#include "fe/linear/complex_factor.hpp"
#include "fe/linear/null_space.hpp"
#include "fe/linear/symmetric_matrix.hpp"
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
  DirectSpectrum(const DirectModel& direct, Index n) : direct_(direct), n_(n), probe_(make_probe(n)) {}

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
    const linear::ComplexFactor factor(A, imaginary);
    if (factor.is_singular()) throw_unbounded(hz, kWhy);
    const MatrixXcd x = factor.solve(sides);
    // Along a motion that next to nothing resists, the answer to any load is round-off.
    const double energy = std::abs(x.col(1).dot(sides.col(1))), size = D.dot(x.col(1).cwiseAbs2());
    if (!(energy > linear::kMechanismEnergy * size)) throw_unbounded(hz, kWhy);
    VectorXcd A_x = multiply(A, x.col(0));
    if (imaginary) A_x += 1i * multiply(imaginary, x.col(0));
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

  linear::SymmetricMatrix make_imaginary(double omega) const {
    const auto& m = direct_;
    if (!m.B || omega == 0) return m.S ? m.S : linear::SymmetricMatrix();
    return m.S ? linear::add(m.S, omega, m.B) : linear::scale(m.B, omega);
  }

  const DirectModel& direct_;
  Index n_;
  VectorXd probe_;
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
                      Diagnostics& diagnostics) {
  const Index n = model.num_fdofs();
  DirectSpectrum solver(direct, n);
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
