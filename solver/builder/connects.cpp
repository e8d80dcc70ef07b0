#include "solver/builder/connects.hpp"

#include <algorithm>
#include <cstdlib>
#include <set>

namespace bough::solver {
namespace {

using records::ConnectRecord;

class Collector {
 public:
  Collector(const records::SystemSpec& spec, Diagnostics& diagnostics) : spec_(spec), diagnostics_(diagnostics) {}

  SignalUses collect() {
    for (const auto& r : spec_.controllers) {
      ControllerUses& uses = uses_.controllers[r.name];
      for (const auto& text : r.inputs) uses.inputs.push_back({text, 1, r.at});
      if (!r.reference.empty()) uses.reference.push_back({r.reference, 1, r.at});
      if (!r.rate.empty()) uses.rate.push_back({r.rate, 1, r.at});
    }
    for (const auto& r : spec_.actuators)
      if (!r.input.empty()) uses_.actuators[r.name] = {r.input, 1, r.at};
    for (const auto& r : spec_.forces)
      if (!r.signal.empty()) uses_.forces[r.name] = {r.signal, 1, r.at};
    for (const auto& r : spec_.connects) add(r);
    for (const auto& [name, uses] : uses_.controllers) {
      const auto gap =
          std::find_if(uses.inputs.begin(), uses.inputs.end(), [](const auto& u) { return u.text.empty(); });
      if (gap == uses.inputs.end()) continue;
      const auto last = std::find_if(gap, uses.inputs.end(), [](const auto& u) { return !u.text.empty(); });
      diagnostics_.error("control.bad-connect", last->at,
                         "controller '" + name + "' has no input " + std::to_string(gap - uses.inputs.begin() + 1) +
                             ", and one after it",
                         "connect it, or count its inputs from 1");
      // Each gap is reported once; the remaining list has no gaps.
      std::erase_if(uses_.controllers[name].inputs, [](const auto& u) { return u.text.empty(); });
    }
    return std::move(uses_);
  }

 private:
  void error(const ConnectRecord& r, const std::string& what, const std::string& advice) {
    diagnostics_.error("control.bad-connect", r.at, "the wire from '" + r.from + "' to '" + r.to + "' " + what, advice);
  }

  /// Splits "law:2": the whole where that is a name.
  struct Target {
    std::string kind, name, port;
  };

  bool find(const ConnectRecord& r, Target& target) {
    std::vector<Target> found;
    std::vector<std::string> known;
    const auto look = [&](const std::string& kind, const std::string& name, const std::string& folder) {
      known.push_back(name);
      for (const auto& full : {name, folder + name}) {
        if (r.to == full) found.push_back({kind, name, ""});
        if (r.to.rfind(full + ":", 0) == 0) found.push_back({kind, name, r.to.substr(full.size() + 1)});
      }
    };
    for (const auto& c : spec_.controllers) look("controller", c.name, "/controllers/");
    for (const auto& a : spec_.actuators) look("actuator", a.name, "/actuators/");
    for (const auto& f : spec_.forces) look("force", f.name, "/forces/");
    const auto whole = std::find_if(found.begin(), found.end(), [](const auto& t) { return t.port.empty(); });
    if (whole != found.end()) std::erase_if(found, [](const auto& t) { return !t.port.empty(); });
    if (found.size() == 1) {
      target = found.front();
      return true;
    }
    if (!found.empty()) {
      error(r, "may end at " + found[0].kind + " or " + found[1].kind + " '" + found[0].name + "'",
            "write /controllers/, /actuators/ or /forces/ before the name");
      return false;
    }
    const auto takes_none = [&](const auto& list) {
      return std::any_of(list.begin(), list.end(), [&](const auto& x) { return x.name == r.to; });
    };
    const std::string near = find_nearest(r.to.substr(0, r.to.find(':')), known);
    const bool is_source = takes_none(spec_.sensors) || takes_none(spec_.functions);
    error(r, is_source ? "ends at what has no input" : "ends at nothing",
          near.empty() || is_source ? "name a controller, an actuator, or a force without a type"
                                    : "did you mean '" + near + "'?");
    return false;
  }

  void add(const ConnectRecord& r) {
    Target target;
    if (!find(r, target)) return;
    const SignalUse use{r.from, r.gain, r.at};
    if (target.kind == "controller") return add_to_controller(r, target, use);
    if (!target.port.empty())
      return error(r, "names input '" + target.port + "' of the " + target.kind, "it has one: leave that out");
    const auto function = [&](const auto& f) { return f.name == target.name && !f.function.empty(); };
    if (target.kind == "force" && std::any_of(spec_.forces.begin(), spec_.forces.end(), function))
      return error(r, "ends at a force that has a function", "leave its function out, or connect that");
    auto& list = target.kind == "actuator" ? uses_.actuators : uses_.forces;
    if (!list.emplace(target.name, use).second)
      error(r, "ends where another signal does", "add them up in a controller of type sum");
  }

  void add_to_controller(const ConnectRecord& r, const Target& target, const SignalUse& use) {
    ControllerUses& uses = uses_.controllers[target.name];
    auto* single = target.port == "reference" ? &uses.reference : target.port == "rate" ? &uses.rate : nullptr;
    if (single) {
      if (!single->empty()) return error(r, "ends where another signal does", "keep one of them");
      single->push_back(use);
      return;
    }
    if (target.port.empty()) {
      const auto gap =
          std::find_if(uses.inputs.begin(), uses.inputs.end(), [](const auto& u) { return u.text.empty(); });
      if (gap == uses.inputs.end())
        uses.inputs.push_back(use);
      else
        *gap = use;
      return;
    }
    char* end = nullptr;
    const long number = std::strtol(target.port.c_str(), &end, 10);
    constexpr long kMaxInputs = 1000;
    if (*end != '\0' || number < 1 || number > kMaxInputs)
      return error(r, "names the input '" + target.port + "'", "count its inputs from 1, or name reference or rate");
    const auto index = static_cast<size_t>(number) - 1;
    if (uses.inputs.size() <= index) uses.inputs.resize(index + 1);
    if (!uses.inputs[index].text.empty())
      return error(r, "ends where another signal does", "add them up in a controller of type sum");
    uses.inputs[index] = use;
  }

  const records::SystemSpec& spec_;
  Diagnostics& diagnostics_;
  SignalUses uses_;
};

}  // namespace

SignalUses collect_uses(const records::SystemSpec& spec, Diagnostics& diagnostics) {
  return Collector(spec, diagnostics).collect();
}

}  // namespace bough::solver
