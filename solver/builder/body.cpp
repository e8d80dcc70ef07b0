#include <algorithm>
#include <cmath>

#include "solver/builder/build.hpp"
#include "solver/builder/special_node.hpp"

namespace bough::solver {

namespace {

bool check_rigid(const records::BodyRecord& r, Diagnostics& diagnostics) {
  bool good = true;
  if (!std::isfinite(r.mass) || r.mass < 0) {
    diagnostics.error(
        "system.bad-mass", r.at,
        "body " + quote(r.name) + " has mass " + std::to_string(r.mass) + ", expected a number of at least zero");
    good = false;
  }
  const Matrix3d& J = r.inertia;
  const double scale = J.cwiseAbs().maxCoeff();
  if (!J.allFinite() || !r.cg.allFinite()) {
    diagnostics.error("system.bad-inertia", r.at,
                      "body " + quote(r.name) + " has a cg or inertia that is not a number");
    return false;
  }
  if ((J - J.transpose()).cwiseAbs().maxCoeff() > 1e-9 * scale) {
    diagnostics.error("system.bad-inertia", r.at, "the inertia of body " + quote(r.name) + " is not symmetric",
                      "give Ixy, Ixz, Iyz the same value on both sides of the diagonal");
    return false;
  }
  const Vector3d principal = Eigen::SelfAdjointEigenSolver<Matrix3d>(J, Eigen::EigenvaluesOnly).eigenvalues();
  if (principal[0] < -1e-9 * scale) {
    diagnostics.error(
        "system.bad-inertia", r.at,
        "the inertia of body " + quote(r.name) + " has a negative principal value " + std::to_string(principal[0]),
        "check the signs of the products of inertia and that it is about the centre of mass");
    good = false;
  } else if (principal[0] + principal[1] < principal[2] * (1 - 1e-6)) {
    diagnostics.warning("system.inertia-triangle", r.at,
                        "no mass distribution has the inertia of body " + quote(r.name) +
                            ": its largest principal value exceeds the sum of the other two",
                        "check that it is about the centre of mass");
  }
  return good;
}

bool check_flexible(const records::BodyRecord& r, const records::FlexBody& flex, Diagnostics& diagnostics) {
  const int errors = diagnostics.num_errors();
  const int n = r.num_modes < 0 ? flex.num_modes() : r.num_modes;
  if (n > flex.num_modes()) {
    diagnostics.error("system.too-many-modes", r.at,
                      "body " + quote(r.name) + " asks for " + std::to_string(n) + " modes, its file '" + r.file +
                          "' has " + std::to_string(flex.num_modes()));
    return false;
  }
  if (n < flex.num_modes() && r.stiffening && !flex.third_order.empty())
    diagnostics.error("system.third-order-modes", r.at,
                      "body " + quote(r.name) + " takes " + std::to_string(n) + " of the " +
                          std::to_string(flex.num_modes()) + " modes in '" + r.file +
                          "', whose third order is of all of them",
                      "take all modes, or reduce the body again with fewer");
  if (flex.integrals().empty() && flex.num_modes() > 0) {
    diagnostics.error(
        "system.missing-integrals", r.at,
        "the file '" + r.file + "' of body " + quote(r.name) + " has no '" + flex.integrals_method + "' mass integrals",
        "write it again with reduce");
  }
  auto check_count = [&](const std::vector<double>& values, const char* key, bool one_is_enough) {
    const int count = static_cast<int>(values.size());
    if (count == 0 || count == n || (one_is_enough && count == 1)) return;
    diagnostics.error("system.bad-count", r.at,
                      "body " + quote(r.name) + ": " + key + " has " + std::to_string(count) + " values, expected " +
                          std::to_string(n) + ", one per mode");
  };
  check_count(r.eta, "eta", false);
  check_count(r.eta_dot, "eta_dot", false);
  check_count(r.damping_ratios, "damping", true);
  if (!r.nodes.empty()) {
    diagnostics.error("system.nodes-of-flexible-body", r.at,
                      "body " + quote(r.name) + " is flexible and declares nodes of its own",
                      "name output nodes of its file instead");
  }
  if (r.stiffening && std::none_of(flex.kg_inertial_computed.begin(), flex.kg_inertial_computed.end(),
                                   [](bool computed) { return computed; })) {
    diagnostics.warning("system.no-stiffening", r.at,
                        "the file '" + r.file + "' of body " + quote(r.name) +
                            " holds no K_G1: inertial loads do not "
                            "stiffen it",
                        "write it again with reduce, or set stiffening = false");
  }
  return diagnostics.num_errors() == errors;
}

}  // namespace

std::optional<Body> build_body(const records::BodyRecord& r, const FlexMap& flex, Diagnostics& diagnostics,
                               bool is_lagged) {
  if (!r.file.empty()) {
    const auto found = flex.find(r.file);
    if (found == flex.end()) {
      if (r.is_unreadable) return std::nullopt;
      diagnostics.error("system.missing-body-file", r.at,
                        "body " + quote(r.name) + " needs the file '" + r.file + "', which was not read");
      return std::nullopt;
    }
    if (!check_flexible(r, found->second, diagnostics)) return std::nullopt;
    return Body::make_flexible(found->second, r.num_modes, r.stiffening && !is_lagged, r.damping_ratios);
  }
  if (!check_rigid(r, diagnostics)) return std::nullopt;
  if (!r.eta.empty() || !r.eta_dot.empty()) {
    diagnostics.error("system.bad-count", r.at, "body " + quote(r.name) + " is rigid and has eta or eta_dot");
    return std::nullopt;
  }
  Body body = Body::make_rigid(r.mass, r.cg, r.inertia);
  for (const auto& node : r.nodes) {
    if (body.find_node(node.id) >= 0) {
      diagnostics.error("system.duplicate-node", r.at,
                        "body " + quote(r.name) + " declares node " + std::to_string(node.id) +
                            (node.id == 0 ? ", which is its origin" : " twice"),
                        "give the node another id");
    } else {
      body.add_rigid_node(node.id, node.p);
    }
  }
  return body;
}

int find_loaded_node(const std::string& body_name, const Body& body, int id, NodeLoad load, const SourceLocation& where,
                     const std::string& user, Diagnostics& diagnostics) {
  const int index = body.find_node(id);
  if (index < 0) {
    std::string known;
    for (const Node& node : body.nodes()) {
      if (known.size() > 60) {
        known += " ...";
        break;
      }
      known += " " + std::to_string(node.id);
    }
    diagnostics.error(
        "system.unknown-node", where,
        user + " names node " + std::to_string(id) + " of body " + quote(body_name) + ", which has nodes" + known,
        "name one of them (0 is the body's origin), or add the node to the body");
    return -1;
  }
  const Node& node = body.nodes()[static_cast<size_t>(index)];
  const bool is_special = is_special_node(body, index);
  if ((load.force || load.moment) && !node.is_material && !is_special) {
    diagnostics.error("system.frame-node", where,
                      user + " acts at node 0 of body " + quote(body_name) +
                          ", the origin of a free frame, which is no point of the body",
                      "name one of its nodes, or reduce the body with a frame at a node");
    return -1;
  }
  if (is_special) return index;  // loads at it do not stiffen
  if (load.moment && node.has_no_rotation()) {
    diagnostics.error("system.node-without-rotation", where,
                      user + " needs the rotation of node " + std::to_string(id) + " of body " + quote(body_name) +
                          ", which has none: solid elements alone do not turn a grid",
                      "attach at a grid that an RBE2 or RBE3 ties to the solid's grids");
    return -1;
  }
  if (load.force && body.stiffened() && !node.has_locators && node.phi.size() > 0 &&
      node.phi.cwiseAbs().maxCoeff() > 0) {
    diagnostics.error("system.missing-locators", where,
                      user + " loads node " + std::to_string(id) + " of body " + quote(body_name) +
                          ", whose file lacks the geometric stiffness of forces at that node",
                      "add the node to 'interface' in the body file and reduce again, or set stiffening = false");
    return -1;
  }
  return index;
}

int reject_special_node(const std::string& body_name, const Body& body, int index, const SourceLocation& where,
                        const std::string& user, Diagnostics& diagnostics) {
  if (!is_special_node(body, index)) return index;
  diagnostics.error("system.special-node", where,
                    user + " attaches to node " + std::to_string(body.nodes()[static_cast<size_t>(index)].id) +
                        " of body " + quote(body_name) + ", a special node of its .FLX, which is no point of the body",
                    "name an output node; special nodes take forces, actuators and sensors");
  return -1;
}

}  // namespace bough::solver
