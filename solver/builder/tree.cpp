#include <set>

#include "solver/builder/build.hpp"
#include "solver/text/names.hpp"

namespace bough::solver {

namespace {
template <class Records>
void check_names(const Records& records, const char* kind, Diagnostics& diagnostics) {
  std::set<std::string> seen;
  for (const auto& r : records) {
    if (!seen.insert(r.name).second) {
      diagnostics.error("system.duplicate-name", r.at, std::string("two ") + kind + " have the name " + quote(r.name));
    }
  }
}

// "a - b - a": the bodies met on the way up from `start` until one repeats.
std::string describe_cycle(const records::SystemSpec& spec, const std::map<std::string, int>& inboard,
                           const std::string& start) {
  std::set<std::string> met;
  std::string chain = start, at = start;
  while (met.insert(at).second) {
    at = spec.hinges[static_cast<size_t>(inboard.at(at))].parent;
    chain += " - " + at;
    if (!inboard.count(at)) break;
  }
  return chain;
}
}  // namespace

TreeOrder order_tree(const records::SystemSpec& spec, Diagnostics& diagnostics) {
  TreeOrder order;
  std::vector<std::string> names;
  std::map<std::string, int> spec_index;
  for (const auto& body : spec.bodies) {
    names.push_back(body.name);
    spec_index.emplace(body.name, static_cast<int>(spec_index.size()));
    if (body.name == "ground") {
      diagnostics.error("system.duplicate-name", body.at, "a body has the name 'ground', which is the inertial body");
    }
  }
  check_names(spec.bodies, "bodies", diagnostics);
  check_names(spec.hinges, "hinges", diagnostics);
  check_names(spec.functions, "functions", diagnostics);
  check_names(spec.forces, "forces", diagnostics);
  check_names(spec.constraints, "constraints", diagnostics);

  std::map<std::string, int> inboard;  // body name -> hinge
  for (int h = 0; h < static_cast<int>(spec.hinges.size()); ++h) {
    const auto& hinge = spec.hinges[static_cast<size_t>(h)];
    bool known = true;
    for (const std::string* name : {&hinge.parent, &hinge.child}) {
      if (spec_index.count(*name) || (name == &hinge.parent && *name == "ground")) continue;
      known = false;
      if (*name == "ground") {
        diagnostics.error("system.ground-child", hinge.at, "hinge " + quote(hinge.name) + " has ground as its child",
                          "exchange parent and child");
        continue;
      }
      diagnostics.error("system.unknown-body", hinge.at,
                        "hinge " + quote(hinge.name) + " names body " + quote(*name) + ", which does not exist",
                        suggest_name(*name, names, "declare it"));
    }
    if (!known) continue;
    const auto [found, inserted] = inboard.emplace(hinge.child, h);
    if (!inserted) {
      const auto& first = spec.hinges[static_cast<size_t>(found->second)];
      diagnostics.error("system.loop", hinge.at,
                        "hinge " + quote(hinge.name) + " closes a loop: body " + quote(hinge.child) +
                            " is already attached to hinge " + quote(first.name) + " (" + first.parent + " - " +
                            hinge.child + " - " + hinge.parent + ")",
                        "a body is attached to one hinge: write one of the two as a [[constraint]]");
    }
  }
  std::set<std::string> placed = {"ground"};
  for (bool progress = true; progress;) {
    progress = false;
    for (int b = 0; b < static_cast<int>(spec.bodies.size()); ++b) {
      const std::string& name = spec.bodies[static_cast<size_t>(b)].name;
      if (placed.count(name)) continue;
      const auto hinge = inboard.find(name);
      if (hinge != inboard.end() && !placed.count(spec.hinges[static_cast<size_t>(hinge->second)].parent)) continue;
      order.tree_index.emplace(name, static_cast<int>(order.body.size()));
      order.body.push_back(b);
      order.hinge.push_back(hinge == inboard.end() ? -1 : hinge->second);
      placed.insert(name);
      progress = true;
    }
  }
  for (const auto& body : spec.bodies) {
    if (placed.count(body.name)) continue;
    const auto& hinge = spec.hinges[static_cast<size_t>(inboard.at(body.name))];
    diagnostics.error("system.loop", hinge.at,
                      "body " + quote(body.name) + " is part of a loop: " + describe_cycle(spec, inboard, body.name),
                      "one of them needs a hinge to ground, or none; what closes the loop is a [[constraint]]");
    break;
  }
  return order;
}

}  // namespace bough::solver
