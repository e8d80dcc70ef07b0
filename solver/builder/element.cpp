// [[force]] with a type: names to markers and bodies.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "solver/builder/build.hpp"
#include "solver/forces/bushing.hpp"
#include "solver/forces/central_gravity.hpp"
#include "solver/forces/contact.hpp"
#include "solver/forces/drag.hpp"
#include "solver/forces/faces.hpp"
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
    const bool has_table = !r_.density_table.empty();
    if (!(r_.area >= 0) || !(r_.coefficient >= 0) || !(r_.density >= 0))
      refuse("has a negative area, coefficient or density", "give values of at least zero");
    DragElement::Law law;
    law.half_density_area = 0.5 * (has_table ? 1 : r_.density) * r_.coefficient * r_.area;
    if (r_.normal.norm() > 0) law.normal = r_.normal.normalized();
    law.wind_W = r_.wind;
    if ((r_.scale_height != 0 || r_.altitude != 0 || has_table || !r_.spin.isZero(0)) && r_.planet.empty())
      refuse("has scale_height, altitude, density_table or spin and no planet", "name a gravity_central with a radius");
    if (has_table) law.table = find_density_table();
    if (const ForceElementRecord* planet = find_planet()) {
      if (!has_table && !(r_.scale_height > 0))
        refuse("has a planet without scale_height", "give the scale height of the density, or a density_table");
      law.has_planet = true;
      law.scale_height = r_.scale_height;
      law.altitude = r_.altitude;
      law.radius = planet->equator;
      law.centre_W = planet->centre;
      law.spin_W = r_.spin;
    }
    if (r_.from.body == "ground") refuse("acts on ground", "name a body");
    if (r_.has_faces) {
      law.half_density_area = 0.5 * (has_table ? 1 : r_.density) * r_.coefficient;
      return std::make_unique<DragOnFaces>(r_.name, find_faces(), law, r_.is_one_sided);
    }
    return std::make_unique<DragElement>(r_.name, add_marker(r_.from, {true, false}), law);
  }

  /// Faces of the elements of the body, all of surfaces if none is named. Without faces: reported.
  MeshFaces find_faces() {
    MeshFaces made;
    made.body = find_body(r_.from.body);
    if (made.body < 0) return made;  // reported, or ground
    const auto is_it = [&](const records::BodyRecord& body) { return body.name == r_.from.body; };
    const auto record = std::find_if(context_.spec.bodies.begin(), context_.spec.bodies.end(), is_it);
    const auto flex = context_.flex.find(record->file);
    if (flex == context_.flex.end()) {
      refuse("has elements, and body " + quote(r_.from.body) + " is rigid", "give area and normal");
      return made;
    }
    const records::FlexBody& body = flex->second;
    const int n = tree_[made.body].num_modes();
    std::set<int> missing(r_.faces.begin(), r_.faces.end());
    std::map<int, int> row_of;  // of the grids of the mesh
    for (const auto& block : body.mesh.blocks) {
      const int count = block.type.starts_with("tri") ? 3 : block.type.starts_with("quad") ? 4 : 0;
      for (Eigen::Index e = 0; count > 0 && e < block.connectivity.rows(); ++e) {
        const int id = block.element_id[static_cast<size_t>(e)];
        if (!r_.faces.empty() && missing.erase(id) == 0) continue;
        MeshFaces::Face face;
        face.count = count;
        bool has_grids = true;
        for (int i = 0; i < count; ++i) {
          const int grid = block.connectivity(e, i);
          has_grids = has_grids && grid >= 0;
          if (has_grids)
            face.corner[static_cast<size_t>(i)] = row_of.emplace(grid, static_cast<int>(row_of.size())).first->second;
        }
        if (has_grids) made.faces.push_back(face);
      }
    }
    if (!missing.empty())
      refuse("has element " + std::to_string(*missing.begin()) + ", which is no shell of body " + quote(r_.from.body),
             "name CQUAD4, CTRIA3 and other surfaces of its deck");
    else if (made.faces.empty())
      refuse("has elements, and the file of body " + quote(r_.from.body) + " has no shells", "give area and normal");
    made.p.resize(3, static_cast<Eigen::Index>(row_of.size()));
    made.shapes.setZero(3 * static_cast<Eigen::Index>(row_of.size()), n);
    for (const auto& [grid, row] : row_of) {
      made.p.col(row) = body.mesh.grid_xyz.row(grid).transpose();
      const int node = body.find_node(body.mesh.grid_id[static_cast<size_t>(grid)]);
      if (body.mesh_phi.size() > 0)
        made.shapes.middleRows<3>(3 * row) = body.mesh_phi.middleRows<3>(3 * grid).leftCols(n).cast<double>();
      else if (node >= 0)
        made.shapes.middleRows<3>(3 * row) = body.phi[static_cast<size_t>(node)].topRows<3>().leftCols(n);
    }
    return made;
  }

  /// Density over altitude; empty: reported.
  DensityTable find_density_table() {
    if (!find_table(r_.density_table)) return {};
    const auto named = [&](const records::FunctionRecord& record) { return record.name == r_.density_table; };
    const auto record = std::find_if(context_.spec.functions.begin(), context_.spec.functions.end(), named);
    const std::string table = "has the density_table " + quote(r_.density_table);
    if (record->x.size() < 2) {
      refuse(table + " of one point", "give two altitudes or more");
    } else if (record->interpolation == "cubic") {
      refuse(table + ", which is cubic", "leave interpolation out: the logarithm of the density is linear");
    } else if (std::any_of(record->y.begin(), record->y.end(), [](double rho) { return !(rho > 0); })) {
      refuse(table + " with a density that is not above zero", "end the table at the last density above zero");
    } else {
      return {record->x, record->y};
    }
    return {};
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
    if ((!r_.has_faces && !(r_.normal.norm() > 0)) || !(r_.sun.norm() > 0))
      refuse("has a normal or a sun without direction", "give three numbers, not all zero");
    if (!(r_.sun_size > 0) || r_.sun_size > 1)
      refuse("has a sun_size that is no angular radius", "give radians, as 0.00465");
    if (r_.from.body == "ground") refuse("acts on ground", "name a body");
    SolarPressure::Panel panel;
    panel.pressure = r_.pressure;
    panel.area = r_.area;
    panel.specular = r_.specular;
    panel.diffuse = r_.diffuse;
    if (!r_.has_faces) panel.normal = r_.normal.normalized();
    panel.sun_W = r_.sun.normalized();
    panel.is_one_sided = r_.is_one_sided;
    if (const ForceElementRecord* planet = find_planet()) panel.shadow = {planet->centre, planet->equator, r_.sun_size};
    panel.shading = find_shading(panel.sun_W);
    if (r_.has_faces) return std::make_unique<SunOnFaces>(r_.name, find_faces(), panel);
    return std::make_unique<SolarPressure>(r_.name, add_marker(r_.from, {true, false}), panel);
  }

  /// Hulls of the bodies that shade the panel or the faces.
  Shading find_shading(const Vector3d& sun_W) {
    std::vector<ShadingBody> bodies;
    for (const std::string& name : r_.shaded_by) {
      if (name == "ground" || name == r_.from.body) {
        refuse("is shaded_by " + (name == "ground" ? "ground" : "its own body " + quote(name)),
               "name other bodies; one_sided is for the faces of a closed hull");
        continue;
      }
      ShadingBody shading;
      shading.body = find_body(name);
      if (shading.body < 0) continue;  // reported
      const auto is_it = [&](const records::BodyRecord& body) { return body.name == name; };
      const records::BodyRecord& record =
          *std::find_if(context_.spec.bodies.begin(), context_.spec.bodies.end(), is_it);
      std::vector<Vector3d> corners = record.hull;
      if (corners.empty())
        for (const auto& node : record.nodes) corners.push_back(node.p);
      shading.corners_B.resize(3, static_cast<Eigen::Index>(corners.size()));
      for (size_t i = 0; i < corners.size(); ++i) shading.corners_B.col(static_cast<Eigen::Index>(i)) = corners[i];
      if (corners.size() < 3 || !has_extent(shading.corners_B)) {
        refuse("is shaded_by body " + quote(name) + ", whose " + (record.hull.empty() ? "nodes have" : "hull has") +
                   " no area",
               "give the body a hull: the corners of its outline, as [[x, y, z], ...]");
        continue;
      }
      bodies.push_back(std::move(shading));
    }
    return {std::move(bodies), sun_W};
  }

  /// Returns true if the points are finite, and not all on one line.
  static bool has_extent(const Eigen::Matrix3Xd& points) {
    const Eigen::Matrix3Xd r = points.colwise() - points.rowwise().mean();
    const Vector3d sizes = Eigen::JacobiSVD<Eigen::Matrix3Xd>(r).singularValues().head<3>();
    return points.allFinite() && sizes[1] > 1e-9 * sizes[0];
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
