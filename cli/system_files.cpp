#include "system_files.hpp"

#include <filesystem>

#include "formats/hdf5/files.hpp"
#include "formats/toml/specs.hpp"
#include "options.hpp"
#include "start_state.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

std::string resolve_beside(const std::string& from_file, const std::string& path) {
  if (from_file.empty() || fs::path(path).is_absolute()) return path;
  return (fs::path(from_file).parent_path() / path).string();
}

namespace {

/// As seen from here, unless that climbs out of this folder.
std::string shorten(const std::string& path) {
  std::error_code failed;
  const auto near = fs::proximate(path, failed).string();
  return failed || near.rfind("..", 0) == 0 ? path : near;
}

/// What to reduce into the body file that is missing: the body file of the same name beside it, when there is one.
std::string name_reducible(const std::string& file) {
  const auto spec = fs::path(file).replace_extension(".toml");
  return fs::exists(spec) ? spec.string() : "BODY.toml";
}

}  // namespace

LoadedSystem load_system(const std::string& path, Diagnostics& diagnostics, const std::string& start_from) {
  demand_file(path);
  auto spec = toml_files::read_system_spec(path, diagnostics);
  std::map<std::string, records::FlexBody> flex;
  std::map<std::string, std::string> flex_path;
  for (const auto& body : spec.bodies) {
    if (body.file.empty() || flex.count(body.file)) continue;
    const auto file = resolve_beside(path, body.file);
    if (!fs::exists(file)) {
      diagnostics.error("cli.no-body-file", body.at.file.empty() ? SourceLocation{path} : body.at,
                        "body \"" + body.name + "\": there is no file " + shorten(file),
                        "make it with bough reduce " + name_reducible(shorten(file)) + " -o " + shorten(file) +
                            ", or correct the name");
      continue;
    }
    try {
      flex[body.file] = hdf5::read_flex_body(file);
      flex_path[body.file] = file;
    } catch (const InputError& error) {
      for (auto item : error.items()) {
        item.advice += (item.advice.empty() ? "" : "; ") + std::string("named by body \"") + body.name + "\" at " +
                       path + (body.at.line > 0 ? ":" + std::to_string(body.at.line) : "");
        diagnostics.add(std::move(item));
      }
    }
  }
  diagnostics.throw_if_errors();
  if (!start_from.empty()) {
    demand_file(start_from);
    set_start_state(spec, start_from, diagnostics);
    diagnostics.throw_if_errors();
  }
  auto system = solver::System::build(spec, flex, diagnostics);
  diagnostics.throw_if_errors();
  return {std::move(spec), std::move(flex), std::move(flex_path), std::move(system)};
}

}  // namespace bough::cli
