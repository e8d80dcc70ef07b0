// [[tank]] of a system file: propellant of a rigid body.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "solver/builder/build.hpp"
#include "solver/text/names.hpp"

namespace bough::solver {
namespace {

class TankBuilder {
 public:
  TankBuilder(const records::TankRecord& record, const Body& body, const std::string& body_name,
              Diagnostics& diagnostics)
      : r_(record), body_(body), body_name_(body_name), diagnostics_(diagnostics) {}

  /// nullptr: reported.
  std::unique_ptr<const TankShape> build() {
    const int errors = diagnostics_.num_errors();
    if (body_.num_modes() > 0)
      refuse("is on the flexible body " + quote(body_name_) + ", whose mass is that of its file",
             "put it on a rigid body that a fixed hinge attaches to a node");
    if (!(r_.axis.norm() > 0) || !r_.axis.allFinite() || !r_.position.allFinite())
      refuse("has an axis without direction or a position that is not finite", "give three numbers");
    auto shape = r_.type == records::TankType::Table ? make_table() : make_solid();
    if (!shape || diagnostics_.num_errors() != errors) return nullptr;
    if (!(r_.mass >= 0) || !std::isfinite(r_.mass)) refuse("has a mass below zero", "give the propellant at the start");
    if (r_.mass > shape->capacity() * (1 + 1e-9)) {
      std::ostringstream what;
      what << "has a mass of " << r_.mass << ", and holds " << shape->capacity();
      refuse(what.str(),
             r_.type == records::TankType::Table ? "extend the table" : "enlarge it, or correct mass or density");
    }
    if (diagnostics_.num_errors() != errors) return nullptr;
    return shape;
  }

 private:
  void refuse(const std::string& what, const std::string& advice) {
    diagnostics_.error("system.bad-tank", r_.at, "tank " + quote(r_.name) + " " + what, advice);
  }

  std::unique_ptr<const TankShape> make_solid() {
    const bool has_height = r_.type != records::TankType::Sphere;
    if (!(r_.radius > 0) || !(r_.density > 0) || (has_height && !(r_.height > 0))) {
      refuse("has a radius, height or density that is not positive", "give values above zero");
      return nullptr;
    }
    const TankAxis place{r_.position, r_.axis.normalized()};
    if (r_.type == records::TankType::Cylinder) return make_cylinder_tank(place, r_.radius, r_.height, r_.density);
    if (r_.type == records::TankType::Sphere) return make_sphere_tank(place, r_.radius, r_.density);
    if (!(r_.bore >= 0 && r_.bore < r_.radius)) {
      refuse("has a bore that is not below its radius", "give 0 <= bore < radius");
      return nullptr;
    }
    return make_grain(place, r_.radius, r_.bore, r_.height, r_.density);
  }

  std::unique_ptr<const TankShape> make_table() {
    const auto n = r_.masses.size();
    const bool is_sized = n > 0 && r_.cg.size() == n && r_.inertia.size() == n;
    const bool is_ascending = std::is_sorted(r_.masses.begin(), r_.masses.end(), std::less_equal<>());
    const double empty = r_.is_of_body ? body_.mass() : 0;
    if (!is_sized || !is_ascending || (n > 1 && r_.masses.front() > empty * (1 + 1e-9) + 1e-300)) {
      refuse("has masses that do not ascend from " + std::string(r_.is_of_body ? "the mass of its body" : "0"),
             "give ascending masses that begin with the empty tank");
      return nullptr;
    }
    TankContent whole;
    if (r_.is_of_body) {
      whole.mass = body_.mass();
      whole.S = body_.first_moment();
      whole.J = body_.M6().bottomRightCorner<3, 3>();
    }
    return make_tank_table({r_.masses, r_.cg, r_.inertia}, whole);
  }

  const records::TankRecord& r_;
  const Body& body_;
  const std::string& body_name_;
  Diagnostics& diagnostics_;
};

}  // namespace

void build_tanks(const records::SystemSpec& spec, const TreeOrder& order, const FunctionMap& functions, System& system,
                 Diagnostics& diagnostics) {
  Tree& tree = system.tree;
  for (const auto& r : spec.tanks) {
    const auto found = order.tree_index.find(r.body);
    if (found == order.tree_index.end()) {
      std::vector<std::string> names;
      for (const auto& body : spec.bodies) names.push_back(body.name);
      if (std::find(names.begin(), names.end(), r.body) == names.end())
        diagnostics.error("system.unknown-body", r.at,
                          "tank " + quote(r.name) + " names body " + quote(r.body) + ", which does not exist",
                          suggest_name(r.body, names, "declare it"));
      continue;
    }
    if (!system.is_valid(found->second)) continue;
    TreeBody& tb = tree.bodies[static_cast<size_t>(found->second)];
    Tank tank;
    tank.name = r.name;
    tank.at = r.at;
    tank.body = found->second;
    tank.shape = TankBuilder(r, tb.body, tb.name, diagnostics).build();
    if (!tank.shape) {  // reported; an empty one for the thrusters that name it
      tank.shape = make_tank_table({{0}, {Vector3d::Zero()}, {Matrix3d::Zero()}}, {});
      tree.tanks.push_back(std::move(tank));
      continue;
    }
    tank.initial = r.mass;
    tank.reserve = r.slosh_mass;
    if (r.slosh_mass > 0) tank.shape = make_tank_without(std::move(tank.shape), r.slosh_mass, r.slosh_position);
    if (!r.function.empty()) {
      const std::string user = "tank " + quote(r.name);
      tank.function = find_function(functions, r.function, r.at, user, diagnostics);
      if (!tank.function) continue;
      const int node = find_loaded_node(tb.name, tb.body, r.exit_node, {}, r.at, user, diagnostics);
      if (node < 0) continue;
      tank.initial = tank.function->calc(system.start).f;
      tank.exit = tb.body.nodes()[static_cast<size_t>(node)].p;
      tank.exit_radius = r.exit_radius;
      if (r.exit_axis.norm() > 0) tank.exit_axis = r.exit_axis.normalized();
      std::ostringstream what;
      what << user << " has the function " << quote(r.function);
      const auto refuse = [&](const std::string& advice) {
        diagnostics.error("system.bad-tank", r.at, what.str(), advice);
      };
      if (!tank.function->has_derivatives()) {
        what << ", of which the rate, the flow, is not known";
        refuse("give the expression its rate and acceleration, or use a cubic table");
        continue;
      }
      if (!(tank.initial >= 0)) {
        what << " and is emptier than empty at the start: its mass is " << tank.initial;
        refuse("start the function at a mass of at least 0");
        continue;
      }
      if (tank.initial > tank.shape->capacity() * (1 + 1e-9)) {
        what << " and a mass of " << tank.initial << " at the start, and holds " << tank.shape->capacity();
        refuse("start the function at a mass that the tank holds");
        continue;
      }
    }
    tb.tanks.push_back(static_cast<int>(tree.tanks.size()));
    tree.tanks.push_back(std::move(tank));
  }
}

}  // namespace bough::solver
