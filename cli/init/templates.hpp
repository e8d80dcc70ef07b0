#pragma once
/// \file The examples of data/examples, compiled in (templates.cmake writes the source).
#include <string>
#include <vector>

namespace bough::cli {

struct TemplateFile {
  const char* name;
  const char* text;
};
struct Template {
  const char* name;    ///< as `init` knows it: spinup, hub, ...
  const char* folder;  ///< in data/examples
  std::vector<TemplateFile> files;
};
/// Returns all examples that `init` offers.
const std::vector<Template>& get_templates();

}  // namespace bough::cli
