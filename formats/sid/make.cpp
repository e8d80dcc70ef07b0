#include "base/rotation.hpp"
#include "formats/sid/sid.hpp"

namespace bough::sid {

using Eigen::Index;
using Eigen::Matrix3d;
using records::FlexBody;

namespace {

/// Rows and columns of the tensor in the order of J (11 22 33 12 13 23) and of Oe (11 22 33 12 23 13).
constexpr int kInertiaOrder[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
constexpr int kOmegaOrder[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
/// K_G1 of ω1² ω2² ω3² ω1ω2 ω2ω3 ω1ω3 in the order of A_I.
constexpr std::size_t kOmegaLoad[6] = {6, 7, 8, 9, 11, 10};

MatrixXd pack_inertia(const Matrix3d& J, bool is_full) {
  if (is_full) return 0.5 * (J + J.transpose());
  MatrixXd six(6, 1);
  for (int c = 0; c < 6; ++c)
    six(c, 0) = 0.5 * (J(kInertiaOrder[c][0], kInertiaOrder[c][1]) + J(kInertiaOrder[c][1], kInertiaOrder[c][0]));
  return six;
}

/// The coefficient of ω_a ω_b in ωᵀ A ω.
double get_product(const Matrix3d& A, int c) {
  const int a = kOmegaOrder[c][0], b = kOmegaOrder[c][1];
  return a == b ? A(a, a) : A(a, b) + A(b, a);
}

class Maker {
 public:
  Maker(const FlexBody& body, const Layout& layout)
      : body_(body), set_(body.integrals()), layout_(layout), n_(body.num_modes()) {}

  Sid run() {
    set_rigid();
    set_coupling();
    set_gyroscopic();
    set_centrifugal();
    sid_.Me = {body_.modal_mass, {}};
    sid_.ksigma = Taylor::zero(n_, 1);
    sid_.Ke = {body_.modal_stiffness, {}};
    sid_.De = {body_.modal_damping.size() > 0 ? body_.modal_damping : MatrixXd::Zero(n_, n_), {}};
    for (int k = 0; k < body_.num_nodes(); ++k) sid_.nodes.push_back(make_node(k));
    return std::move(sid_);
  }

 private:
  MatrixXd get_inertial(std::size_t i) const {
    const auto& G = body_.kg_inertial[i];
    if (!body_.kg_inertial_computed[i] || G.size() == 0) return MatrixXd::Zero(n_, n_);
    return 0.5 * (G + G.transpose());
  }

  void set_rigid() {
    static constexpr const char* kKinds[] = {"Eigen Mode", "Constraint Mode", "Attachment Mode"};
    sid_.mass = body_.mass;
    for (int j = 0; j < n_; ++j) {
      char name[80];
      std::snprintf(name, sizeof name, "%s %4d : %12.6g Hz", kKinds[static_cast<int>(body_.kind[std::size_t(j)])],
                    j + 1, body_.frequency_hz[j]);
      sid_.mode_name.emplace_back(name);
    }
    sid_.mdCM = Taylor::zero(3, 1, n_);
    sid_.mdCM.m0 = body_.mass * body_.cg;
    sid_.J = {pack_inertia(body_.inertia, layout_.is_full_inertia), {}};
    for (int j = 0; j < n_; ++j) {
      const Matrix3d& g3 = set_.gamma3[std::size_t(j)];
      sid_.mdCM.m1[std::size_t(j)] = set_.gamma0.col(j);
      sid_.J.m1.push_back(pack_inertia(g3 + g3.transpose(), layout_.is_full_inertia));
    }
  }

  void set_coupling() {
    sid_.Ct = Taylor::zero(n_, 3, n_);
    sid_.Cr = Taylor::zero(n_, 3, n_);
    sid_.Ct.m0 = set_.gamma0.transpose();
    sid_.Cr.m0 = set_.gamma1.transpose();
    for (std::size_t a = 0; a < 3; ++a) {
      const MatrixXd Gt = get_inertial(a), Gr = get_inertial(3 + a);
      for (int k = 0; k < n_; ++k) {
        const auto c = static_cast<Index>(a);
        sid_.Ct.m1[std::size_t(k)].col(c) = Gt.col(k);
        sid_.Cr.m1[std::size_t(k)].col(c) = Gr.col(k) + set_.gamma2[std::size_t(k)].row(c).transpose();
      }
    }
  }

  void set_gyroscopic() {
    sid_.Gr = Taylor::zero(3, 3 * n_);
    sid_.Ge = Taylor::zero(n_, 3 * n_);
    for (int k = 0; k < n_; ++k) {
      const auto s = std::size_t(k);
      const Matrix3d& g3 = set_.gamma3[s];
      // 2 Γ3 for point masses; with rotary inertia the moment of momentum is Γ1 and not the skew part of Γ3.
      sid_.Gr.m0.middleCols(3 * k, 3) = g3 + g3.transpose() - skew(Eigen::Vector3d(set_.gamma1.col(k)));
      for (int a = 0; a < 3; ++a)
        for (int j = 0; j < n_; ++j)
          sid_.Ge.m0(j, layout_.by_component ? a * n_ + k : 3 * k + a) =
              set_.gamma2[s](a, j) - set_.gamma2[std::size_t(j)](a, k);
    }
  }

  void set_centrifugal() {
    sid_.Oe = Taylor::zero(n_, 6, n_);
    for (int c = 0; c < 6; ++c) {
      const MatrixXd G = get_inertial(kOmegaLoad[c]);
      for (int j = 0; j < n_; ++j) {
        const auto& g4 = set_.gamma4;
        sid_.Oe.m0(j, c) = -get_product(set_.gamma3[std::size_t(j)], c);
        for (int k = 0; k < n_; ++k)
          sid_.Oe.m1[std::size_t(k)](j, c) = G(j, k) - 0.5 * (get_product(g4[std::size_t(j)][std::size_t(k)], c) +
                                                              get_product(g4[std::size_t(k)][std::size_t(j)], c));
      }
    }
  }

  Taylor make_jacobian(int k, int first_direction) const {
    Taylor jacobian{body_.phi[std::size_t(k)].middleRows(first_direction - 1, 3), {}};
    for (int a = 0; a < 3; ++a) {
      const int locator = body_.find_locator(body_.node_id[std::size_t(k)], first_direction + a);
      if (locator < 0) continue;
      if (jacobian.m1.empty()) jacobian.m1.assign(std::size_t(n_), MatrixXd::Zero(3, n_));
      const MatrixXd& G = body_.kg_external[std::size_t(locator)];
      for (int q = 0; q < n_; ++q) jacobian.m1[std::size_t(q)].row(a) = -0.5 * (G.row(q) + G.col(q).transpose());
    }
    return jacobian;
  }

  Node make_node(int k) const {
    Node node;
    node.id = std::to_string(body_.node_id[std::size_t(k)]);
    node.origin = {body_.node_xyz.row(k).transpose(), {}};
    node.phi = make_jacobian(k, 1);
    node.psi = make_jacobian(k, 4);
    node.AP = {Matrix3d::Identity(), {}};
    for (int q = 0; q < n_; ++q) {
      node.origin.m1.push_back(node.phi.m0.col(q));
      node.AP.m1.push_back(skew(Eigen::Vector3d(node.psi.m0.col(q))));
    }
    return node;
  }

  const FlexBody& body_;
  const records::MassIntegrals& set_;
  const Layout& layout_;
  const int n_;
  Sid sid_;
};

}  // namespace

Taylor Taylor::zero(Index rows, Index columns, int nq) {
  Taylor taylor = zero(rows, columns);
  taylor.m1.assign(static_cast<std::size_t>(nq), taylor.m0);
  return taylor;
}

MatrixXd Taylor::evaluate(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  MatrixXd M = m0;
  for (std::size_t k = 0; k < m1.size(); ++k) M += q[static_cast<Index>(k)] * m1[k];
  return M;
}

Sid make_sid(const FlexBody& body, const Layout& layout, const SourceLocation& where, Diagnostics& diagnostics) {
  if (body.integrals().empty())
    throw InputError("export.no-integrals", where, "the body has no mass integrals \"" + body.integrals_method + "\"",
                     "reduce the body again");
  static constexpr const char* kLoads[] = {"ax",  "ay",  "az",  "alx",  "aly",  "alz",
                                           "wx2", "wy2", "wz2", "wxwy", "wxwz", "wywz"};
  std::string missing;
  for (std::size_t i = 0; i < body.kg_inertial_computed.size(); ++i)
    if (!body.kg_inertial_computed[i]) missing += (missing.empty() ? "" : " ") + std::string(kLoads[i]);
  if (!missing.empty() && body.num_modes() > 0)
    diagnostics.warning("export.no-stiffening", where, "no geometric stiffness of the inertial loads " + missing,
                        "reduce without limiting the inertial loads");
  Sid sid = Maker(body, layout).run();
  sid.comment = "No. nodes, No. modes: body " + body.name + ", integrals " + body.integrals_method;
  for (auto& c : sid.comment)
    if (c < ' ' || c > '~') c = '?';
  return sid;
}

}  // namespace bough::sid
