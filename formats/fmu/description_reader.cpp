#include "formats/fmu/description_reader.hpp"

#include <pugixml.hpp>

#include <cstdlib>
#include <cstring>
#include <map>
#include <set>
#include <sstream>

#include "base/diagnostic.hpp"

namespace bough::fmu {
namespace {

constexpr int kMaxSize = 1000000;  // values of one array

bool is_true(const pugi::xml_node& node, const char* attribute) {
  const std::string value = node.attribute(attribute).value();
  return value == "true" || value == "1";
}

ValueType find_type(const std::string& element, int version) {
  static const std::map<std::string, ValueType> of_2{{"Real", ValueType::Float64},
                                                     {"Integer", ValueType::Int32},
                                                     {"Enumeration", ValueType::Int32},
                                                     {"Boolean", ValueType::Boolean},
                                                     {"String", ValueType::String}};
  static const std::map<std::string, ValueType> of_3{
      {"Float64", ValueType::Float64}, {"Float32", ValueType::Float32},   {"Int8", ValueType::Int8},
      {"UInt8", ValueType::UInt8},     {"Int16", ValueType::Int16},       {"UInt16", ValueType::UInt16},
      {"Int32", ValueType::Int32},     {"UInt32", ValueType::UInt32},     {"Int64", ValueType::Int64},
      {"UInt64", ValueType::UInt64},   {"Enumeration", ValueType::Int64}, {"Boolean", ValueType::Boolean},
      {"String", ValueType::String}};
  const auto& types = version == 2 ? of_2 : of_3;
  const auto found = types.find(element);
  return found == types.end() ? ValueType::Other : found->second;
}

/// Sets dimensions and size; the size is 0 where another variable gives a dimension.
void set_size(const pugi::xml_node& node, ForeignVariable& v) {
  long long size = 1;
  for (const auto& dimension : node.children("Dimension")) {
    const long long n = dimension.attribute("start").as_llong(0);
    if (n <= 0 || n > kMaxSize || (size *= n) > kMaxSize) {
      v.size = 0;
      return;
    }
    v.dimensions.push_back(static_cast<int>(n));
  }
  v.size = static_cast<int>(size);
}

/// Sets the start values; one number is that of every element. They stay empty if a word is no number.
void set_start(const pugi::xml_node& node, ForeignVariable& v) {
  std::istringstream words(node.attribute("start").value());
  for (std::string word; words >> word;) {
    char* end = nullptr;
    const double number = word == "true" ? 1 : word == "false" ? 0 : std::strtod(word.c_str(), &end);
    if (end != nullptr && *end != '\0') return v.start.clear();
    v.start.push_back(number);
  }
  if (v.start.size() == 1) v.start.resize(static_cast<std::size_t>(v.size), v.start.front());
  if (v.start.size() != static_cast<std::size_t>(v.size)) v.start.clear();
}

}  // namespace

ForeignModel read_model_description(const std::string& text, const std::string& path) {
  const auto fail = [&](const std::string& what) {
    return InputError("fmu.bad-description", {path}, "modelDescription.xml of the FMU " + what, "export the FMU again");
  };
  pugi::xml_document document;
  if (const auto result = document.load_buffer(text.data(), text.size()); !result)
    throw fail("is no XML: " + std::string(result.description()) + " at byte " + std::to_string(result.offset));
  const pugi::xml_node root = document.child("fmiModelDescription");
  if (!root) throw fail("has no element fmiModelDescription");
  const std::string version = root.attribute("fmiVersion").value();
  ForeignModel model;
  model.version = version == "2.0" ? 2 : version.starts_with("3.") ? 3 : 0;
  if (model.version == 0)
    throw InputError("fmu.version", {path}, "the FMU is of FMI version '" + version + "', expected 2.0 or 3.0",
                     "export it for one of these");
  const pugi::xml_node kind = root.child("CoSimulation");
  if (!kind)
    throw InputError("fmu.no-cosimulation", {path}, "the FMU has no Co-Simulation",
                     "export it for Co-Simulation: a controller advances by its own sample time");
  const char* state = model.version == 2 ? "state" : "State";
  model.model_name = root.attribute("modelName").value();
  model.token = root.attribute(model.version == 2 ? "guid" : "instantiationToken").value();
  model.identifier = kind.attribute("modelIdentifier").value();
  model.needs_tool = is_true(kind, "needsExecutionTool");
  model.can_save_state = is_true(kind, (std::string("canGetAndSetFMU") + state).c_str()) &&
                         is_true(kind, (std::string("canSerializeFMU") + state).c_str());
  model.default_step = root.child("DefaultExperiment").attribute("stepSize").as_double(0);
  if (!(model.default_step >= 0)) model.default_step = 0;
  if (model.identifier.empty() || model.identifier.find('/') != std::string::npos)
    throw fail("has the modelIdentifier '" + model.identifier + "'");
  std::set<std::string> names;
  for (const pugi::xml_node& node : root.child("ModelVariables")) {
    if (node.type() != pugi::node_element) continue;
    ForeignVariable v;
    v.name = node.attribute("name").value();
    v.causality = node.attribute("causality").as_string("local");
    if (!node.attribute("valueReference")) throw fail("has the variable '" + v.name + "' without valueReference");
    v.reference = node.attribute("valueReference").as_uint();
    pugi::xml_node typed = node;
    if (model.version == 2) {
      typed = node.first_child();
      while (typed && (typed.type() != pugi::node_element || std::strcmp(typed.name(), "Annotations") == 0))
        typed = typed.next_sibling();
    } else {
      set_size(node, v);
      for (const auto& alias : node.children("Alias")) v.aliases.emplace_back(alias.attribute("name").value());
    }
    v.type = find_type(typed.name(), model.version);
    set_start(typed, v);
    std::vector<std::string> own = v.aliases;
    own.push_back(v.name);
    for (const auto& name : own)
      if (name.empty() || !names.insert(name).second) throw fail("has two variables named '" + name + "'");
    model.variables.push_back(std::move(v));
  }
  return model;
}

}  // namespace bough::fmu
