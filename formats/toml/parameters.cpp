#include "formats/toml/detail/parameters.hpp"

#include <algorithm>
#include <set>

namespace bough::toml_files {
namespace {

class Inserter {
 public:
  Inserter(const Value& parameters, const std::string& file, Diagnostics& diagnostics)
      : parameters_(parameters), file_(file), diagnostics_(diagnostics) {
    for (const auto& entry : parameters.entries) names_.push_back(entry.key);
  }

  void visit(Value& v, int line) {
    if (v.line > 0) line = v.line;
    for (Value& item : v.items) visit(item, line);
    for (Entry& entry : v.entries) visit(entry.value, entry.line);
    if (!v.is_string() || v.text.size() < 2 || v.text[0] != '$') return;
    const std::string name = v.text.substr(1);
    if (const Value* number = parameters_.find(name)) {
      used_.insert(name);
      if (!number->is_number()) return;  // reported by the schema
      v = *number;
      v.line = line;
      return;
    }
    const std::string near = find_nearest(name, names_);
    diagnostics_.error("toml.unknown-parameter", {file_, line},
                       "\"" + v.text + "\" names a parameter that [parameters] does not contain",
                       near.empty() ? "add " + name + " = NUMBER to [parameters]" : "did you mean \"$" + near + "\"?");
  }

  void report_unused() {
    for (const auto& entry : parameters_.entries) {
      if (used_.count(entry.key)) continue;
      diagnostics_.warning("toml.unused-parameter", {file_, entry.line},
                           "no number of the file is \"$" + entry.key + "\"", "write it where the parameter belongs");
    }
  }

 private:
  const Value& parameters_;
  const std::string& file_;
  Diagnostics& diagnostics_;
  std::vector<std::string> names_;
  std::set<std::string> used_;
};

}  // namespace

void insert_parameters(Value& root, const std::string& file, Diagnostics& diagnostics) {
  static const Value none;
  const Value* found = root.find("parameters");
  const Value parameters = found && found->is_table() ? *found : none;
  Inserter inserter(parameters, file, diagnostics);
  for (Entry& entry : root.entries) {
    if (entry.key != "parameters") inserter.visit(entry.value, entry.line);
  }
  inserter.report_unused();
}

}  // namespace bough::toml_files
