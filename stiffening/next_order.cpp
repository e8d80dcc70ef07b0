// Strain energy of the softest modes to degree 4, by which the error of a body of second order is estimated
// (docs/theory/third-order.md, "Next order").
#include <algorithm>
#include <numeric>

#include "stiffening/large_modes.hpp"
#include "stiffening/static_manifold.hpp"

namespace bough::stiffening {
namespace {

using records::NextOrder;

/// Elements times curves at most, 0.07 ms each for shells: a second. The frames and K_G of an element count as curves.
constexpr double kMaxWork = 15000, kCurvesOfElement = 7;

/// Number of modes whose energy is computed: kMaxModes, fewer of models with many elements, none of very large ones.
int find_num_modes(const fe::Model& model) {
  for (int N = NextOrder::kMaxModes; N > 0; --N) {
    const double num_curves = kCurvesOfElement + records::count_monomials(N, 2) + records::count_monomials(N, 4);
    if (num_curves * static_cast<double>(model.elements().size()) <= kMaxWork) return N;
  }
  return 0;
}

/// Square of the largest translation in each mode of unit strain energy: of interface nodes, where loads act, or of all
/// grids if these move in no mode.
VectorXd calc_softness(const BodyRequest& request, const fe::Model& model, const ModalBasis& basis) {
  constexpr double kAtRest = 1e-3;  // of a way
  const VectorXd inverse = basis.stiffness.diagonal().cwiseMax(1e-300).cwiseInverse();
  const VectorXd all = calc_largest_ways(model, basis.Phi).cwiseAbs2().cwiseProduct(inverse);
  VectorXd ways = VectorXd::Zero(all.size());
  for (const int id : list_interface_nodes(request.spec)) {
    const int first = model.node(model.find_node(id)).first_gdof;
    ways = ways.cwiseMax(basis.Phi.middleRows<3>(first).colwise().norm().transpose());
  }
  const VectorXd of_interface = ways.cwiseAbs2().cwiseProduct(inverse);
  return of_interface.maxCoeff() > kAtRest * kAtRest * all.maxCoeff() ? of_interface : all;
}

/// The softest normal modes, ascending.
std::vector<int> find_soft_modes(const BodyRequest& request, const fe::Model& model, const ModalBasis& basis,
                                 int max_modes) {
  std::vector<int> modes;
  for (int j = 0; j < static_cast<int>(basis.Phi.cols()); ++j)
    if (basis.kind[static_cast<std::size_t>(j)] == records::ModeKind::Normal && basis.stiffness(j, j) > 0)
      modes.push_back(j);
  if (modes.empty()) return modes;
  const VectorXd softness = calc_softness(request, model, basis);
  std::stable_sort(modes.begin(), modes.end(), [&](int a, int b) { return softness[a] > softness[b]; });
  modes.resize(std::min(modes.size(), static_cast<std::size_t>(max_modes)));
  std::sort(modes.begin(), modes.end());
  return modes;
}

ModalBasis select_modes(const ModalBasis& basis, const std::vector<int>& modes) {
  ModalBasis selected;
  selected.Phi = basis.Phi(Eigen::all, modes);
  selected.eigenvalue = basis.eigenvalue(modes);
  selected.mass = basis.mass(modes, modes);
  selected.stiffness = basis.stiffness(modes, modes);
  selected.kind.assign(modes.size(), records::ModeKind::Normal);
  return selected;
}

}  // namespace

void set_next_order(const BodyRequest& request, const fe::Model& model, const ModalBasis& basis,
                    const StaticSupport& support, const InertialLoads& inertial, records::FlexBody& body) {
  const int max_modes = find_num_modes(model);
  if (max_modes == 0 || request.spec.stiffening_order >= 3 || !has_series(request, model)) return;
  const std::vector<int> modes = find_soft_modes(request, model, basis, max_modes);
  if (modes.empty()) return;
  request.report("energy of soft modes");
  StaticManifold manifold(request, model, select_modes(basis, modes), support, inertial.M);
  if (!manifold.has_frame()) return;
  const int N = static_cast<int>(modes.size());
  const Lattice pairs(N, 2), cubic(N, 3), quartic(N, 4);
  const MatrixXd gradient = manifold.begin(pairs);
  std::vector<int> all(modes.size());
  std::iota(all.begin(), all.end(), 0);
  manifold.select_large(all, gradient);
  const auto fit = [&](const Lattice& lattice, const MatrixXd& forces, int degree) -> VectorXd {
    MatrixXd c = fit_energy(lattice, forces, degree).transpose();
    unscale(lattice.exponents(), manifold.scale(), c);
    return c.transpose();
  };
  body.next_order.modes = modes;
  body.next_order.cubic = fit(cubic, gradient * calc_monomials(pairs.exponents(), cubic.points()).transpose(), 3);
  body.next_order.quartic = fit(quartic, manifold.calc_gradient(quartic.points(), 3), 4);
}

}  // namespace bough::stiffening
