#include "formats/records/mode_subset.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "base/diagnostic.hpp"

namespace bough::records {
namespace {

class Cut {
 public:
  explicit Cut(const std::vector<int>& kept) : kept_(kept) {}

  // Arrays that a body does not have stay empty.
  void rows(MatrixXd& m) const { m = m.size() == 0 ? m : MatrixXd(m(kept_, Eigen::all)); }
  void cols(MatrixXd& m) const { m = m.size() == 0 ? m : MatrixXd(m(Eigen::all, kept_)); }
  void both(MatrixXd& m) const { m = m.size() == 0 ? m : MatrixXd(m(kept_, kept_)); }
  void entries(VectorXd& v) const { v = v.size() == 0 ? v : VectorXd(v(kept_)); }
  template <class T>
  void entries(std::vector<T>& all) const {
    if (all.empty()) return;
    std::vector<T> cut;
    for (const int j : kept_) cut.push_back(std::move(all[static_cast<std::size_t>(j)]));
    all = std::move(cut);
  }
  void integrals(MassIntegrals& g) const {
    if (g.empty()) return;
    cols(g.gamma0);
    cols(g.gamma1);
    entries(g.gamma2);
    for (auto& m : g.gamma2) cols(m);
    entries(g.gamma3);
    entries(g.gamma4);
    for (auto& row : g.gamma4) entries(row);
  }

 private:
  const std::vector<int>& kept_;
};

}  // namespace

FlexBody keep_modes(const FlexBody& body, const std::vector<int>& kept) {
  BOUGH_DEMAND(!kept.empty());
  for (std::size_t i = 0; i < kept.size(); ++i)
    BOUGH_DEMAND(kept[i] >= 0 && kept[i] < body.num_modes() && (i == 0 || kept[i] > kept[i - 1]));
  const Cut cut(kept);
  FlexBody small = body;
  // Third order is about the manifold of all modes; K_G1 and K_G2 stay.
  if (static_cast<int>(kept.size()) < body.num_modes()) small.third_order = {};
  // The energy of soft modes belongs to all of them.
  for (int& mode : small.next_order.modes) {
    const auto found = std::lower_bound(kept.begin(), kept.end(), mode);
    mode = found != kept.end() && *found == mode ? static_cast<int>(found - kept.begin()) : -1;
  }
  if (!are_modes(small.next_order.modes, static_cast<int>(kept.size()))) small.next_order = {};
  cut.entries(small.frequency_hz);
  cut.entries(small.eigenvalue);
  cut.entries(small.kind);
  for (auto& shape : small.phi) cut.cols(shape);
  cut.both(small.modal_mass);
  cut.both(small.modal_stiffness);
  cut.both(small.modal_damping);
  cut.rows(small.effective_mass);
  cut.integrals(small.lumped);
  cut.integrals(small.consistent);
  cut.integrals(small.exact);
  for (auto& K_G : small.kg_inertial) cut.both(K_G);
  for (auto& K_G : small.kg_external) cut.both(K_G);
  cut.rows(small.external_load);
  for (auto& moment : small.load_moment) cut.cols(moment);
  cut.both(small.kg_preload);
  cut.cols(small.full_phi);
  if (small.mesh_phi.size() > 0) small.mesh_phi = Eigen::MatrixXf(body.mesh_phi(Eigen::all, kept));
  if (!small.strain_energy.empty()) {
    std::vector<Eigen::Index> columns;
    for (std::size_t i = 0; i < kept.size(); ++i)
      for (std::size_t j = i; j < kept.size(); ++j)
        columns.push_back(ElementStrainEnergy::find_column(kept[i], kept[j], body.num_modes()));
    small.strain_energy.matrix = MatrixXd(small.strain_energy.matrix(Eigen::all, columns));
  }
  // Residual static responses grow by the share of the modes that are left out here.
  for (auto& block : small.recovery) {
    if (small.third_order.empty()) block.beyond = {};
    const MatrixXd all = block.matrix;
    cut.cols(block.matrix);
    const auto gap = [&](const MatrixXd& loads) -> MatrixXd {  // n x k: generalized loads
      const MatrixXd kept_part = block.matrix * small.modal_stiffness.ldlt().solve(MatrixXd(loads(kept, Eigen::all)));
      return all * body.modal_stiffness.ldlt().solve(loads) - kept_part;
    };
    if (body.inertial_load.size() > 0) block.inertial += gap(body.inertial_load);
    if (block.external.cols() > 0) block.external += gap(body.external_load);
  }
  cut.rows(small.inertial_load);
  return small;
}

}  // namespace bough::records
