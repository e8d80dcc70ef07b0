#include "analysis/convert/unit_system.hpp"

#include <cmath>
#include <map>
#include <sstream>

#include "base/diagnostic.hpp"

namespace bough::analysis {

namespace {

// Exact by definition: the international foot and pound (1959), standard gravity (CGPM 1901).
constexpr double kPound = 0.45359237, kInch = 0.0254, kGravity = 9.80665;
constexpr double kPoundForce = kPound * kGravity;

const std::map<std::string, double> kLengths{{"m", 1},      {"mm", 1e-3},       {"cm", 1e-2}, {"km", 1e3},
                                             {"in", kInch}, {"ft", 12 * kInch}, {"um", 1e-6}};
const std::map<std::string, double> kMasses{{"kg", 1},
                                            {"g", 1e-3},
                                            {"mg", 1e-6},
                                            {"t", 1e3},
                                            {"tonne", 1e3},
                                            {"lbm", kPound},
                                            {"slug", kPoundForce / (12 * kInch)},
                                            {"slinch", kPoundForce / kInch}};
const std::map<std::string, double> kForces{{"N", 1},    {"mN", 1e-3},         {"kN", 1e3},
                                            {"MN", 1e6}, {"lbf", kPoundForce}, {"kgf", kGravity}};
const std::map<std::string, double> kTimes{{"s", 1}, {"ms", 1e-3}, {"min", 60}, {"h", 3600}};

}  // namespace

nastran::UnitFactors parse_units(const std::string& text) {
  const auto fail = [&](const std::string& why) {
    throw InputError("cli.bad-units", {}, "cannot read the units \"" + text + "\": " + why,
                     "write a length with two of a mass, a force and a time, as mm-N-tonne, m-kg-s or in-lbf-s");
  };
  double length = 0, mass = 0, force = 0, time = 0;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, '-');) {
    bool is_known = false;
    for (const auto& [units, value] : {std::pair{&kLengths, &length}, std::pair{&kMasses, &mass},
                                       std::pair{&kForces, &force}, std::pair{&kTimes, &time}}) {
      const auto found = units->find(word);
      if (found == units->end()) continue;
      if (*value != 0) fail("two units of one kind");
      *value = found->second;
      is_known = true;
    }
    if (!is_known) fail("no unit is called \"" + word + "\"");
  }
  if (length == 0) fail("a length is missing");
  if (mass == 0 && force == 0) fail("a mass or a force is missing");
  if (mass != 0 && force != 0) {
    const double own = std::sqrt(mass * length / force);
    if (time != 0 && std::abs(own / time - 1) > 1e-9) fail("the force is not mass times length over time squared");
    time = time != 0 ? time : own;
  }
  if (time == 0) time = 1;
  if (mass == 0) mass = force * time * time / length;
  return {mass, length, time};
}

UnitNames name_units(const std::string& text) {
  const auto factors = parse_units(text);
  const std::string words = "-" + text + "-";
  const auto choose = [&](const std::map<std::string, double>& units, double size) {
    std::string found;
    for (const auto& [name, value] : units) {
      if (std::abs(value / size - 1) > 1e-9) continue;
      if (words.find("-" + name + "-") != std::string::npos) return name;
      if (found.empty()) found = name;
    }
    return found;
  };
  return {choose(kMasses, factors.mass), choose(kLengths, factors.length), choose(kTimes, factors.time),
          choose(kForces, factors.mass * factors.length / (factors.time * factors.time))};
}

double calc_unit_force(const records::UnitLabels& labels) {
  const auto mass = kMasses.find(labels.mass), length = kLengths.find(labels.length), time = kTimes.find(labels.time),
             force = kForces.find(labels.force);
  if (mass == kMasses.end() || length == kLengths.end() || time == kTimes.end() || force == kForces.end()) return 1;
  return mass->second * length->second / (time->second * time->second) / force->second;
}

std::string name_labelled_set(const records::UnitLabels& labels) {
  if (!kLengths.contains(labels.length) || !kMasses.contains(labels.mass) || !kTimes.contains(labels.time)) return {};
  return std::abs(calc_unit_force(labels) - 1) < 1e-9 ? labels.length + "-" + labels.mass + "-" + labels.time
                                                      : std::string{};
}

void demand_labels(const std::string& text, const records::UnitLabels& labels, const SourceLocation& at) {
  const auto factors = parse_units(text);
  const auto demand = [&](const std::map<std::string, double>& units, const char* key, const std::string& label,
                          double size) {
    const auto found = units.find(label);
    if (found == units.end() || std::abs(found->second / size - 1) < 1e-9) return;
    throw InputError(
        "cli.bad-units", at,
        "the units " + text + " are not those of the file: its [units] has " + key + " = \"" + label + "\"",
        "give the units of the file, or correct its [units]");
  };
  demand(kLengths, "length", labels.length, factors.length);
  demand(kMasses, "mass", labels.mass, factors.mass);
  demand(kTimes, "time", labels.time, factors.time);
  demand(kForces, "force", labels.force, factors.mass * factors.length / (factors.time * factors.time));
}

std::pair<std::string, std::string> split_units(const std::string& text) {
  const auto colon = text.find(':');
  if (colon == std::string::npos || text.find(':', colon + 1) != std::string::npos)
    throw InputError("cli.bad-units", {}, "--units \"" + text + "\" is not FROM:TO", "write --units mm-N-tonne:m-kg-s");
  return {text.substr(0, colon), text.substr(colon + 1)};
}

}  // namespace bough::analysis
