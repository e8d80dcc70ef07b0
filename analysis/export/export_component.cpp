#include "analysis/export/export_component.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "analysis/common/body_files.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/export/export_matrices.hpp"
#include "analysis/export/op4_matrices.hpp"
#include "analysis/listing/listing.hpp"
#include "analysis/listing/recovery_rows.hpp"
#include "analysis/reduce/point_files.hpp"
#include "fe/matrices/system.hpp"
#include "fe/model/sets.hpp"
#include "fe/statics/build_model.hpp"
#include "formats/nastran/superelement_writer.hpp"
#include "modal/bases/component.hpp"

namespace bough::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// A component on its way to the files.
struct WrittenComponent {
  nastran::ExternalComponent cards;
  MatrixXd K, M, B, K4;
};

// ---------------------------------------------------------------------------------------------- of a deck

SourceLocation locate_first(const records::Deck& deck, const std::vector<records::GridComponents>& set) {
  return deck.locate(set.empty() ? records::CardLocation{} : set.front().at);
}

/// Grids of BSET and ASET, with all six components; the points of the q-set are none of them.
std::vector<int> list_boundary(const records::Deck& deck, const std::set<int>& generalized) {
  constexpr unsigned kAllSix = 63;
  if (!deck.cset.empty())
    throw InputError("export.component-boundary", locate_first(deck, deck.cset),
                     "CSET frees boundary degrees of freedom for the component modes, which is not supported",
                     "name the boundary by BSET1");
  std::map<int, std::pair<unsigned, records::CardLocation>> components;
  for (const auto* set : {&deck.bset, &deck.aset})
    for (const auto& term : *set) {
      if (generalized.count(term.g) > 0) continue;
      auto& [mask, at] = components.try_emplace(term.g, 0u, term.at).first->second;
      mask |= term.c;
    }
  if (components.empty())
    throw InputError("export.component-boundary", deck.locate({}), "the deck names no boundary of the component",
                     "write BSET1,123456 and the grids that other components join");
  std::vector<int> grids;
  for (const auto& [id, part] : components) {
    if (part.first != kAllSix)
      throw InputError(
          "export.component-boundary", deck.locate(part.second),
          fmt::format("the boundary has {} of point {}", part.first == 0 ? "no component" : "some components", id),
          "a boundary point is a grid with its components 123456");
    grids.push_back(id);
  }
  return grids;
}

/// The q-set has no structure: its points leave the model, and MPC that name them.
void remove_generalized(records::Deck& deck, const std::set<int>& generalized, Diagnostics& diagnostics) {
  std::erase_if(deck.scalar_points, [&](int id) { return generalized.count(id) > 0; });
  std::erase_if(deck.mpc, [&](const records::Mpc& mpc) {
    const auto tied = std::find_if(mpc.terms.begin(), mpc.terms.end(),
                                   [&](const auto& term) { return generalized.count(term.g) > 0; });
    if (tied == mpc.terms.end()) return false;
    diagnostics.warning("export.component-tie", deck.locate(mpc.at),
                        fmt::format("MPC {} ties generalized coordinate {} and is left out", mpc.sid, tied->g),
                        "tie it in the assembly");
    return true;
  });
  deck.aset.clear();
  deck.omit.clear();
  deck.qset.clear();
  deck.bset.clear();
}

const records::EigenMethod* find_method(const records::Deck& deck, int set) {
  const auto at = std::find_if(deck.eigen_methods.begin(), deck.eigen_methods.end(),
                               [set](const auto& method) { return method.sid == set; });
  return set == 0 || at == deck.eigen_methods.end() ? nullptr : &*at;
}

/// Returns true if a command requests results of an id.
class Request {
 public:
  Request(const records::DynamicSelection& selection, const std::string& command) : selection_(selection) {
    const auto found = selection.outputs.find(command);
    if (found != selection.outputs.end() && !found->second.is_none) request_ = &found->second;
  }
  bool any() const { return request_ != nullptr; }
  bool operator()(int id) const {
    if (!request_) return false;
    if (request_->is_all) return true;
    const auto set = selection_.sets.find(request_->set);
    return set != selection_.sets.end() && set->second.contains(id);
  }

 private:
  const records::DynamicSelection& selection_;
  const records::OutputRequest* request_ = nullptr;
};

/// Displacements of the boundary and of DISPLACEMENT, in the displacement axes of each grid.
records::RecoveryTable make_displacement_rows(const fe::Model& model, const modal::bases::Component& component,
                                              const Request& requested, const std::vector<int>& points) {
  records::RecoveryTable table{"MUG1", {}, {}};
  std::vector<MatrixXd> blocks;
  Index rows = 0;
  const auto add = [&](int type, int id, MatrixXd block) {
    table.items.push_back({type, id, static_cast<int>(block.rows()), static_cast<int>(rows)});
    rows += block.rows();
    blocks.push_back(std::move(block));
  };
  const std::set<int> boundary(component.boundary.begin(), component.boundary.end());
  for (const auto& node : model.nodes()) {
    if (node.num_dofs != 6 || (boundary.count(node.id) == 0 && !requested(node.id))) continue;
    MatrixXd block = component.shapes.middleRows(node.first_gdof, 6);
    block.topRows<3>() = (node.R_basic_cd.transpose() * block.topRows<3>()).eval();
    block.bottomRows<3>() = (node.R_basic_cd.transpose() * block.bottomRows<3>()).eval();
    add(1, node.id, std::move(block));
  }
  const auto nb = static_cast<Index>(6 * component.boundary.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    if (requested(points[k]))
      add(2, points[k], MatrixXd::Identity(component.K.rows(), component.K.rows()).row(nb + static_cast<Index>(k)));
  table.rows.resize(rows, component.shapes.cols());
  for (Index first = 0; const auto& block : blocks) {
    table.rows.middleRows(first, block.rows()) = block;
    first += block.rows();
  }
  return table;
}

void add_element_rows(const fe::Model& model, const records::Deck& deck, const records::DynamicSelection& selection,
                      const modal::bases::Component& component, std::vector<records::RecoveryTable>& tables) {
  const Request forces(selection, "FORCE"), stresses(selection, "STRESS");
  if (!forces.any() && !stresses.any()) return;
  for (auto& table : make_recovery_rows(model, deck, component.shapes, {}, forces, stresses))
    tables.push_back(std::move(table));
}

/// Messages of reading without those on BSET, CSET, QSET and EXTSEOUT, which a component uses.
void copy_but_used(const Diagnostics& from, Diagnostics& to) {
  for (const auto& item : from.items()) {
    const bool is_set = item.id == "deck.unused-card" && item.what.find("SET") == 1,
               is_command =
                   item.id == "deck.case-control-ignored" && item.what.find(": EXTSEOUT (") != std::string::npos;
    if (!is_set && !is_command) to.add(item);
  }
}

WrittenComponent make_component(const std::string& file, const ComponentExportOptions& options,
                                const std::vector<std::string>& ignore_cards, Diagnostics& diagnostics) {
  fe::ModelOptions model_options;
  model_options.ignore_cards = ignore_cards;
  Diagnostics reading;
  auto deck = read_deck_or_throw(file, model_options, reading);
  copy_but_used(reading, diagnostics);
  const auto requests = read_requests_once(file, diagnostics);
  const auto* selection = find_selection(requests, deck.subcases.front().id);

  std::set<int> generalized;
  for (const auto& term : deck.qset) generalized.insert(term.g);
  const auto boundary = list_boundary(deck, generalized);
  remove_generalized(deck, generalized, diagnostics);
  const auto model = fe::build_model(deck, model_options, diagnostics);
  const fe::System system(model);

  modal::bases::ComponentOptions component_options;
  component_options.boundary = boundary;
  const auto* method = find_method(deck, deck.subcases.front().method);
  if (method) {
    component_options.num_modes = method->num_modes;
    component_options.max_hz = method->f2;
  }
  if (!method || generalized.empty()) component_options.max_hz = 0;
  component_options.has_inertial_residuals =
      method && !generalized.empty() && (!selection || selection->resvec.value_or(true));
  const auto component = modal::bases::calc_component(system, component_options, diagnostics);
  if (fe::get_real_param(deck, "G", 0, diagnostics) != 0)
    diagnostics.note("export.component-damping", deck.locate(deck.find_param("G")->at),
                     "PARAM,G is not in the component, whose K4 is of GE",
                     "give PARAM,G in the deck that assembles: it acts on the stiffness of its components too");

  WrittenComponent written;
  auto& cards = written.cards;
  const auto output = deck.super.output.value_or(records::ExternalOutput{});
  cards.id = options.id > 0 ? options.id : output.id > 0 ? output.id : 1;
  cards.unit = options.unit > 0 ? options.unit : output.unit > 0 ? output.unit : cards.id;
  for (const int id : component.boundary) cards.grids.emplace_back(id, model.node(model.find_node(id)).x);
  const auto nb = static_cast<Index>(6 * boundary.size());
  auto nq = component.lambda.size();
  if (static_cast<std::size_t>(nq) > generalized.size()) {
    diagnostics.warning(
        "export.component-points", deck.locate(output.at),
        fmt::format("the component has {} modes and {} residual vectors, the q-set {} points: the last {} "
                    "are left out",
                    component.num_modes, nq - component.num_modes, generalized.size(),
                    static_cast<std::size_t>(nq) - generalized.size()),
        "name more SPOINTs in QSET1");
    nq = static_cast<Index>(generalized.size());
  } else if (static_cast<std::size_t>(nq) < generalized.size()) {
    diagnostics.note("export.component-points", deck.locate(output.at),
                     fmt::format("{} of the {} points of the q-set are used", nq, generalized.size()),
                     "a higher limit of METHOD gives more modes");
  }
  for (const int id : generalized)
    if (static_cast<Index>(cards.scalar_points.size()) < nq) cards.scalar_points.push_back(id);
  const auto take = [&](const MatrixXd& A) { return A.size() == 0 ? A : MatrixXd(A.topLeftCorner(nb + nq, nb + nq)); };
  written.K = take(component.K);
  written.M = take(component.M);
  written.B = take(component.B);
  written.K4 = take(component.K4);
  const records::DynamicSelection none;
  const auto& outputs = selection ? *selection : none;
  cards.recovery.push_back(
      make_displacement_rows(model, component, Request(outputs, "DISPLACEMENT"), cards.scalar_points));
  add_element_rows(model, deck, outputs, component, cards.recovery);
  for (auto& table : cards.recovery) table.rows.conservativeResize(Eigen::NoChange, nb + nq);
  return written;
}

// ---------------------------------------------------------------------------------------------- of a body

/// Coordinates [b; q] of the body become [b; q - K_qq^-1 K_qb b] in the modes of K_qq: no stiffness couples them.
void uncouple(Index nb, MatrixXd& K, MatrixXd& M, MatrixXd& C) {
  const auto nq = K.rows() - nb;
  if (nq == 0) return;
  MatrixXd T = MatrixXd::Identity(K.rows(), K.rows());
  const MatrixXd K_qq = K.bottomRightCorner(nq, nq), M_qq = M.bottomRightCorner(nq, nq);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes(K_qq, M_qq);
  T.bottomRightCorner(nq, nq) = modes.eigenvectors();
  T.bottomLeftCorner(nq, nb) = -K_qq.ldlt().solve(K.bottomLeftCorner(nq, nb));
  for (auto* A : {&K, &M, &C}) {
    const MatrixXd turned = T.transpose() * *A * T;
    *A = 0.5 * (turned + turned.transpose());
  }
  K.topRightCorner(nb, nq).setZero();
  K.bottomLeftCorner(nq, nb).setZero();
  K.bottomRightCorner(nq, nq) = modes.eigenvalues().asDiagonal();
}

WrittenComponent make_component_of_body(const std::string& file, const ComponentExportOptions& options,
                                        Diagnostics& diagnostics) {
  const auto body = read_body(file, diagnostics);
  const auto solid = find_solid(body, file, diagnostics);
  if (!solid)
    throw InputError(
        "export.component-boundary", {file},
        "the body has no constraint modes that move its interface nodes one to one",
        "reduce it with basis = \"craig-bampton\", orthogonalize = false, frame = \"node\", interface = [...]");
  WrittenComponent written;
  auto& cards = written.cards;
  cards.id = options.id > 0 ? options.id : 1;
  cards.unit = options.unit > 0 ? options.unit : cards.id;
  const int highest = body.node_id.empty() ? 0 : *std::max_element(body.node_id.begin(), body.node_id.end());
  // The frame that no node carries gets a new id.
  std::vector<std::pair<int, Index>> order;
  for (std::size_t k = 0; k < solid->node.size(); ++k)
    order.emplace_back(solid->node[k] > 0 ? solid->node[k] : highest + 1, static_cast<Index>(k));
  std::sort(order.begin(), order.end());
  const auto n = solid->K.rows(), nb = static_cast<Index>(6 * order.size());
  std::vector<Index> rows;
  for (const auto& [id, k] : order) {
    cards.grids.emplace_back(id, solid->P.row(k).transpose());
    for (Index i = 0; i < 6; ++i) rows.push_back(6 * k + i);
  }
  for (Index i = nb; i < n; ++i) rows.push_back(i);
  written.K = solid->K(rows, rows);
  written.M = solid->M(rows, rows);
  written.B = solid->C(rows, rows);
  uncouple(nb, written.K, written.M, written.B);
  if (written.B.isZero(0)) written.B.resize(0, 0);
  const int first = options.first_point > 0 ? options.first_point : highest + 1001;
  for (Index i = nb; i < n; ++i) cards.scalar_points.push_back(first + static_cast<int>(i - nb));
  return written;
}

// ---------------------------------------------------------------------------------------------- files

/// Matrices in the vendor's names and order; 1 x 1 zero if there is none.
std::string make_matrices(const WrittenComponent& c, const std::string& vendor) {
  matrices::Op4Options options;
  options.is_text = false;
  Op4Matrices out(options);
  const MatrixXd none = MatrixXd::Zero(1, 1);
  const auto put = [&](const std::string& name, const MatrixXd& A) { out.put(name, A.size() > 0 ? A : none); };
  const auto find = [&](const std::string& name) -> MatrixXd {
    for (const auto& table : c.cards.recovery)
      if (table.name == name) return table.rows;
    return {};
  };
  const MatrixXd ones = MatrixXd::Ones(c.K.rows(), 1);
  if (vendor == "msc") {
    put("KAA", c.K);
    put("MAA", c.M);
    put("BXX", c.B);
    put("K4XX", c.K4);
    put("PA", MatrixXd::Zero(c.K.rows(), 1));
    for (const char* name : {"GPXX", "GDXX", "VAFX", "AX", "RVAX", "KASMX", "MASMX"}) put(name, {});
    put("VA", ones);
    for (const char* name : {"MUG1", "MUG1O", "MES1", "MES1O", "MEF1", "MEF1O", "MQG1", "MQG1O"}) put(name, find(name));
    put("MUG1B", find("MUG1"));
    put("MUG1OB", {});
    return out.take();
  }
  put("KXX", c.K);
  put("MXX", c.M);
  put("BXX1", c.B);
  put("K4XX1", c.K4);
  for (const char* name : {"PX1", "GPXX", "GDXX", "RVAX"}) put(name, {});
  put("VA", ones);
  for (const char* name : {"MUG1", "MUG1O", "MES1", "MES1O", "MEE1", "MEE1O", "MGPFM", "MGPFB", "MGPFK", "MGPFO",
                           "MEF1", "MEF1O", "MQGM", "MQGB",  "MQGK", "MQG1O", "MQMGM", "MQMGB", "MQMGK", "MQMG1O"})
    put(name, find(name));
  return out.take();
}

}  // namespace

ComponentSummary export_component(const std::string& file, const std::string& output,
                                  const ComponentExportOptions& options, const std::vector<std::string>& ignore_cards,
                                  Diagnostics& diagnostics) {
  const auto component = is_hdf5(file) ? make_component_of_body(file, options, diagnostics)
                                       : make_component(file, options, ignore_cards, diagnostics);
  auto stem = std::filesystem::path(output);
  if (has_suffix(output, ".op4") || has_suffix(output, ".asm") || has_suffix(output, ".pch")) stem.replace_extension();
  const auto texts = nastran::write_external_component(component.cards);
  const auto assign =
      fmt::format("$ ASSIGN INPUTT4='{}.op4',UNIT={}\n", stem.filename().string(), component.cards.unit);
  write_text_file(stem.string() + ".op4", make_matrices(component, options.vendor));
  write_text_file(stem.string() + ".asm", assign + texts.assembly);
  write_text_file(stem.string() + ".pch", texts.section);
  return {component.cards.id, component.cards.grids.size(), component.cards.scalar_points.size(), stem.string()};
}

}  // namespace bough::analysis
