// Preload, tables, stops, friction and motors of the coordinates of a hinge.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "solver/builder/build.hpp"
#include "solver/forces/hinge_law.hpp"
#include "solver/forces/stop_tolerance.hpp"

namespace bough::solver {

namespace {

double get(const std::vector<double>& values, int i, double otherwise = 0) {
  return static_cast<size_t>(i) < values.size() ? values[static_cast<size_t>(i)] : otherwise;
}

constexpr double kNoStop = std::numeric_limits<double>::infinity();

bool has_stop(const records::HingeLawRecord& law, int i) {
  return std::isfinite(get(law.stop_lower, i, -kNoStop)) || std::isfinite(get(law.stop_upper, i, kNoStop));
}

bool has_rigid_stop(const records::HingeLawRecord& law, int i) {
  return has_stop(law, i) && !law.stop_restitution.empty();
}

bool has_friction(const records::HingeLawRecord& law, int i) {
  return get(law.coulomb, i) > 0 || get(law.static_friction, i, get(law.coulomb, i)) > 0;
}

bool has_load_friction(const records::HingeLawRecord& law, int i) {
  return get(law.mu, i) > 0 || get(law.mu_static, i) > 0;
}

bool has_dry_friction(const records::HingeLawRecord& law, int i) {
  return (has_friction(law, i) || has_load_friction(law, i)) && !(get(law.smoothing, i) > 0);
}

class LawBuilder {
 public:
  LawBuilder(const records::HingeRecord& record, const ElementContext& context, TreeBody& tb, Diagnostics& diagnostics)
      : r_(record), context_(context), tb_(tb), diagnostics_(diagnostics), user_("hinge " + quote(record.name)) {}

  void build(std::vector<std::unique_ptr<const ForceElement>>& elements, std::vector<JointContact>& joint_contacts,
             std::vector<LoadFriction>& load_frictions) {
    const auto& law = r_.law;
    bool is_given = law.has_stops || law.has_friction;
    for (const auto* list : {&law.preload, &law.rotor_inertia}) is_given = is_given || !list->empty();
    for (const auto* list : {&law.spring_table, &law.damper_table}) is_given = is_given || !list->empty();
    if (!is_given) return;
    if (!tb_.hinge->has_independent_coordinates()) {
      refuse("is of a type without single coordinates: it takes no preload, tables, stops, friction or motor inertia",
             "use hinges of angles and travels: gimbal and general (without q) among them");
      return;
    }
    const int errors = diagnostics_.num_errors();
    check_lists();
    if (diagnostics_.num_errors() != errors) return;
    set_rotor();
    int ignored = 0;
    for (int i = 0; i < tb_.num_hinge_u(); ++i) {
      if (tb_.mode[static_cast<size_t>(i)] == HingeMode::Prescribed) ++ignored;
      add(i, elements, joint_contacts, load_frictions);
    }
    const bool has_forces = law.has_stops || law.has_friction || !law.preload.empty() || !law.spring_table.empty() ||
                            !law.damper_table.empty();
    if (has_forces && ignored == tb_.num_hinge_u() && ignored > 0) {
      diagnostics_.warning("system.ignored-spring", r_.at,
                           user_ +
                               " has a prescribed motion: its preload, tables, stops and friction have no effect on "
                               "it, up to a release",
                           "remove them, unless an event releases the hinge");
    }
  }

 private:
  void refuse(const std::string& what, const std::string& advice) {
    diagnostics_.error("system.bad-hinge-law", r_.at, user_ + " " + what, advice);
  }

  template <class T>
  void check_count(const std::vector<T>& values, const char* key) {
    const int nu = tb_.num_hinge_u(), size = static_cast<int>(values.size());
    if (size == 0 || size == nu) return;
    diagnostics_.error("system.bad-count", r_.at,
                       user_ + ": " + key + " has " + std::to_string(size) + " values, expected " + std::to_string(nu));
  }
  void check_positive(const std::vector<double>& values, const char* key) {
    check_count(values, key);
    for (const double x : values) {
      if (std::isfinite(x) && x >= 0) continue;
      refuse("has a negative " + std::string(key), "give a value of at least zero");
      return;
    }
  }

  void check_lists() {
    const auto& law = r_.law;
    check_count(law.preload, "preload");
    check_count(law.spring_table, "spring_table");
    check_count(law.damper_table, "damper_table");
    check_count(law.stop_lower, "lower of stops");
    check_count(law.stop_upper, "upper of stops");
    check_positive(law.stop_stiffness, "stiffness of stops");
    check_positive(law.stop_damping, "damping of stops");
    check_positive(law.stop_restitution, "restitution of stops");
    check_positive(law.coulomb, "coulomb friction");
    check_positive(law.static_friction, "static friction");
    check_positive(law.stribeck_velocity, "stribeck_velocity");
    check_positive(law.smoothing, "smoothing");
    check_positive(law.mu, "mu of friction");
    check_positive(law.mu_static, "mu_static of friction");
    check_positive(law.pin_radius, "pin_radius of friction");
    check_positive(law.friction_arm, "friction_arm");
    check_positive(law.bending_arm, "bending_arm of friction");
    check_positive(law.reaction_arm, "reaction_arm of friction");
    check_positive(law.rotor_inertia, "rotor_inertia");
    check_count(law.gear_ratio, "gear_ratio");
  }

  void set_rotor() {
    if (r_.law.rotor_inertia.empty()) return;
    tb_.rotor = VectorXd::Zero(tb_.num_hinge_u());
    for (int i = 0; i < tb_.num_hinge_u(); ++i) {
      const double ratio = get(r_.law.gear_ratio, i, 1);
      tb_.rotor[i] = get(r_.law.rotor_inertia, i) * ratio * ratio;
    }
  }

  std::unique_ptr<const Curve> find_table(const std::vector<std::string>& names, int i) {
    if (names.empty()) return nullptr;
    return find_curve(context_, names[static_cast<size_t>(i)], r_.at, user_, diagnostics_);
  }

  void check_stops(const HingeLaw::Law& law, double restitution, bool is_rigid, const std::string& which) {
    if (!(law.lower < law.upper))
      refuse("has stops of coordinate " + which + " with lower above upper", "exchange them");
    if (!is_rigid && !(law.stop_stiffness > 0))
      refuse("has stops without stiffness", "give stops a stiffness > 0, or a restitution for rigid ones");
    if (is_rigid && restitution > 1)
      refuse("has stops with a restitution above 1", "give the speed after over the speed before, 0 .. 1");
    if (is_rigid && (law.stop_stiffness > 0 || law.stop_damping > 0))
      refuse("has stops with a restitution and a spring", "give stops a stiffness and damping, or a restitution");
  }

  // Column of the coordinate: [v; w] at unit rate.
  Vector6d calc_column(int i) const {
    VectorXd q(tb_.num_hinge_q());
    tb_.hinge->set_neutral(q.data());
    HingeMotion motion;
    tb_.hinge->calc_position(q.data(), motion);
    return motion.H.col(i);
  }

  // Friction by bearing load; nothing without mu.
  std::optional<LoadFriction> make_load_friction(int i, const HingeLaw::Law& law, const std::string& which) {
    const auto& r = r_.law;
    LoadFriction f;
    f.dynamic = get(r.mu, i);
    f.at_rest = get(r.mu_static, i, f.dynamic);
    const double pin = get(r.pin_radius, i), arm = get(r.friction_arm, i), bending = get(r.bending_arm, i),
                 reaction = get(r.reaction_arm, i);
    if (f.dynamic == 0 && f.at_rest == 0) {
      if (pin > 0 || arm > 0 || bending > 0 || reaction > 0)
        refuse("has arms of friction without mu", "give mu, or coulomb alone");
      return std::nullopt;
    }
    const Vector6d column = calc_column(i);
    const bool angle = column.head<3>().isZero(0), has_thread = !angle && !column.tail<3>().isZero(0);
    if (has_thread || r_.type == records::HingeType::Cylindrical || r_.type == records::HingeType::Planar) {
      refuse("has friction by mu, which needs one bearing per coordinate",
             "give coulomb, or use a revolute and a prismatic hinge in a row");
      return std::nullopt;
    }
    if (angle && !(pin > 0) && !(arm > 0))
      refuse("has mu for the angle of coordinate " + which + " without an arm", "give pin_radius or friction_arm");
    if (angle && bending > 0 && !(pin > 0))
      refuse("has a bending_arm without a pin_radius", "give the pin_radius on which the bearing force acts");
    if (angle ? reaction > 0 : pin > 0 || arm > 0)
      refuse(
          angle ? "has a reaction_arm, which is for travels" : "has a pin_radius or friction_arm, which are for angles",
          "remove it, or give a list with 0 for this coordinate");
    if (f.at_rest < f.dynamic) refuse("has mu_static below mu", "give mu_static at least as much");
    if (f.at_rest > f.dynamic && !(law.stribeck_velocity > 0) && !law.is_dry)
      refuse("has mu_static without stribeck_velocity", "give the rate over which it falls to mu");
    f.name = "coordinate " + which + " of hinge " + quote(tb_.hinge_name);
    f.at = r_.at;
    f.coordinate = i;
    f.u_row = tb_.u_offset + i;
    f.stribeck_velocity = law.stribeck_velocity;
    f.smoothing = law.smoothing;
    f.is_dry = law.is_dry;
    f.radial = angle ? pin : 1;
    f.axial = angle ? arm : 0;
    f.bending = bending > 0 ? f.radial / bending : 0;
    f.torsion = reaction > 0 ? 1 / reaction : 0;
    return f;
  }

  void add(int i, std::vector<std::unique_ptr<const ForceElement>>& elements, std::vector<JointContact>& joint_contacts,
           std::vector<LoadFriction>& load_frictions) {
    const auto& r = r_.law;
    HingeLaw::Law law;
    law.preload = get(r.preload, i);
    law.null_position = tb_.null_position[i];
    law.spring = find_table(r.spring_table, i);
    law.damper = find_table(r.damper_table, i);
    law.lower = get(r.stop_lower, i, -kNoStop);
    law.upper = get(r.stop_upper, i, kNoStop);
    law.stop_stiffness = get(r.stop_stiffness, i);
    law.stop_damping = get(r.stop_damping, i);
    law.coulomb = get(r.coulomb, i);
    law.static_friction = get(r.static_friction, i, law.coulomb);
    law.stribeck_velocity = get(r.stribeck_velocity, i);
    law.smoothing = get(r.smoothing, i);
    const std::string which = std::to_string(i + 1);
    const bool is_rigid = has_rigid_stop(r, i);
    if (has_stop(r, i)) check_stops(law, get(r.stop_restitution, i), is_rigid, which);
    law.is_dry = has_dry_friction(r, i);
    std::optional<LoadFriction> by_load = make_load_friction(i, law, which);
    if (law.static_friction < law.coulomb)
      refuse("has static friction below coulomb friction", "give static at least as much");
    if (law.static_friction > law.coulomb && !(law.stribeck_velocity > 0) && !law.is_dry)
      refuse("has static friction without stribeck_velocity", "give the rate over which it falls to coulomb's");
    if (has_joint_contact(r, i))
      joint_contacts.push_back({"coordinate " + which + " of hinge " + quote(tb_.hinge_name), tb_.q_offset + i,
                                tb_.u_offset + i, is_rigid ? law.lower : -kNoStop, is_rigid ? law.upper : kNoStop,
                                get(r.stop_restitution, i), law.is_dry ? law.static_friction : 0,
                                law.is_dry && by_load.has_value()});
    if (!(law.stribeck_velocity > 0)) {
      if (law.is_dry) law.static_friction = law.coulomb;  // as soon as it slides
      law.stribeck_velocity = 1;
      if (by_load) by_load->stribeck_velocity = 0;
    }
    if (by_load) load_frictions.push_back(*by_load);
    if (is_rigid) {
      law.lower = -kNoStop;
      law.upper = kNoStop;
    }
    const bool acts =
        law.preload != 0 || law.spring || law.damper || (has_stop(r, i) && !is_rigid) || has_friction(r, i);
    if (acts) {
      elements.push_back(
          std::make_unique<HingeLaw>(tb_.hinge_name + ":" + which, tb_.q_offset + i, tb_.u_offset + i, std::move(law)));
    }
  }

  const records::HingeRecord& r_;
  const ElementContext& context_;
  TreeBody& tb_;
  Diagnostics& diagnostics_;
  std::string user_;
};

}  // namespace

bool has_joint_contact(const records::HingeLawRecord& law, int i) {
  return has_rigid_stop(law, i) || has_dry_friction(law, i);
}

void build_hinge_laws(const records::HingeRecord& record, const ElementContext& context, TreeBody& tb,
                      std::vector<std::unique_ptr<const ForceElement>>& elements,
                      std::vector<JointContact>& joint_contacts, std::vector<LoadFriction>& load_frictions,
                      Diagnostics& diagnostics) {
  LawBuilder(record, context, tb, diagnostics).build(elements, joint_contacts, load_frictions);
}

void check_stops(System& system, Diagnostics& diagnostics) {
  VectorXd q(system.tree.num_q), u(system.tree.num_u);
  system.calc_initial_state(q, u);
  for (const JointContact& contact : system.joint_contacts) {
    const auto carries = [&](const TreeBody& b) {
      return contact.u_row >= b.u_offset && contact.u_row < b.u_offset + b.num_hinge_u();
    };
    TreeBody& tb = *std::find_if(system.tree.bodies.begin(), system.tree.bodies.end(), carries);
    const int i = contact.u_row - tb.u_offset;
    if (tb.mode[static_cast<size_t>(i)] == HingeMode::Prescribed) continue;
    const double at = q[contact.q_row], inside = std::clamp(at, contact.lower, contact.upper);
    if (at == inside) continue;
    if (std::abs(at - inside) > calc_slack(inside)) {
      std::ostringstream what;
      what << contact.name << " starts at " << at << ", beyond its " << (at < inside ? "lower" : "upper") << " stop at "
           << inside;
      diagnostics.error("system.beyond-stop", tb.hinge_at, what.str(),
                        system.initial_q.size() > 0
                            ? "give the hinge a position within its stops, or close the loops so"
                            : "give the hinge a position within its stops");
      continue;
    }
    tb.initial_q[i] = inside;
    if (system.initial_q.size() > 0) system.initial_q[contact.q_row] = inside;
  }
}

}  // namespace bough::solver
