/// The reduced body does not depend on the number of ranks: under mpirun the reduction on all of them is compared with
/// the same on each alone. With one process it compares the thing with itself.
#include <gtest/gtest.h>

#include "stiffening/reduce.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

/// PETSc's world is this process alone while this lives.
class Alone {
 public:
  Alone() : world_(PETSC_COMM_WORLD) { PETSC_COMM_WORLD = PETSC_COMM_SELF; }
  ~Alone() { PETSC_COMM_WORLD = world_; }
  Alone(const Alone&) = delete;
  Alone& operator=(const Alone&) = delete;

 private:
  MPI_Comm world_;
};

/// Largest difference, over the largest entry of the whole family: matrices that are zero are so to roundoff.
template <class Family>
double calc_difference(const Family& a, const Family& b) {
  double scale = 1e-300, difference = a.size() == b.size() ? 0 : 1e300;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    scale = std::max(scale, b[i].cwiseAbs().maxCoeff());
    if (a[i].rows() != b[i].rows() || a[i].cols() != b[i].cols()) return 1e300;
    difference = std::max(difference, (a[i] - b[i]).cwiseAbs().maxCoeff());
  }
  return difference / scale;
}

double calc_matrix_difference(const MatrixXd& a, const MatrixXd& b) {
  return calc_difference(std::vector<MatrixXd>{a}, std::vector<MatrixXd>{b});
}

void expect_equal(const records::Deck& deck, const records::BodySpec& spec) {
  Diagnostics diagnostics;
  const auto together = stiffening::reduce(deck, spec, {}, diagnostics).body;
  const Alone alone;
  const auto single = stiffening::reduce(deck, spec, {}, diagnostics).body;
  EXPECT_LT(calc_matrix_difference(together.eigenvalue, single.eigenvalue), 1e-9);
  EXPECT_LT(calc_matrix_difference(together.full_phi, single.full_phi), 1e-6);
  EXPECT_LT(calc_matrix_difference(together.F_I, single.F_I), 1e-12);
  EXPECT_LT(calc_difference(together.exact.gamma2, single.exact.gamma2), 1e-6);
  EXPECT_LT(calc_difference(together.kg_inertial, single.kg_inertial), 1e-6);
  EXPECT_LT(calc_difference(together.kg_external, single.kg_external), 1e-6);
}

// Repeated roots on purpose: their basis must not turn with the rank count.
TEST(Parallel, FixedBodyWithPairs) {
  const auto maker = test::make_cantilever(test::get_report_section(), test::kReportLength, 40);
  records::BodySpec spec;
  spec.num_modes = 8;
  spec.interface_nodes = {41, 21};
  spec.full = true;
  expect_equal(maker.deck, spec);
}

TEST(Parallel, FreeBody) {
  test::DeckMaker maker;
  maker.add_section(1, {70e9, 27e9, 2700, 1e-4, 1e-9, 1e-9, 2e-9}, true);
  for (int arm = 0; arm < 4; ++arm)
    maker.add_line(1, 100 * (arm + 1), Vector3d::Zero(),
                   (arm < 2 ? 1.0 : -1.0) * (arm % 2 ? Vector3d::UnitX() : Vector3d::UnitY()), 12, Vector3d::UnitZ(),
                   arm ? 100 : 0);
  records::BodySpec spec;
  spec.frame = records::BodyFrame::Free;
  spec.num_modes = 8;
  spec.interface_nodes = {112};
  spec.full = true;
  expect_equal(maker.deck, spec);
}

}  // namespace
}  // namespace bough
