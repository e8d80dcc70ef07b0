#include "formats/mbdyn/fem_file.hpp"

#include <algorithm>
#include <cstdio>

namespace bough::mbdyn {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using records::FlexBody;

namespace {

class Writer {
 public:
  void put_comment(const std::string& text) { text_ += "** " + text + "\n"; }
  void begin_group(int number, const char* name) {
    put_comment("");
    put_comment("RECORD GROUP " + std::to_string(number) + ", " + name);
  }
  void put_line(const std::string& text) { text_ += text + "\n"; }
  void put_row(const Eigen::Ref<const Eigen::RowVectorXd>& row) {
    char text[40];
    for (Index j = 0; j < row.size(); ++j) {
      std::snprintf(text, sizeof text, j == 0 ? "%.16e" : " %.16e", row[j] + 0.0);
      text_ += text;
    }
    text_ += '\n';
  }
  void put_rows(const Eigen::Ref<const MatrixXd>& matrix) {
    for (Index i = 0; i < matrix.rows(); ++i) put_row(matrix.row(i));
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

struct Stress {
  int index;  ///< of record group 19
  MatrixXd K0;
};

/// K_G1 of 1..12: ω1² ω2² ω3² ω1ω2 ω2ω3 ω1ω3, angular, linear acceleration, in the order of A_I.
constexpr std::size_t kInertialOrder[12] = {6, 7, 8, 9, 11, 10, 3, 4, 5, 0, 1, 2};

class FemMaker {
 public:
  FemMaker(const FlexBody& body, const SourceLocation& where, Diagnostics& diagnostics)
      : body_(body), set_(body.integrals()), where_(where), diagnostics_(diagnostics), n_(body.num_modes()) {}

  std::string run() {
    out_.put_comment("MBDyn modal data of body " + clean(body_.name) + ", integrals " + body_.integrals_method);
    put_nodes();
    put_modal_matrices();
    put_invariants();
    put_stress_stiffening();
    out_.put_comment("END OF FILE");
    return out_.take();
  }

 private:
  static std::string clean(std::string text) {
    for (auto& c : text)
      if (c < ' ' || c > '~') c = '?';
    return text;
  }

  void put_nodes() {
    const auto ids = order_nodes(body_);
    std::vector<Index> rows;
    std::string labels;
    for (const int id : ids) {
      rows.push_back(body_.find_node(id));
      labels += (labels.empty() ? "" : " ") + std::to_string(id);
    }
    out_.begin_group(1, "HEADER");
    out_.put_comment("  REVISION, NODES, NORMAL, ATTACHMENT, CONSTRAINT, REJECTED MODES");
    out_.put_line("REV0 " + std::to_string(ids.size()) + " " + std::to_string(n_) + " 0 0 0");
    out_.begin_group(2, "FINITE ELEMENT NODE LIST");
    out_.put_line(labels);
    out_.begin_group(3, "INITIAL MODAL DISPLACEMENTS");
    out_.put_row(Eigen::RowVectorXd::Zero(n_));
    out_.begin_group(4, "INITIAL MODAL VELOCITIES");
    out_.put_row(Eigen::RowVectorXd::Zero(n_));
    static constexpr const char* kCoordinates[] = {"NODAL X COORDINATES", "NODAL Y COORDINATES", "NODAL Z COORDINATES"};
    for (int a = 0; a < 3; ++a) {
      out_.begin_group(5 + a, kCoordinates[a]);
      for (const Index k : rows) out_.put_row(body_.node_xyz.block(k, a, 1, 1));
    }
    out_.begin_group(8, "MODE SHAPES");
    for (int j = 0; j < n_; ++j) {
      out_.put_comment("  NORMAL MODE SHAPE # " + std::to_string(j + 1));
      for (const Index k : rows) out_.put_row(body_.phi[std::size_t(k)].col(j).transpose());
    }
  }

  void put_modal_matrices() {
    out_.begin_group(9, "MODAL MASS MATRIX");
    out_.put_rows(body_.modal_mass);
    out_.begin_group(10, "MODAL STIFFNESS MATRIX");
    out_.put_rows(body_.modal_stiffness);
    out_.begin_group(12, "RIGID BODY INERTIA MATRIX");
    out_.put_row(Eigen::RowVectorXd::Constant(1, body_.mass));
    out_.put_row(body_.cg.transpose());
    const auto& c = body_.cg;
    const Matrix3d central = body_.inertia - body_.mass * (c.squaredNorm() * Matrix3d::Identity() - c * c.transpose());
    out_.put_rows(central);
    out_.begin_group(13, "MODAL DAMPING MATRIX");
    out_.put_rows(body_.modal_damping.size() > 0 ? body_.modal_damping : MatrixXd::Zero(n_, n_));
  }

  void put_invariants() {
    MatrixXd inv8(3, 3 * n_), inv5(3, n_ * n_), inv9(3, 3 * n_ * n_);
    for (int j = 0; j < n_; ++j) {
      const auto s = std::size_t(j);
      inv8.middleCols(3 * j, 3) = set_.gamma3[s];
      for (int k = 0; k < n_; ++k) {
        inv5.col(j * n_ + k) = set_.gamma2[s].col(k);
        inv9.middleCols(3 * (j * n_ + k), 3) = -set_.gamma4[s][std::size_t(k)].transpose();
      }
    }
    out_.begin_group(14, "INVARIANT 3");
    out_.put_rows(set_.gamma0);
    out_.begin_group(15, "INVARIANT 4");
    out_.put_rows(set_.gamma1);
    out_.begin_group(16, "INVARIANT 8");
    out_.put_rows(inv8);
    out_.begin_group(17, "INVARIANT 5");
    out_.put_rows(inv5);
    out_.begin_group(18, "INVARIANT 9");
    out_.put_rows(inv9);
  }

  std::vector<Stress> collect_stiffening() {
    static constexpr const char* kLoads[] = {"ax",  "ay",  "az",  "alx",  "aly",  "alz",
                                             "wx2", "wy2", "wz2", "wxwy", "wxwz", "wywz"};
    std::vector<Stress> found;
    std::string missing;
    for (int i = 0; i < 12; ++i) {
      const auto load = kInertialOrder[i];
      if (body_.kg_inertial_computed[load] && body_.kg_inertial[load].size() > 0)
        found.push_back({i + 1, body_.kg_inertial[load]});
      else
        missing += (missing.empty() ? "" : " ") + std::string(kLoads[load]);
    }
    if (!missing.empty() && n_ > 0)
      diagnostics_.warning("export.no-stiffening", where_, "no geometric stiffness of the inertial loads " + missing,
                           "reduce without limiting the inertial loads");
    std::vector<bool> is_used(body_.locators.size(), false);
    for (std::size_t i = 0; i < body_.interface_nodes.size(); ++i) {
      for (int d = 1; d <= 6; ++d) {
        const int e = body_.find_locator(body_.interface_nodes[i], d);
        if (e < 0) continue;
        is_used[std::size_t(e)] = true;
        found.push_back({12 + 6 * static_cast<int>(i) + d, body_.kg_external[std::size_t(e)]});
      }
    }
    std::string dropped;
    for (std::size_t e = 0; e < is_used.size(); ++e)
      if (!is_used[e]) dropped += (dropped.empty() ? "\"" : ", \"") + body_.locators[e].name + "\"";
    if (!dropped.empty())
      diagnostics_.warning("export.dropped-loads", where_,
                           "MBDyn supports unit loads at interface nodes only; omitted: " + dropped,
                           "make their nodes interface nodes; a load pattern has no place in the file");
    return found;
  }

  void put_stress_stiffening() {
    const auto found = collect_stiffening();
    if (found.empty()) return;  // a group that is not there is absent, not zero
    out_.begin_group(19, "MODAL STRESS STIFFENING MATRIX");
    out_.put_line(std::to_string(found.size()));
    for (const auto& [index, K0] : found) {
      out_.put_line(std::to_string(index));
      out_.put_rows(0.5 * (K0 + K0.transpose()));
    }
  }

  const FlexBody& body_;
  const records::MassIntegrals& set_;
  const SourceLocation& where_;
  Diagnostics& diagnostics_;
  const int n_;
  Writer out_;
};

}  // namespace

std::vector<int> order_nodes(const FlexBody& body) {
  std::vector<int> ids = body.interface_nodes;
  for (const int id : body.node_id)
    if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
  return ids;
}

std::string make_fem(const FlexBody& body, const SourceLocation& where, Diagnostics& diagnostics) {
  if (body.integrals().empty())
    throw InputError("export.no-integrals", where, "the body has no mass integrals \"" + body.integrals_method + "\"",
                     "reduce the body again");
  return FemMaker(body, where, diagnostics).run();
}

}  // namespace bough::mbdyn
