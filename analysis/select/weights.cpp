#include "analysis/select/weights.hpp"

#include <cmath>
#include <cstdlib>

#include "base/diagnostic.hpp"

namespace bough::analysis {

std::vector<Weight> read_weights(const std::vector<std::string>& words, const std::string& file) {
  std::vector<Weight> weights;
  for (const auto& word : words) {
    const auto sign = word.rfind('=');
    const std::string text = sign == std::string::npos ? "" : word.substr(sign + 1);
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(value))
      throw InputError("select.bad-weight", {file}, "--weight " + word + " is not NAME=NUMBER",
                       "write --weight tip:y=10");
    weights.push_back({word.substr(0, sign), value});
  }
  return weights;
}

void fail_weight(const std::string& name, const std::string& file, const std::vector<std::string>& known) {
  const auto near = find_nearest(name, known);
  throw InputError("select.bad-weight", {file}, "--weight: there is no input or output '" + name + "'",
                   near.empty() ? "name one of --inputs and --outputs" : "did you mean '" + near + "'?");
}

}  // namespace bough::analysis
