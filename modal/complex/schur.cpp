#include "modal/complex/schur.hpp"

#include <limits>
#include <numeric>

#include "base/diagnostic.hpp"

// PETSc declares LAPACK for its own, real, scalars only.
extern "C" {
void zgees_(const char* vectors, const char* sort, int (*select)(const std::complex<double>*), const int* n,
            std::complex<double>* A, const int* lda, int* num_sorted, std::complex<double>* eigenvalues,
            std::complex<double>* Z, const int* ldz, std::complex<double>* work, const int* work_size,
            double* real_work, int* flags, int* info);
void ztrexc_(const char* vectors, const int* n, std::complex<double>* T, const int* ldt, std::complex<double>* Z,
             const int* ldz, const int* from, const int* to, int* info);
}

namespace bough::modal::complex_modes {

SchurForm calc_schur(MatrixXcd A) {
  const int n = static_cast<int>(A.rows());
  SchurForm form{std::move(A), MatrixXcd(n, n)};
  if (n == 0) return form;
  VectorXcd eigenvalues(n), work(1);
  Eigen::VectorXd real_work(n);
  int num_sorted = 0, info = 0, size = -1;
  for (int pass = 0; pass < 2; ++pass) {
    zgees_("V", "N", nullptr, &n, form.T.data(), &n, &num_sorted, eigenvalues.data(), form.Z.data(), &n, work.data(),
           &size, real_work.data(), nullptr, &info);
    if (pass == 0) {
      size = static_cast<int>(work(0).real());
      work.resize(size);
    }
  }
  if (info != 0)
    throw ComputationError("modal.complex-convergence", {},
                           "the QR iteration of the projected complex eigenproblem does not converge",
                           "look for entries of extreme size in K2PP, B2PP, M2PP and TF");
  // The largest of the rest moves to the front, one after the other.
  for (int to = 0; to < n; ++to) {
    int from = to;
    for (int i = to + 1; i < n; ++i)
      if (std::abs(form.T(i, i)) > std::abs(form.T(from, from)) * (1 + 1e-14)) from = i;
    if (from == to) continue;
    const int first = from + 1, last = to + 1;
    ztrexc_("V", &n, form.T.data(), &n, form.Z.data(), &n, &first, &last, &info);
  }
  form.T.triangularView<Eigen::StrictlyLower>().setZero();
  return form;
}

MatrixXcd calc_triangular_vectors(const MatrixXcd& T, Index count) {
  MatrixXcd Y = MatrixXcd::Zero(T.rows(), count);
  const double tiny = std::numeric_limits<double>::epsilon() * std::max(T.cwiseAbs().maxCoeff(), 1e-300);
  for (Index k = 0; k < count; ++k) {
    Y(k, k) = 1;
    VectorXcd right = -T.col(k).head(k);
    for (Index i = k - 1; i >= 0; --i) {
      Complex gap = T(i, i) - T(k, k);
      if (std::abs(gap) < tiny) gap = tiny;
      Y(i, k) = right(i) / gap;
      right.head(i) -= Y(i, k) * T.col(i).head(i);
    }
    Y.col(k).normalize();
  }
  return Y;
}

}  // namespace bough::modal::complex_modes
