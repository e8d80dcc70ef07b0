#include "small_model.hpp"

#include <algorithm>
#include <set>

#include <Eigen/Eigenvalues>

#include "fe/elements/geometric_projection.hpp"

namespace bough::fe::test {

int HandNodes::add_grid(int id, const Vector3d& x, const Matrix3d& R_basic_cd) {
  Node node;
  node.id = id;
  node.x = x;
  node.R_basic_cd = R_basic_cd;
  node.first_gdof = num_gdofs_;
  num_gdofs_ += 6;
  nodes_.push_back(node);
  return num_nodes() - 1;
}

int HandNodes::add_scalar_point(int id) {
  Node node;
  node.id = id;
  node.first_gdof = num_gdofs_;
  node.num_dofs = 1;
  num_gdofs_ += 1;
  nodes_.push_back(node);
  return num_nodes() - 1;
}

int HandNodes::find_node(int id) const {
  for (int k = 0; k < num_nodes(); ++k)
    if (node(k).id == id) return k;
  return -1;
}

Matrix3d HandNodes::calc_axes(int cid, const Vector3d&, const SourceLocation& at, Diagnostics& diagnostics) const {
  if (cid == 0) return Matrix3d::Identity();
  const auto it = systems_.find(cid);
  if (it != systems_.end()) return it->second.second;
  diagnostics.error("fe.missing-system", at, "no coordinate system " + std::to_string(cid));
  return Matrix3d::Identity();
}

Vector3d HandNodes::calc_point(int cid, const Vector3d& x, const SourceLocation& at, Diagnostics& diagnostics) const {
  const auto it = systems_.find(cid);
  const Vector3d origin = it == systems_.end() ? Vector3d::Zero() : it->second.first;
  return origin + calc_axes(cid, x, at, diagnostics) * x;
}

MatrixXd HandNodes::calc_rigid_modes() const {
  MatrixXd Phi_R = MatrixXd::Zero(num_gdofs_, 6);
  for (const Node& node : nodes_) {
    if (node.num_dofs != 6) continue;
    Phi_R.block<6, 6>(node.first_gdof, 0).setIdentity();
    Phi_R.block<3, 3>(node.first_gdof, 3) = -skew(node.x);
  }
  return Phi_R;
}

SmallModel::SmallModel() { deck.files = {"hand.bdf"}; }

void SmallModel::make() {
  Diagnostics diagnostics;
  elements = std::move(make_elements(deck, nodes, diagnostics).elements);
  for (const Diagnostic& d : diagnostics.items())
    if (d.severity == Severity::Error) ADD_FAILURE() << format(d);
}

namespace {

void scatter(const Element& element, const MatrixXd& local, MatrixXd* global) {
  const auto& dofs = element.gdofs();
  for (std::size_t i = 0; i < dofs.size(); ++i)
    for (std::size_t j = 0; j < dofs.size(); ++j)
      (*global)(dofs[i], dofs[j]) += local(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
}

}  // namespace

MatrixXd SmallModel::calc_stiffness() const {
  MatrixXd K = MatrixXd::Zero(nodes.num_gdofs(), nodes.num_gdofs());
  for (const auto& element : elements) {
    MatrixXd local = MatrixXd::Zero(element->num_dofs(), element->num_dofs());
    element->add_stiffness(1, local);
    scatter(*element, local, &K);
  }
  return K;
}

MatrixXd SmallModel::calc_mass(MassKind kind) const {
  MatrixXd M = MatrixXd::Zero(nodes.num_gdofs(), nodes.num_gdofs());
  for (const auto& element : elements) {
    MatrixXd local = MatrixXd::Zero(element->num_dofs(), element->num_dofs());
    element->add_mass(kind, 1, local);
    scatter(*element, local, &M);
  }
  return M;
}

/// Its projection for one load and for more than there are internal forces is that of the element's matrix.
static void check_projection(const Element& element, const VectorXd& u, const MatrixXd& K_G) {
  const Eigen::Index N = u.size();
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (const Eigen::Index num_loads : {1, 250}) {
    const VectorXd factor = VectorXd::NullaryExpr(num_loads, [](auto c) { return c % 2 ? 1.0 : -2.0; });  // exact
    const MatrixXd Phi = num_loads == 1 ? MatrixXd(MatrixXd::Identity(N, N))
                                        : MatrixXd(MatrixXd::NullaryExpr(N, 3, [&] { return normal(random); }));
    GeometricProjection sums(Phi.cols(), num_loads);
    element.stress_state()->add_projected_geometric_stiffness(u * factor.transpose(), Phi, sums);
    const auto result = sums.finish();
    const MatrixXd expected = Phi.transpose() * (0.5 * (K_G + K_G.transpose())) * Phi;
    for (const Eigen::Index c : {Eigen::Index(0), num_loads - 1})
      EXPECT_LE((result[static_cast<std::size_t>(c)] - factor[c] * expected).norm(),
                1e-12 * Phi.squaredNorm() * K_G.norm())
          << element.card() << " " << element.id() << ", " << num_loads << " loads";
  }
}

MatrixXd SmallModel::calc_geometric_stiffness(const VectorXd& u) const {
  MatrixXd K_G = MatrixXd::Zero(nodes.num_gdofs(), nodes.num_gdofs());
  for (const auto& element : elements) {
    const StressState* state = element->stress_state();
    if (!state) continue;
    VectorXd u_e(element->num_dofs());
    for (int i = 0; i < element->num_dofs(); ++i) u_e[i] = u[element->gdofs()[static_cast<std::size_t>(i)]];
    VectorXd force(state->num_internal_forces());
    state->calc_internal_forces(u_e, force);
    MatrixXd local = MatrixXd::Zero(element->num_dofs(), element->num_dofs());
    state->add_geometric_stiffness(force, 1, local);
    check_projection(*element, u_e, local);
    scatter(*element, local, &K_G);
  }
  return K_G;
}

void add_two_grids(SmallModel& m) {
  m.nodes.add_grid(1, kPointA, make_rotation(11));
  m.nodes.add_grid(2, kPointB, make_rotation(12));
  m.nodes.add_system(7, Vector3d(1, 2, 3), make_rotation(13));
}

void add_line_material(SmallModel& m) {
  records::Mat1 material;
  material.id = 1, material.E = 3, material.G = 1.1, material.rho = 0.8;
  m.deck.mat1.push_back(material);
}

records::BeamElement make_beam(bool is_cbeam) {
  records::BeamElement e;
  e.id = 5, e.pid = 9, e.ga = 1, e.gb = 2, e.is_cbeam = is_cbeam;
  e.v = Vector3d(0.2, 1, -0.3);
  return e;
}

void add_isotropic(SmallModel& m, double t) {
  records::Mat1 material;
  material.id = 1, material.E = 3, material.nu = 0.3, material.G = 3 / 2.6, material.rho = 0.8;
  m.deck.mat1.push_back(material);
  records::Pshell p;
  p.id = 1, p.mid1 = p.mid2 = p.mid3 = 1, p.t = t, p.nsm = 0.1;
  m.deck.pshell.push_back(p);
}

int count_messages(const SmallModel& m, const char* id) {
  Diagnostics diagnostics;
  make_elements(m.deck, m.nodes, diagnostics);
  int n = 0;
  for (const auto& d : diagnostics.items()) n += d.id == id ? 1 : 0;
  return n;
}

std::vector<int> list_free(int n, const std::vector<int>& fixed) {
  const std::set<int> out(fixed.begin(), fixed.end());
  std::vector<int> free;
  for (int i = 0; i < n; ++i)
    if (!out.contains(i)) free.push_back(i);
  return free;
}

MatrixXd pick(const MatrixXd& A, const std::vector<int>& rows) { return A(rows, rows); }

VectorXd solve_static(const MatrixXd& K, const VectorXd& f, const std::vector<int>& fixed) {
  const auto free = list_free(static_cast<int>(K.rows()), fixed);
  VectorXd u = VectorXd::Zero(K.rows());
  VectorXd rhs(static_cast<Eigen::Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i) rhs[static_cast<Eigen::Index>(i)] = f[free[i]];
  rhs = pick(K, free).ldlt().solve(rhs).eval();
  for (std::size_t i = 0; i < free.size(); ++i) u[free[i]] = rhs[static_cast<Eigen::Index>(i)];
  return u;
}

VectorXd calc_frequencies(const MatrixXd& K, const MatrixXd& M, const std::vector<int>& fixed) {
  const auto free = list_free(static_cast<int>(K.rows()), fixed);
  // M φ = (1/ω²) K φ: massless dofs give zeros at the far end.
  Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(pick(M, free), pick(K, free), Eigen::EigenvaluesOnly);
  VectorXd omega = solver.eigenvalues().reverse();
  for (double& value : omega) value = value > 0 ? 1 / std::sqrt(value) : std::numeric_limits<double>::infinity();
  return omega;
}

double calc_load_factor(const MatrixXd& K, const MatrixXd& K_G, const std::vector<int>& fixed) {
  const auto free = list_free(static_cast<int>(K.rows()), fixed);
  Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(-pick(K_G, free), pick(K, free), Eigen::EigenvaluesOnly);
  return 1 / solver.eigenvalues().maxCoeff();
}

Matrix3d make_rotation(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  return q.normalized().toRotationMatrix();
}

SmallModel make_bar_chain(const ChainOptions& options) {
  SmallModel model;
  records::Mat1 material;
  material.id = 1;
  material.E = options.E;
  material.G = options.G;
  material.rho = options.rho;
  model.deck.mat1.push_back(material);
  records::Pbar section = options.section;
  section.id = section.mid = 1;
  model.deck.pbar.push_back(section);
  for (int k = 0; k <= options.num_elements; ++k)
    model.nodes.add_grid(k + 1, options.R.col(0) * options.length * k / options.num_elements);
  for (int k = 1; k <= options.num_elements; ++k) {
    records::BeamElement bar;
    bar.id = k;
    bar.pid = 1;
    bar.ga = k;
    bar.gb = k + 1;
    bar.v = options.R.col(1);
    model.deck.beams.push_back(bar);
  }
  model.make();
  return model;
}

}  // namespace bough::fe::test
