// The external loads of a body, and the columns for its residual vectors.
#include <algorithm>

#include "fe/loads/dead_loads.hpp"
#include "fe/statics/static_case.hpp"
#include "stiffening/given_model.hpp"
#include "stiffening/stages.hpp"

namespace bough::stiffening {

namespace {

constexpr const char* kDirections[] = {"x", "y", "z", "rx", "ry", "rz"};

/// Reports reduce.load-on-nothing for a load on dofs without stiffness.
void check_effect(const BodyRequest& request, const fe::Model& model, const std::string& name, const VectorXd& F) {
  const auto lost = fe::list_lost_loads(model, F);
  if (!lost.empty())
    request.error("reduce.load-on-nothing", "load '" + name + "' acts on what has no stiffness: " + lost.front(),
                  "tie the grid by an RBE2 or RBE3 to grids that carry the load");
}

/// Reports reduce.partial-rotation for interface grids that rotate about some axes only (membranes, bars without one of
/// their stiffnesses): a body attached there is not supported about the others.
void report_partial_rotation(const BodyRequest& request, const fe::Model& model, int id) {
  std::string axes;
  for (const auto& entry : model.autospc())
    if (entry.node == id && entry.component > 3) axes += std::to_string(entry.component);
  if (!axes.empty())
    request.warning("reduce.partial-rotation",
                    "interface grid " + std::to_string(id) + " has no stiffness in component(s) " + axes +
                        ": a hinge or moment there finds none either",
                    "tie it by an RBE2 or RBE3 to other grids, or see that nothing turns it so");
}

LoadPattern make_unit(const fe::Model& model, const std::string& group, const std::string& name, int id,
                      int direction) {
  LoadPattern pattern;
  pattern.group = group;
  pattern.locator = {name, id, direction};
  pattern.load.F = VectorXd::Unit(model.num_gdofs(), model.node(model.find_node(id)).first_gdof + direction - 1);
  return pattern;
}

LoadPattern make_set(const BodyRequest& request, const fe::Model& model, const records::ExternalLoadSpec& load,
                     const std::string& name) {
  records::Subcase sets;
  sets.load = load.load_set;
  sets.temperature = load.temperature_set;
  auto both = fe::calc_static_load(model, request.deck, sets, request.diagnostics);
  fe::report_dead_loads(request.deck, load.load_set, request.diagnostics);
  LoadPattern pattern;
  pattern.group = pattern.locator.name = name;
  pattern.load_set = load.load_set;
  pattern.initial = std::move(both.initial);
  pattern.load = std::move(both);
  return pattern;
}

}  // namespace

bool lacks_rotation(const fe::Model& model, const fe::Node& node) {
  const auto moves = [&](int c) { return model.T().row(node.first_gdof + c).norm() > 0; };
  return (moves(0) || moves(1) || moves(2)) && !moves(3) && !moves(4) && !moves(5);
}

std::vector<int> list_interface_nodes(const records::BodySpec& spec) {
  std::vector<int> ids;
  for (const int id : spec.interface_nodes)
    if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
  return ids;
}

std::vector<LoadPattern> make_load_patterns(const BodyRequest& request, const fe::Model& model) {
  const auto& spec = request.spec;
  const bool has_moments = spec.interface_moments && !request.given;  // the given ones come as loads
  std::vector<LoadPattern> patterns;
  for (const int id : list_interface_nodes(spec)) {
    // A moment on a grid of solids alone acts on nothing.
    const bool lacks = lacks_rotation(model, model.node(model.find_node(id)));
    for (int d = 1; d <= (has_moments && !lacks ? 6 : 3); ++d)
      patterns.push_back(make_unit(model, "", "node" + std::to_string(id) + "_" + kDirections[d - 1], id, d));
    if (has_moments && !lacks) report_partial_rotation(request, model, id);
  }
  for (std::size_t i = 0; i < spec.loads.size(); ++i) {
    const auto& load = spec.loads[i];
    const std::string name = load.name.empty() ? "load" + std::to_string(i + 1) : load.name;
    const auto add = [&](LoadPattern pattern) {
      check_effect(request, model, name, pattern.load.F);
      patterns.push_back(std::move(pattern));
    };
    if (load.load_set > 0 || load.temperature_set > 0) {
      add(make_set(request, model, load, name));
      continue;
    }
    for (const int d : load.directions)
      add(make_unit(model, name, load.directions.size() == 1 ? name : name + "_" + kDirections[d - 1], load.node, d));
  }
  if (request.given) add_given_patterns(*request.given, patterns);
  request.diagnostics.throw_if_errors();
  return patterns;
}

std::string get_unit_name(int node, int direction) {
  return "node" + std::to_string(node) + " " + std::to_string(direction);
}

bool needs_inertial_residuals(const records::BodySpec& spec) {
  return std::find(spec.residual.begin(), spec.residual.end(), "inertial") != spec.residual.end();
}

modal::response::ResidualLoads make_residual_loads(const BodyRequest& request, const fe::Model& model,
                                                   const std::vector<LoadPattern>& patterns, const MatrixXd& F_I) {
  static constexpr const char* kNames[records::kNumInertialLoads] = {"ax",  "ay",  "az",  "alx",  "aly",  "alz",
                                                                     "wx2", "wy2", "wz2", "wxwy", "wxwz", "wywz"};
  modal::response::ResidualLoads result{MatrixXd(model.num_gdofs(), 0), {}};
  const auto add = [&](const MatrixXd& columns) {
    result.F.conservativeResize(Eigen::NoChange, result.F.cols() + columns.cols());
    result.F.rightCols(columns.cols()) = columns;
  };
  for (const auto& word : request.spec.residual) {
    if (word == "inertial") {
      add(F_I);
      result.name.insert(result.name.end(), std::begin(kNames), std::end(kNames));
    } else if (word == "interface") {
      for (const int id : request.spec.interface_nodes) {
        MatrixXd units = MatrixXd::Zero(model.num_gdofs(), 6);
        units.middleRows(model.node(model.find_node(id)).first_gdof, 6).setIdentity();
        add(units);
        for (int c = 1; c <= 6; ++c) result.name.push_back(get_unit_name(id, c));
      }
    } else {
      for (const auto& pattern : patterns)
        if (pattern.group == word) {
          add(pattern.load.F);
          result.name.push_back(pattern.locator.name);
        }
    }
  }
  if (request.options.residual_loads) {
    const auto more = request.options.residual_loads(model);
    add(more.F);
    result.name.insert(result.name.end(), more.name.begin(), more.name.end());
  }
  return result;
}

}  // namespace bough::stiffening
