#include "solver/builder/build.hpp"
#include "solver/text/names.hpp"

namespace bough::solver {

namespace {
bool check_count(const records::HingeRecord& r, const std::vector<double>& values, int expected, const char* key,
                 Diagnostics& diagnostics) {
  if (values.empty() || static_cast<int>(values.size()) == expected) return true;
  diagnostics.error("system.bad-count", r.at,
                    "hinge " + quote(r.name) + ": " + key + " has " + std::to_string(values.size()) +
                        " values, expected " + std::to_string(expected));
  return false;
}

// Coordinates as the files have them (a quaternion as w, x, y, z); neutral when none are given.
VectorXd make_coordinates(const records::HingeRecord& r, const std::vector<double>& values, const Hinge& hinge,
                          const char* key, Diagnostics& diagnostics) {
  VectorXd q(hinge.num_q());
  hinge.set_neutral(q.data());
  if (values.empty() || !check_count(r, values, hinge.num_q(), key, diagnostics)) return q;
  hinge.set_from_file(values.data(), q.data());
  if (!hinge.has_independent_coordinates()) {
    const double norm = q.head<4>().norm();
    if (!(norm > 1e-6)) {
      diagnostics.error("system.zero-quaternion", r.at,
                        "hinge " + quote(r.name) + ": the quaternion in " + key + " has no length");
      hinge.set_neutral(q.data());
      return q;
    }
    q.head<4>() /= norm;
  }
  return q;
}

VectorXd as_vector(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

void build_motion(const records::HingeRecord& r, const FunctionMap& functions, TreeBody& tb, Diagnostics& diagnostics) {
  const int nu = tb.hinge->num_u();
  int given = 0;
  for (const auto& name : r.motion) given += name.empty() ? 0 : 1;
  if (given == 0) return;
  if (!tb.hinge->has_independent_coordinates()) {
    diagnostics.error("system.prescribed-rotation", r.at,
                      "hinge " + quote(r.name) + ": the motion of a spherical or free hinge cannot be prescribed",
                      "use hinges of angles and travels: gimbal and general (without q) among them");
    return;
  }
  if (static_cast<int>(r.motion.size()) != nu) {
    diagnostics.error("system.bad-count", r.at,
                      "hinge " + quote(r.name) + ": motion names " + std::to_string(r.motion.size()) +
                          " functions, expected " + std::to_string(nu) + ", one per coordinate (\"\": none)");
    return;
  }
  for (size_t i = 0; i < r.motion.size(); ++i) {
    tb.motion.push_back(r.motion[i].empty()
                            ? nullptr
                            : find_function(functions, r.motion[i], r.at, "hinge " + quote(r.name), diagnostics));
    if (tb.motion[i] != nullptr && !tb.motion[i]->has_derivatives()) {
      diagnostics.error("system.motion-without-rate", r.at,
                        "hinge " + quote(r.name) + ": function " + quote(r.motion[i]) +
                            ", its prescribed motion, has no known rate and acceleration",
                        "give the expression 'rate' and 'acceleration', its derivatives, or use a cubic table");
      tb.motion[i] = nullptr;
      continue;
    }
    if (tb.motion[i] != nullptr) tb.mode[i] = HingeMode::Prescribed;
  }
  if (given == nu && (!r.stiffness.empty() || !r.damping.empty())) {
    diagnostics.warning("system.ignored-spring", r.at,
                        "hinge " + quote(r.name) +
                            " has a prescribed motion: its stiffness and damping have no effect "
                            "on it, up to a release",
                        "remove them, unless an event releases the hinge");
  }
  if (given == nu && (!r.position.empty() || !r.rate.empty())) {
    diagnostics.warning("system.ignored-position", r.at,
                        "hinge " + quote(r.name) +
                            " has a prescribed motion: its initial position and rate are those "
                            "of the function",
                        "remove position and rate");
  }
}

// Locked coordinates start at rest; an orientation is locked as a whole.
void build_locks(const records::HingeRecord& r, TreeBody& tb, Diagnostics& diagnostics) {
  const int nu = tb.hinge->num_u();
  if (r.locked.empty()) return;
  if (static_cast<int>(r.locked.size()) != nu) {
    diagnostics.error("system.bad-count", r.at,
                      "hinge " + quote(r.name) + ": locked has " + std::to_string(r.locked.size()) +
                          " values, expected " + std::to_string(nu));
    return;
  }
  const auto first = r.locked.begin();
  if (!tb.hinge->has_independent_coordinates() && (r.locked[0] != r.locked[1] || r.locked[0] != r.locked[2])) {
    diagnostics.error("system.partial-lock", r.at,
                      "hinge " + quote(r.name) + ": of the three rates of an orientation some are locked and some not",
                      "lock all three or none, or use a universal or revolute hinge");
    return;
  }
  std::string moving;
  for (int i = 0; i < nu; ++i) {
    if (!*(first + i)) continue;
    const auto at = static_cast<size_t>(i);
    if (tb.mode[at] == HingeMode::Prescribed || tb.initial_u[i] != 0)
      moving += (moving.empty() ? "" : ", ") + std::to_string(i + 1);
    tb.mode[at] = HingeMode::Locked;
  }
  if (moving.empty()) return;
  diagnostics.error(
      "system.locked-motion", r.at,
      "hinge " + quote(r.name) + ": coordinate " + moving + " is locked and has a motion or an initial rate",
      "remove one of them; an [[event]] with action = \"lock\" stops a coordinate that moves");
}
}  // namespace

const TimeFunction* find_function(const FunctionMap& functions, const std::string& name, const SourceLocation& where,
                                  const std::string& user, Diagnostics& diagnostics) {
  const auto found = functions.find(name);
  if (found != functions.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, f] : functions) names.push_back(known);
  diagnostics.error("system.unknown-function", where,
                    user + " names function " + quote(name) + ", which does not exist",
                    suggest_name(name, names, "declare it"));
  return nullptr;
}

void build_hinge_coordinates(const records::HingeRecord& r, const FunctionMap& functions, TreeBody& tb,
                             Diagnostics& diagnostics) {
  const int nu = tb.hinge->num_u();
  check_count(r, r.stiffness, nu, "stiffness", diagnostics);
  check_count(r, r.damping, nu, "damping", diagnostics);
  tb.initial_q = make_coordinates(r, r.position, *tb.hinge, "position", diagnostics);
  tb.null_position = make_coordinates(r, r.null_position, *tb.hinge, "null_position", diagnostics);
  // The sign of the quaternion is chosen within half a turn of the springs' rest position, from where they follow it.
  if (!tb.hinge->has_independent_coordinates() && tb.initial_q.head<4>().dot(tb.null_position.head<4>()) < 0)
    tb.initial_q.head<4>() *= -1;
  tb.initial_u = VectorXd::Zero(nu);
  if (!r.rate.empty() && check_count(r, r.rate, nu, "rate", diagnostics)) tb.initial_u = as_vector(r.rate);
  tb.mode.assign(static_cast<size_t>(nu), HingeMode::Free);
  build_motion(r, functions, tb, diagnostics);
  build_locks(r, tb, diagnostics);
  tb.stiffness = as_vector(r.stiffness);
  tb.damping = as_vector(r.damping);
}

}  // namespace bough::solver
