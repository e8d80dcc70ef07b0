#include "formats/fmu/model_description.hpp"
#include "base/xml_text.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <set>

namespace bough::fmu {
namespace {

std::string number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string attribute(const std::string& name, const std::string& value) {
  return " " + name + "=\"" + escape_xml(value) + "\"";
}

std::string optional_attribute(const std::string& name, const std::string& value) {
  return value.empty() ? "" : attribute(name, value);
}

/// Gives every variable a unique name: one that is in use gets a number.
class Names {
 public:
  std::string get(const std::string& proposed) {
    std::string name = proposed;
    for (int i = 2; !taken_.insert(name).second; ++i) name = proposed + " (" + std::to_string(i) + ")";
    return name;
  }

 private:
  std::set<std::string> taken_;
};

std::string make_experiment(const ModelDescription& m) {
  return "  <DefaultExperiment" + attribute("startTime", number(m.start)) + attribute("stopTime", number(m.stop)) +
         attribute("tolerance", number(m.tolerance)) + (m.step > 0 ? attribute("stepSize", number(m.step)) : "") +
         "/>\n";
}

std::string make_units(const ModelDescription& m) {
  if (m.units.empty()) return "";
  std::string text = "  <UnitDefinitions>\n";
  for (const auto& unit : m.units) {
    text += "    <Unit" + attribute("name", unit.name) + "><BaseUnit";
    const std::pair<const char*, int> powers[] = {{"kg", unit.kg}, {"m", unit.m}, {"s", unit.s}, {"rad", unit.rad}};
    for (const auto& [name, power] : powers)
      if (power != 0) text += attribute(name, std::to_string(power));
    text += (unit.factor != 1 ? attribute("factor", number(unit.factor)) : "") + "/></Unit>\n";
  }
  return text + "  </UnitDefinitions>\n";
}

/// \param get_index  number of a reference in lists of dependencies; nullopt: not among the variables.
template <class GetIndex>
std::string make_dependencies(const Variable& v, const GetIndex& get_index) {
  if (!v.dependencies) return "";
  std::vector<std::uint32_t> indices;
  for (const auto reference : *v.dependencies)
    if (const auto index = get_index(reference)) indices.push_back(*index);
  std::sort(indices.begin(), indices.end());
  std::string list, kinds;
  for (const auto index : indices) list += (list.empty() ? "" : " ") + std::to_string(index);
  for (std::size_t i = 0; v.is_linear && i < indices.size(); ++i) kinds += i == 0 ? "constant" : " constant";
  return attribute("dependencies", list) + optional_attribute("dependenciesKind", kinds);
}

constexpr const char* kLogCategories =
    "  <LogCategories>\n"
    "    <Category name=\"logEvents\" description=\"the event that ends the run\"/>\n"
    "    <Category name=\"logStatusWarning\" description=\"warnings of the system file\"/>\n"
    "    <Category name=\"logStatusDiscard\" description=\"calls that return Discard\"/>\n"
    "    <Category name=\"logStatusError\" description=\"calls that return Error\"/>\n"
    "  </LogCategories>\n";

/// The start tag up to the attributes that FMI 2 and 3 do not share.
std::string begin_description(const ModelDescription& m, const char* version, const char* token_name) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription" + attribute("fmiVersion", version) +
         attribute("modelName", m.model_name) + attribute(token_name, m.token) +
         optional_attribute("description", m.description) + attribute("generationTool", m.tool) +
         attribute("variableNamingConvention", "flat");
}

}  // namespace

std::string make_identifier(const std::string& text) {
  std::string identifier;
  for (const char c : text) identifier += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  if (identifier.empty() || std::isdigit(static_cast<unsigned char>(identifier[0]))) identifier.insert(0, "_");
  return identifier;
}

std::string format_fmi2(const ModelDescription& m) {
  const std::string common = attribute("modelIdentifier", m.identifier) + attribute("canGetAndSetFMUstate", "true") +
                             attribute("canSerializeFMUstate", "true") +
                             attribute("providesDirectionalDerivative", "true");
  std::string text = begin_description(m, "2.0", "guid") +
                     attribute("numberOfEventIndicators", std::to_string(m.event_indicators.size())) + ">\n" +
                     "  <ModelExchange" + common + "/>\n  <CoSimulation" + common +
                     attribute("canHandleVariableCommunicationStepSize", "true") + "/>\n" + make_units(m) +
                     kLogCategories + make_experiment(m) + "  <ModelVariables>\n";
  Names names;
  std::size_t index = 0;
  const auto add = [&](const Variable& v, const std::string& attributes, const std::string& real) {
    text += "    <ScalarVariable" + attribute("name", names.get(v.name)) +
            attribute("valueReference", std::to_string(v.reference)) +
            optional_attribute("description", v.description) + attributes + "><Real" +
            optional_attribute("unit", v.unit) + real + "/></ScalarVariable>\n";
    return ++index;
  };
  const std::string continuous = attribute("variability", "continuous"),
                    calculated = attribute("initial", "calculated");
  for (const auto& v : m.parameters)
    add(v, attribute("causality", "parameter") + attribute("variability", "fixed") + attribute("initial", "exact"),
        attribute("start", number(v.start)));
  for (const auto& v : m.inputs)
    add(v, attribute("causality", "input") + continuous, attribute("start", number(v.start)));
  std::map<std::uint32_t, std::uint32_t> index_of;  // by reference, from 1
  for (const auto* list : {&m.parameters, &m.inputs, &m.outputs, &m.states})
    for (const auto& v : *list) index_of.emplace(v.reference, static_cast<std::uint32_t>(index_of.size()) + 1);
  const auto get_index = [&](std::uint32_t reference) -> std::optional<std::uint32_t> {
    const auto found = index_of.find(reference);
    return found == index_of.end() ? std::nullopt : std::optional(found->second);
  };
  std::string outputs, derivatives, unknowns;
  const auto add_unknown = [](std::string& to, std::size_t of, const std::string& dependencies) {
    to += "      <Unknown" + attribute("index", std::to_string(of)) + dependencies + "/>\n";
  };
  for (const auto& v : m.outputs) {
    const auto at = add(v, attribute("causality", "output") + continuous + calculated, "");
    add_unknown(outputs, at, make_dependencies(v, get_index));
    add_unknown(unknowns, at, "");
  }
  const std::size_t first_state = index + 1;
  for (const auto& v : m.states)
    add_unknown(unknowns, add(v, attribute("causality", "local") + continuous + calculated, ""), "");
  for (std::size_t i = 0; i < m.derivatives.size(); ++i) {
    const auto at = add(m.derivatives[i], attribute("causality", "local") + continuous + calculated,
                        attribute("derivative", std::to_string(first_state + i)));
    add_unknown(derivatives, at, make_dependencies(m.derivatives[i], get_index));
    add_unknown(unknowns, at, "");
  }
  text += "  </ModelVariables>\n  <ModelStructure>\n";
  const auto add_section = [&](const std::string& name, const std::string& lines) {
    if (!lines.empty()) text += "    <" + name + ">\n" + lines + "    </" + name + ">\n";
  };
  add_section("Outputs", outputs);
  add_section("Derivatives", derivatives);
  add_section("InitialUnknowns", unknowns);
  return text + "  </ModelStructure>\n</fmiModelDescription>\n";
}

std::string format_fmi3(const ModelDescription& m) {
  const std::string common = attribute("modelIdentifier", m.identifier) + attribute("canGetAndSetFMUState", "true") +
                             attribute("canSerializeFMUState", "true") +
                             attribute("providesDirectionalDerivatives", "true");
  std::string text = begin_description(m, "3.0", "instantiationToken") + ">\n  <ModelExchange" + common +
                     attribute("needsCompletedIntegratorStep", "true") + "/>\n  <CoSimulation" + common +
                     attribute("canHandleVariableCommunicationStepSize", "true") +
                     attribute("mightReturnEarlyFromDoStep", "true") + attribute("hasEventMode", "true") + "/>\n" +
                     make_units(m) + kLogCategories + make_experiment(m) + "  <ModelVariables>\n";
  Names names;
  const auto add = [&](const Variable& v, const std::string& attributes) {
    text += "    <Float64" + attribute("name", names.get(v.name)) +
            attribute("valueReference", std::to_string(v.reference)) +
            optional_attribute("description", v.description) + attributes + optional_attribute("unit", v.unit) + "/>\n";
  };
  const std::string continuous = attribute("variability", "continuous"),
                    calculated = attribute("initial", "calculated");
  Variable time{"time", "independent variable", kTimeReference, 0};
  time.unit = m.time_unit;
  add(time, attribute("causality", "independent") + continuous);
  for (const auto& v : m.parameters)
    add(v, attribute("causality", "parameter") + attribute("variability", "fixed") + attribute("initial", "exact") +
               attribute("start", number(v.start)));
  for (const auto& v : m.inputs)
    add(v, attribute("causality", "input") + continuous + attribute("start", number(v.start)));
  for (const auto& v : m.outputs) add(v, attribute("causality", "output") + continuous + calculated);
  for (const auto& v : m.states) add(v, attribute("causality", "local") + continuous + calculated);
  for (std::size_t i = 0; i < m.derivatives.size(); ++i)
    add(m.derivatives[i], attribute("causality", "local") + continuous + calculated +
                              attribute("derivative", std::to_string(m.states[i].reference)));
  for (const auto& v : m.event_indicators) add(v, attribute("causality", "local") + continuous + calculated);
  text += "  </ModelVariables>\n  <ModelStructure>\n";
  const auto list = [&](const char* name, const std::vector<Variable>& variables, bool has_dependencies) {
    const auto get_index = [](std::uint32_t reference) { return std::optional(reference); };
    for (const auto& v : variables)
      text += std::string("    <") + name + attribute("valueReference", std::to_string(v.reference)) +
              (has_dependencies ? make_dependencies(v, get_index) : "") + "/>\n";
  };
  list("Output", m.outputs, true);
  list("ContinuousStateDerivative", m.derivatives, true);
  for (const auto* variables : {&m.outputs, &m.states, &m.derivatives}) list("InitialUnknown", *variables, false);
  list("EventIndicator", m.event_indicators, true);
  return text + "  </ModelStructure>\n</fmiModelDescription>\n";
}

}  // namespace bough::fmu
