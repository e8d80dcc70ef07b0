#include "modal/response/direct_model.hpp"

#include "fe/linear/symmetric_matrix.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/model/direct_matrices.hpp"

namespace bough::modal::response {
namespace {

using linear::SymmetricMatrix;

/// sum += factor A; an empty sum is zero.
void accumulate(SymmetricMatrix& sum, double factor, const SymmetricMatrix& A) {
  if (factor == 0 || !A) return;
  sum = sum ? linear::add(sum, factor, A) : linear::scale(A, factor);
}

bool is_zero(const SymmetricMatrix& A) {
  if (A.low_rank()) return false;
  PetscReal norm = 0;
  linear::check_petsc(MatNorm(A.sparse(), NORM_INFINITY, &norm));
  return norm == 0;
}

/// K2PP as forms on the g-set.
std::vector<fe::QuadraticForm> list_direct_forms(const fe::Model& model, const records::DynamicDeck& deck,
                                                 const records::DynamicSubcase& subcase) {
  records::Subcase alone;
  alone.k2gg = subcase.dynamics.k2pp;
  Diagnostics unsaid;  // the model has reported what is wrong
  std::vector<fe::QuadraticForm> forms;
  for (const auto& element : fe::make_direct(deck, alone, model, unsaid).elements) {
    const int r = element->num_dofs();
    MatrixXd K = MatrixXd::Zero(r, r);
    element->add_stiffness(1, K);
    fe::QuadraticForm form{element->gdofs(), MatrixXd::Identity(r, r), MatrixXd::Zero(r * (r + 1) / 2, 1)};
    for (int i = 0; i < r; ++i)
      for (int j = 0; j <= i; ++j) form.weights(fe::find_weight(r, i, j), 0) = K(i, j);
    forms.push_back(std::move(form));
  }
  return forms;
}

}  // namespace

DirectModel make_direct_model(const fe::System& system, const records::DynamicDeck& deck,
                              const records::DynamicSubcase& subcase, const Excitation& excitation,
                              const DampingChoice& damping) {
  const fe::Model& model = system.model;
  DirectModel direct;
  direct.K = system.K;
  direct.M = system.M;
  direct.K_diagonal = system.K_diagonal;
  direct.M_diagonal = system.M_diagonal;
  // Stiffness on which g and α2 act: all but K2PP.
  SymmetricMatrix structure = system.K;
  if (damping.times_direct) {
    const auto none = [](const fe::Element&, Eigen::Ref<MatrixXd>) {};
    structure = linear::add(
        system.K, -1,
        fe::assemble(model, fe::DofSet::Free, fe::MatrixKind::Other, none, list_direct_forms(model, deck, subcase)));
  }
  SymmetricMatrix of_elements =
      fe::assemble(model, fe::DofSet::Free, fe::MatrixKind::Other,
                   [](const fe::Element& e, Eigen::Ref<MatrixXd> K) { e.add_structural_damping(0, K); });
  if (is_zero(of_elements)) of_elements = SymmetricMatrix();
  if (fe::has_damping(model)) direct.B = fe::assemble_damping(model, fe::DofSet::Free);
  accumulate(direct.B, damping.alpha1, system.M);
  accumulate(direct.B, damping.alpha2, structure);
  if (damping.is_over_time) {
    if (damping.w4 > 0) accumulate(direct.B, 1 / damping.w4, of_elements);
    if (damping.w3 > 0) accumulate(direct.B, damping.g / damping.w3, structure);
  } else {
    accumulate(direct.S, 1, of_elements);
    accumulate(direct.S, damping.g, structure);
  }
  const auto on_free = [&](const MatrixXd& Y) { return MatrixXd(model.T().transpose() * Y); };
  direct.X = model.T_fixed() * excitation.D;
  if (model.omitted()) direct.X -= model.omitted()(fe::calc_stiffness_times(model, direct.X));  // follow the supports
  direct.F = on_free(excitation.F);
  direct.K_X = on_free(fe::calc_stiffness_times(model, direct.X));
  direct.M_X = on_free(fe::calc_mass_times(model, model.mass_kind(), direct.X));
  direct.B_X = on_free(times_damping(model, damping, direct.X));
  direct.S_X = on_free(times_structural(model, damping, direct.X));
  return direct;
}

}  // namespace bough::modal::response
