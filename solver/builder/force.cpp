#include "solver/bodies/third_order.hpp"
#include "solver/builder/build.hpp"
#include "solver/text/names.hpp"

namespace bough::solver {

namespace {
// Turns a named locator into a node force or a pattern.
bool set_locator(const records::ForceRecord& r, const Body& body, const records::FlexBody* flex, AppliedForce& force,
                 Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (size_t e = 0; flex != nullptr && e < flex->locators.size(); ++e) {
    const auto& locator = flex->locators[e];
    names.push_back(locator.name);
    if (locator.name != r.locator) continue;
    if (locator.node != 0) {  // a unit load: the same as a force at the node
      const bool is_force = locator.direction <= 3;
      force.kind = is_force ? records::ForceKind::Force : records::ForceKind::Moment;
      force.frame = records::VectorFrame::Body;
      force.direction = Vector3d::Unit((locator.direction - 1) % 3);
      force.node = find_loaded_node(r.body, body, locator.node, {is_force, !is_force}, r.at, "force " + quote(r.name),
                                    diagnostics);
      return force.node >= 0;
    }
    const int n = body.num_modes();
    if (body.third_order() != nullptr) {
      force.pattern_higher = body.third_order()->make_load(*flex, static_cast<int>(e));
    }
    force.pattern = flex->external_load.col(static_cast<Eigen::Index>(e)).head(n);
    force.pattern_K2 = MatrixXd::Zero(n, n);
    if (body.stiffened() && body.third_order() == nullptr) force.pattern_K2 = flex->kg_external[e].topLeftCorner(n, n);
    force.pattern_moment = MatrixXd::Zero(3, n);
    if (flex->load_resultant.size() > 0) {
      force.pattern_resultant = flex->load_resultant.col(static_cast<Eigen::Index>(e));
      force.pattern_moment = flex->load_moment[e].leftCols(n);
    } else {
      diagnostics.warning("system.no-resultant", r.at,
                          "the file of body " + quote(r.body) + " does not hold the resultant of load pattern " +
                              quote(r.locator) + ": it loads the modes only",
                          "reduce the body again, unless the pattern is in equilibrium by itself");
    }
    return true;
  }
  diagnostics.error("system.unknown-locator", r.at,
                    "force " + quote(r.name) + " names load pattern " + quote(r.locator) + ", which body " +
                        quote(r.body) + " does not have",
                    suggest_name(r.locator, names, "add a [[body.load]] to the body file and reduce again"));
  return false;
}
}  // namespace

std::optional<AppliedForce> build_force(const records::ForceRecord& r, const Tree& tree, int body_index,
                                        const records::FlexBody* flex, const FunctionMap& functions,
                                        Diagnostics& diagnostics) {
  const Body& body = tree.bodies[static_cast<size_t>(body_index)].body;
  const int errors = diagnostics.num_errors();
  AppliedForce force;
  force.name = r.name;
  force.kind = r.kind;
  force.frame = r.frame;
  force.body = body_index;
  force.direction = r.direction;
  if (!r.function.empty()) {
    force.function = find_function(functions, r.function, r.at, "force " + quote(r.name), diagnostics);
  }
  if (!r.locator.empty()) {
    set_locator(r, body, flex, force, diagnostics);
  } else {
    const bool is_force = r.kind == records::ForceKind::Force;
    force.node =
        find_loaded_node(r.body, body, r.node, {is_force, !is_force}, r.at, "force " + quote(r.name), diagnostics);
    if (!r.direction.allFinite() || r.direction.isZero(0)) {
      diagnostics.error("system.zero-direction", r.at, "force " + quote(r.name) + " has no direction",
                        r.kind == records::ForceKind::Force ? "give 'force' three numbers, not all zero"
                                                            : "give 'moment' three numbers, not all zero");
    }
  }
  if (diagnostics.num_errors() != errors) return std::nullopt;
  return force;
}

}  // namespace bough::solver
