#include "fe/linear/complex_lu.hpp"

#include <mpi.h>
#include <zmumps_c.h>

#include <vector>

#include "fe/linear/mumps.hpp"
#include "fe/linear/petsc.hpp"

namespace bough::linear {

using Eigen::MatrixXcd;

struct ComplexLu::Impl {
  ZMUMPS_STRUC_C mumps{};
  int rank = 0;
  bool is_singular = false, is_started = false;

  /// Entry k of MUMPS' integer controls and results, counted from 1 as in its manual.
  MUMPS_INT& icntl(int k) { return mumps.icntl[k - 1]; }
  MUMPS_INT infog(int k) const { return mumps.infog[k - 1]; }

  FactorState run(int job) {
    mumps.job = job;
    zmumps_c(&mumps);
    return judge_factorization(infog(1), infog(2));
  }
  ~Impl() {
    if (!is_started) return;
    mumps.job = -2;
    zmumps_c(&mumps);
  }
};

ComplexLu::ComplexLu(const ComplexSparse& A, bool is_symmetric) : impl_(std::make_unique<Impl>()) {
  auto& i = *impl_;
  i.rank = initialize_petsc().rank;
  i.mumps.comm_fortran = static_cast<MUMPS_INT>(MPI_Comm_c2f(PETSC_COMM_WORLD));
  i.mumps.par = 1;
  i.mumps.sym = is_symmetric ? 2 : 0;
  i.run(-1);
  i.is_started = true;
  for (const int output : {1, 2, 3, 4}) i.icntl(output) = output == 4 ? 0 : -1;
  std::vector<MUMPS_INT> rows, columns;
  std::vector<ZMUMPS_COMPLEX> values;
  if (i.rank == 0) {
    rows.reserve(static_cast<std::size_t>(A.nonZeros()));
    columns.reserve(rows.capacity());
    values.reserve(rows.capacity());
    for (Eigen::Index row = 0; row < A.outerSize(); ++row)
      for (ComplexSparse::InnerIterator it(A, row); it; ++it) {
        if (is_symmetric && it.col() > row) continue;
        rows.push_back(static_cast<MUMPS_INT>(row + 1));
        columns.push_back(static_cast<MUMPS_INT>(it.col() + 1));
        values.push_back({it.value().real(), it.value().imag()});
      }
    i.mumps.n = static_cast<MUMPS_INT>(A.rows());
    i.mumps.nnz = static_cast<MUMPS_INT8>(rows.size());
    i.mumps.irn = rows.data();
    i.mumps.jcn = columns.data();
    i.mumps.a = values.data();
  }
  FactorState state = i.run(1);
  for (const int extra_percent : {50, 200, 1000}) {
    if (state == FactorState::Singular) break;
    i.icntl(14) = extra_percent;
    state = i.run(2);
    if (state != FactorState::NeedsWorkspace) break;
  }
  i.is_singular = state != FactorState::Done;
  // The factor remains; the arrays of A end here.
  i.mumps.irn = i.mumps.jcn = nullptr;
  i.mumps.a = nullptr;
}

ComplexLu::~ComplexLu() = default;

bool ComplexLu::is_singular() const { return impl_->is_singular; }
double ComplexLu::num_entries() const {
  const double entries = impl_->infog(29);
  return entries < 0 ? -1e6 * entries : entries;  // MUMPS counts in millions where the number is no integer
}

MatrixXcd ComplexLu::solve(const Eigen::Ref<const MatrixXcd>& F, bool transposed) const {
  auto& i = *impl_;
  MatrixXcd X = F;
  if (X.size() == 0) return X;
  i.icntl(9) = transposed ? 2 : 1;
  i.mumps.rhs = reinterpret_cast<ZMUMPS_COMPLEX*>(X.data());
  i.mumps.nrhs = static_cast<MUMPS_INT>(X.cols());
  i.mumps.lrhs = static_cast<MUMPS_INT>(X.rows());
  i.run(3);
  MPI_Bcast(X.data(), static_cast<int>(X.size()), MPI_C_DOUBLE_COMPLEX, 0, PETSC_COMM_WORLD);
  return X;
}

}  // namespace bough::linear
