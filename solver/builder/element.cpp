// [[force]] with a type: names to markers and bodies.
#include <algorithm>
#include <cmath>

#include "solver/builder/build.hpp"
#include "solver/forces/bushing.hpp"
#include "solver/forces/central_gravity.hpp"
#include "solver/forces/contact.hpp"
#include "solver/forces/drag.hpp"
#include "solver/forces/spring.hpp"
#include "solver/forces/sunlight.hpp"
#include "solver/text/names.hpp"

namespace bough::solver {

namespace {

using records::ElementType;
using records::ForceElementRecord;
class ElementBuilder {
 public:
  ElementBuilder(const ForceElementRecord& record, const ElementContext& context, Tree& tree, Diagnostics& diagnostics)
      : r_(record), context_(context), tree_(tree), diagnostics_(diagnostics), user_("force " + quote(record.name)) {}

  std::unique_ptr<const ForceElement> build() {
    const int errors = diagnostics_.num_errors();
    std::unique_ptr<const ForceElement> element;
    switch (r_.type) {
      case ElementType::Spring:
        element = build_spring();
        break;
      case ElementType::Bushing:
        element = build_bushing();
        break;
      case ElementType::Contact:
        element = build_contact();
        break;
      case ElementType::CentralGravity:
        element = build_gravity();
        break;
      case ElementType::Drag:
        element = build_drag();
        break;
      case ElementType::SolarPressure:
        element = build_solar_pressure();
        break;
    }
    if (diagnostics_.num_errors() != errors) return nullptr;
    return element;
  }

 private:
  static constexpr int kAbsent = -2;
  /// Tree index, -1: ground, kAbsent: absent (reported) or with errors.
  int find_body(const std::string& name) {
    if (name == "ground") return -1;
    const auto found = context_.order.tree_index.find(name);
    if (found != context_.order.tree_index.end()) return context_.is_valid(found->second) ? found->second : kAbsent;
    std::vector<std::string> names = {"ground"};
    for (const auto& body : context_.spec.bodies) names.push_back(body.name);
    if (std::find(names.begin(), names.end(), name) != names.end()) return kAbsent;  // in a loop
    diagnostics_.error("system.unknown-body", r_.at, user_ + " names body " + quote(name) + ", which does not exist",
                       suggest_name(name, names, "declare it"));
    return kAbsent;
  }

  int add_marker(const records::EndRecord& end, NodeLoad load) {
    Marker marker;
    marker.p_KM = end.position;
    marker.R_KM = end.rotation;
    marker.body = find_body(end.body);
    if (marker.body == kAbsent) return 0;
    if (marker.body < 0) {
      if (end.node != 0) {
        diagnostics_.error("system.unknown-node", r_.at,
                           user_ + " names node " + std::to_string(end.node) + " of ground, which has only node 0",
                           "give its position instead");
      }
      return tree_.add_marker(marker);
    }
    const Body& body = tree_[marker.body].body;
    load.moment = load.moment || !end.position.isZero(0);
    marker.node = std::max(0, find_loaded_node(end.body, body, end.node, load, r_.at, user_, diagnostics_));
    marker.moves = body.nodes()[static_cast<size_t>(marker.node)].moves;
    return tree_.add_marker(marker);
  }

  bool check_two_ends() {
    const records::EndRecord &a = r_.from, &b = r_.to;
    const bool is_one_body = a.body == b.body;
    const bool is_one_point = is_one_body && a.node == b.node && a.position == b.position;
    if (!is_one_point && !(is_one_body && a.body == "ground")) return true;
    diagnostics_.error("system.one-end", r_.at,
                       user_ + (is_one_point ? " has both ends at one point" : " has both ends on ground"),
                       "name what it joins by body, node and to_body, to_node");
    return false;
  }

  void refuse(const std::string& what, const std::string& advice) {
    diagnostics_.error("system.bad-force", r_.at, user_ + " " + what, advice);
  }
  bool demand_finite(std::initializer_list<double> values) {
    if (std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); })) return true;
    refuse("has a parameter that is not a finite number", "give a number");
    return false;
  }

  std::unique_ptr<const Curve> find_table(const std::string& name) {
    return find_curve(context_, name, r_.at, user_, diagnostics_);
  }

  std::unique_ptr<const ForceElement> build_spring() {
    demand_finite({r_.stiffness, r_.damping, r_.free_length, r_.preload});
    if (r_.stiffness < 0 || r_.damping < 0 || r_.free_length < 0)
      refuse("has a negative stiffness, damping or free_length", "give values of at least zero");
    if (r_.sense != records::SpringSense::Both && !r_.spring_table.empty())
      refuse("acts one way only and has a spring_table", "let the table be zero where it is slack instead");
    check_two_ends();
    SpringElement::Law law;
    law.stiffness = r_.stiffness;
    law.damping = r_.damping;
    law.free_length = r_.free_length;
    law.preload = r_.preload;
    law.sense = r_.sense;
    law.spring = find_table(r_.spring_table);
    law.damper = find_table(r_.damper_table);
    if (!r_.function.empty()) law.function = find_function(context_.functions, r_.function, r_.at, user_, diagnostics_);
    const int from = add_marker(r_.from, {true, false}), to = add_marker(r_.to, {true, false});
    return std::make_unique<SpringElement>(r_.name, from, to, std::move(law));
  }

  /// Symmetric without negative eigenvalues.
  void check_matrix(const Matrix6d& A, const char* key) {
    const std::string name = key;
    const double scale = A.cwiseAbs().maxCoeff();
    if (!A.allFinite()) {
      refuse("has a " + name + " that is not finite", "give numbers");
    } else if ((A - A.transpose()).cwiseAbs().maxCoeff() > 1e-9 * scale) {
      refuse("has a " + name + " that is not symmetric", "give a symmetric 6 x 6 matrix, or six numbers");
    } else if (Eigen::SelfAdjointEigenSolver<Matrix6d>(A, Eigen::EigenvaluesOnly).eigenvalues()[0] < -1e-9 * scale) {
      refuse("has a " + name + " with a negative eigenvalue", "it would feed energy in: correct the matrix");
    }
  }

  std::unique_ptr<const ForceElement> build_bushing() {
    check_matrix(r_.stiffness6, "stiffness");
    check_matrix(r_.damping6, "damping");
    if (r_.from.body == r_.to.body)
      refuse("has both ends on " + (r_.from.body == "ground" ? "ground" : "body " + quote(r_.from.body)),
             "name another to_body");
    const int from = add_marker(r_.from, {true, true}), to = add_marker(r_.to, {true, true});
    return std::make_unique<BushingElement>(r_.name, r_.at, from, to, r_.stiffness6, r_.damping6);
  }

  std::unique_ptr<const ForceElement> build_contact() {
    demand_finite({r_.stiffness, r_.damping, r_.exponent, r_.friction, r_.slip_velocity, r_.radius, r_.to_radius});
    if (!(r_.stiffness > 0) || !(r_.exponent >= 1))
      refuse("has no stiffness or an exponent below 1", "give stiffness > 0 and exponent 1.5 (Hertz) or 1 (linear)");
    if (r_.damping < 0 || r_.friction < 0 || r_.radius < 0 || r_.to_radius < 0)
      refuse("has a negative damping, friction or radius", "give values of at least zero");
    if (r_.friction > 0 && !(r_.slip_velocity > 0))
      refuse("has friction without slip_velocity", "give the speed over which friction turns round, as 1e-3");
    ContactElement::Law law;
    law.is_plane = r_.shape == records::ContactShape::Plane;
    if (law.is_plane && !(r_.normal.norm() > 0)) {
      refuse("touches a plane without a normal", "give normal, which points from the plane to the body");
    } else if (law.is_plane) {
      law.normal = r_.normal.normalized();
    } else if (!(r_.radius + r_.to_radius > 0)) {
      refuse("is of two spheres without a radius", "give radius and to_radius");
    }
    if (r_.from.body == r_.to.body)
      refuse("is of body " + quote(r_.from.body) + " with itself", "name another to_body");
    law.stiffness = r_.stiffness;
    law.exponent = r_.exponent;
    law.damping = r_.damping;
    law.friction = r_.friction;
    law.slip_velocity = r_.slip_velocity;
    law.radius = r_.radius;
    law.to_radius = r_.to_radius;
    const bool turns = r_.friction > 0 && r_.radius > 0;
    const int from = add_marker(r_.from, {true, turns});
    const int to = add_marker(r_.to, {true, law.is_plane || r_.friction > 0});
    return std::make_unique<ContactElement>(r_.name, from, to, law);
  }

  std::unique_ptr<const ForceElement> build_gravity() {
    demand_finite({r_.mu, r_.j2, r_.equator, r_.centre.sum(), r_.axis.sum(), r_.dipole.sum()});
    if (!(r_.mu > 0)) refuse("has no mu", "give the gravitational parameter of the centre, > 0");
    if (r_.j2 != 0 && !(r_.equator > 0))
      refuse("has j2 without radius", "give the equatorial radius that goes with it");
    CentralGravity::Field field{r_.mu, r_.j2, r_.equator, r_.centre, r_.axis, r_.dipole};
    if (r_.axis.norm() > 0)
      field.axis.normalize();
    else
      refuse("has an axis without direction", "give the axis of the poles");
    std::vector<std::string> names = r_.bodies;
    if (names.empty())
      for (const TreeBody& tb : tree_.bodies) names.push_back(tb.name);
    std::vector<int> bodies;
    for (const auto& name : names) {
      const int b = find_body(name);
      if (b == -1) refuse("acts on ground", "name bodies");
      if (b >= 0) bodies.push_back(b);
    }
    return std::make_unique<CentralGravity>(r_.name, field, std::move(bodies));
  }

  std::unique_ptr<const ForceElement> build_drag() {
    demand_finite({r_.area, r_.coefficient, r_.density, r_.wind.sum(), r_.normal.sum()});
    if (!(r_.area >= 0) || !(r_.coefficient >= 0) || !(r_.density >= 0))
      refuse("has a negative area, coefficient or density", "give values of at least zero");
    DragElement::Law law;
    law.half_density_area = 0.5 * r_.density * r_.coefficient * r_.area;
    if (r_.normal.norm() > 0) law.normal = r_.normal.normalized();
    law.wind_W = r_.wind;
    if ((r_.scale_height != 0 || r_.altitude != 0 || !r_.spin.isZero(0)) && r_.planet.empty())
      refuse("has scale_height, altitude or spin and no planet", "name a gravity_central with a radius");
    if (const ForceElementRecord* planet = find_planet()) {
      if (!(r_.scale_height > 0)) refuse("has a planet without scale_height", "give the scale height of the density");
      law.scale_height = r_.scale_height;
      law.altitude = r_.altitude;
      law.radius = planet->equator;
      law.centre_W = planet->centre;
      law.spin_W = r_.spin;
    }
    if (r_.from.body == "ground") refuse("acts on ground", "name a body");
    return std::make_unique<DragElement>(r_.name, add_marker(r_.from, {true, false}), law);
  }

  /// The gravity_central of the key planet; nullptr: none is named, or reported.
  const ForceElementRecord* find_planet() {
    if (r_.planet.empty()) return nullptr;
    std::vector<std::string> names;
    for (const auto& other : context_.spec.force_elements) {
      if (other.type != ElementType::CentralGravity) continue;
      names.push_back(other.name);
      if (other.name != r_.planet) continue;
      if (other.equator > 0) return &other;
      refuse("has the planet " + quote(r_.planet) + ", which has no radius", "give its radius");
      return nullptr;
    }
    refuse("has the planet " + quote(r_.planet) + ", which is no gravity_central",
           suggest_name(r_.planet, names, "declare it"));
    return nullptr;
  }

  std::unique_ptr<const ForceElement> build_solar_pressure() {
    demand_finite({r_.pressure, r_.area, r_.specular, r_.diffuse, r_.sun_size, r_.sun.sum(), r_.normal.sum()});
    if (!(r_.area >= 0) || !(r_.pressure >= 0))
      refuse("has a negative area or pressure", "give values of at least zero");
    if (!(r_.specular >= 0) || !(r_.diffuse >= 0) || !(r_.specular + r_.diffuse <= 1))
      refuse("has reflectivities below zero or of a sum above one", "give shares of the light");
    if (!(r_.normal.norm() > 0) || !(r_.sun.norm() > 0))
      refuse("has a normal or a sun without direction", "give three numbers, not all zero");
    if (!(r_.sun_size > 0) || r_.sun_size > 1)
      refuse("has a sun_size that is no angular radius", "give radians, as 0.00465");
    if (r_.from.body == "ground") refuse("acts on ground", "name a body");
    SolarPressure::Panel panel;
    panel.pressure = r_.pressure;
    panel.area = r_.area;
    panel.specular = r_.specular;
    panel.diffuse = r_.diffuse;
    panel.normal = r_.normal.normalized();
    panel.sun_W = r_.sun.normalized();
    panel.is_one_sided = r_.is_one_sided;
    if (const ForceElementRecord* planet = find_planet()) panel.shadow = {planet->centre, planet->equator, r_.sun_size};
    return std::make_unique<SolarPressure>(r_.name, add_marker(r_.from, {true, false}), panel);
  }

  const ForceElementRecord& r_;
  const ElementContext& context_;
  Tree& tree_;
  Diagnostics& diagnostics_;
  std::string user_;
};

}  // namespace

std::unique_ptr<const Curve> find_curve(const ElementContext& context, const std::string& name,
                                        const SourceLocation& where, const std::string& user,
                                        Diagnostics& diagnostics) {
  if (name.empty() || !find_function(context.functions, name, where, user, diagnostics)) return nullptr;
  for (const auto& record : context.spec.functions) {
    if (record.name == name) return Curve::make(record, where, user, diagnostics);
  }
  return nullptr;
}

std::unique_ptr<const ForceElement> build_element(const ForceElementRecord& record, const ElementContext& context,
                                                  Tree& tree, Diagnostics& diagnostics) {
  return ElementBuilder(record, context, tree, diagnostics).build();
}

}  // namespace bough::solver
