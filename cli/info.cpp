#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "bough/formats/hdf5/files.hpp"
#include "console.hpp"
#include "options.hpp"

namespace bough::cli {

namespace {

struct InfoOptions : CommonOptions {
  std::string file;
};

int run_info(const InfoOptions& o) {
  const Console console(false, o.verbosity);
  demand_file(o.file);
  const auto info = hdf5::read_info(o.file);
  if (o.json) {
    auto objects = nlohmann::json::array();
    for (const auto& object : info.objects) {
      objects.push_back({{"path", object.path},
                         {"shape", object.shape},
                         {"type", object.type},
                         {"description", object.description},
                         {"dims", object.dims}});
    }
    console.print_data(nlohmann::json{{"attributes", info.attributes}, {"objects", objects}}.dump(2) + "\n");
    return kSuccess;
  }
  std::string text;
  for (const auto& [name, value] : info.attributes) text += name + ": " + value + "\n";
  text += '\n';
  std::size_t path_width = 0, shape_width = 0, dims_width = 0;
  for (const auto& object : info.objects) {
    path_width = std::max(path_width, object.path.size());
    shape_width = std::max(shape_width, object.shape.size());
    dims_width = std::max(dims_width, object.dims.size());
  }
  const auto pad = [](const std::string& s, std::size_t width) { return s + std::string(width - s.size() + 2, ' '); };
  for (const auto& object : info.objects) {
    std::string line = pad(object.path, path_width) + pad(object.shape, shape_width) + pad(object.dims, dims_width) +
                       object.description;
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  console.print_data(text);
  return kSuccess;
}

}  // namespace

void add_info(CLI::App& app, Action& action) {
  auto o = std::make_shared<InfoOptions>();
  auto* verb = app.add_subcommand("info", "What an HDF5 file of Bough holds");
  verb->add_option("file", o->file, "HDF5 file")->required();
  add_common_options(*verb, *o, kJson);
  verb->footer("Example:\n  bough info boom.h5");
  verb->callback([&action, o] { action = [o] { return run_info(*o); }; });
}

}  // namespace bough::cli
