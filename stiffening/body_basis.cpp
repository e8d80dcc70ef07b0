#include "stiffening/body_basis.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "formats/records/params.hpp"
#include "stiffening/reduce.hpp"

namespace bough::stiffening {

using modal::bases::BasisKind;
using modal::bases::DampingTable;
using modal::bases::FrameKind;
using records::BodyBasis;
using records::BodyFrame;
using records::BodySpec;

void check_basis(const BodySpec& spec, bool needs_modes, const SourceLocation& where, Diagnostics& diagnostics) {
  if (needs_modes && spec.num_modes <= 0 && !spec.max_frequency_hz && spec.select.empty() &&
      spec.basis == BodyBasis::Normal && spec.residual.empty())
    diagnostics.error("reduce.no-modes", where, "the body asks for no modes",
                      "give [body.modes] number, max_frequency or select");
  if (spec.basis != BodyBasis::Normal && spec.interface_nodes.empty())
    diagnostics.error("reduce.bad-basis", where, "the basis needs interface nodes", "name them in interface");
  const bool is_craig_bampton = spec.basis == BodyBasis::CraigBampton;
  if (!spec.orthogonalize && !is_craig_bampton && spec.augments.empty())
    diagnostics.error("reduce.bad-basis", where,
                      "orthogonalize = false has a meaning for craig-bampton and augmented modes only",
                      "remove it, or set basis = \"craig-bampton\"");
  if (!spec.orthogonalize && is_craig_bampton && spec.frame != BodyFrame::Fixed && spec.frame != BodyFrame::Node)
    diagnostics.error("reduce.bad-basis", where,
                      "orthogonalize = false keeps the rigid motions of the interface, which this frame removes",
                      "use frame = \"fixed\", or \"node\" with one of the interface nodes");
  std::set<std::string> names{"inertial", "interface"};
  for (const auto& load : spec.loads) names.insert(load.name);
  for (const auto& name : spec.residual) {
    if (names.count(name)) continue;
    std::string known;
    for (const auto& other : names)
      if (!other.empty()) known += (known.empty() ? "" : ", ") + other;
    diagnostics.error("reduce.unknown-load", where, "residual names '" + name + "', no load of the body is called so",
                      "the body has " + known);
  }
}

void check_damping(const BodySpec& spec, const SourceLocation& where, Diagnostics& diagnostics) {
  const auto bad = [&](const std::string& what, const std::string& advice) {
    diagnostics.error("reduce.bad-damping", where, what, advice);
  };
  const auto& ratios = spec.damping_ratios;
  if (spec.damping_ratio < 0 || std::any_of(ratios.begin(), ratios.end(), [](double z) { return z < 0; }) ||
      spec.residual_damping.value_or(0) < 0)
    bad("a damping ratio is negative", "give ratios of 0 or more");
  if (spec.rayleigh_alpha < 0 || spec.rayleigh_beta < 0 || spec.structural_damping < 0)
    bad("a damping factor is negative", "give 0 or more");
  const auto& table = spec.damping_table;
  for (std::size_t i = 1; i < table.points.size(); ++i)
    if (!(table.points[i].first > table.points[i - 1].first))
      bad("frequency " + std::to_string(i + 1) + " of the damping table is not above the one before",
          "sort the table by frequency, each once");
  if (table.kind == "quality" &&
      std::any_of(table.points.begin(), table.points.end(), [](const auto& p) { return !(p.second > 0); }))
    bad("a quality factor is not above 0", "give Q > 0, or a table of ratios");
  if (spec.residual_damping && !spec.orthogonalize)
    bad("residual_ratio stands with orthogonalize = false, where no mode is a residual vector", "remove one of them");
}

MatrixXd collect_residual_loads(const fe::Model& model, const BodySpec& spec, const std::vector<BodyLoad>& loads,
                                std::vector<std::string>& names) {
  MatrixXd F(model.num_gdofs(), 0);
  const auto add = [&](const MatrixXd& columns, const std::string& name) {
    F.conservativeResize(Eigen::NoChange, F.cols() + columns.cols());
    F.rightCols(columns.cols()) = columns;
    for (Eigen::Index c = 0; c < columns.cols(); ++c)
      names.push_back(columns.cols() > 1 ? name + " " + std::to_string(c + 1) : name);
  };
  for (const auto& word : spec.residual) {
    if (word == "inertial") {
      static constexpr const char* kNames[records::kNumInertialLoads] = {"ax",  "ay",  "az",  "alx",  "aly",  "alz",
                                                                         "wx2", "wy2", "wz2", "wxwy", "wxwz", "wywz"};
      const MatrixXd F_I = calc_inertial_loads(model, model.mass_kind());
      for (int i = 0; i < records::kNumInertialLoads; ++i) add(F_I.col(i), kNames[i]);
    } else if (word == "interface") {
      for (const int id : spec.interface_nodes) {
        MatrixXd units = MatrixXd::Zero(model.num_gdofs(), 6);
        units.middleRows(model.node(model.find_node(id)).first_gdof, 6).setIdentity();
        add(units, "node" + std::to_string(id));
      }
    } else {
      for (const auto& load : loads)
        if (load.group == word) add(load.load.F, load.locator.name);
    }
  }
  return F;
}

modal::bases::BasisOptions make_basis_options(const BodySpec& spec) {
  modal::bases::BasisOptions options;
  if (spec.basis == BodyBasis::CraigBampton) options.kind = BasisKind::CraigBampton;
  if (spec.basis == BodyBasis::CraigChang) options.kind = BasisKind::CraigChang;
  options.num_modes = spec.num_modes;
  if (spec.basis == BodyBasis::Normal && spec.residual.empty())
    for (const int s : spec.select) options.num_modes = std::max(options.num_modes, s);
  options.max_hz = spec.max_frequency_hz;
  options.interface_nodes = spec.interface_nodes;
  options.is_free = spec.frame != BodyFrame::Fixed;
  options.orthogonalize = spec.orthogonalize;
  return options;
}

modal::bases::FrameSpec make_frame_spec(const BodySpec& spec) {
  modal::bases::FrameSpec frame;
  if (spec.frame == BodyFrame::Node) frame.kind = FrameKind::Node;
  if (spec.frame == BodyFrame::ThreeNodes) frame.kind = FrameKind::ThreeNodes;
  if (spec.frame == BodyFrame::MassCentre) frame.kind = FrameKind::MassCentre;
  frame.nodes = spec.frame_nodes;
  return frame;
}

modal::bases::DampingSpec make_damping_spec(const BodySpec& spec) {
  modal::bases::DampingSpec damping;
  damping.ratio = spec.damping_ratio;
  damping.ratios = spec.damping_ratios;
  damping.table = spec.damping_table.points;
  if (spec.damping_table.kind == "structural") damping.table_kind = DampingTable::Structural;
  if (spec.damping_table.kind == "quality") damping.table_kind = DampingTable::Quality;
  damping.alpha = spec.rayleigh_alpha;
  damping.beta = spec.rayleigh_beta;
  damping.structural = spec.structural_damping;
  damping.residual_ratio = spec.residual_damping;
  return damping;
}

MatrixXd calc_material_damping(const fe::Model& model, double g, const MatrixXd& Phi) {
  const MatrixXd K_g = Phi.transpose() * fe::calc_structural_damping_times(model, g, Phi);
  return 0.5 * (K_g + K_g.transpose());
}

}  // namespace bough::stiffening
