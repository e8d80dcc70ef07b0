#include "analysis/info/info.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "analysis/common/body_files.hpp"
#include "cli/common/console.hpp"
#include "cli/common/event_list.hpp"
#include "cli/common/options.hpp"

namespace bough::cli {

namespace {

struct InfoOptions : CommonOptions {
  std::string file;
};

int run_info(const InfoOptions& o) {
  const Console console(o.quiet, o.verbosity);
  analysis::demand_body_file(o.file);
  if (!o.output.empty()) check_output(o, o.output, {analysis::get_body_path(o.file)});
  const auto [info, events, faults] = analysis::list_contents(o.file);
  if (o.json) {
    auto objects = nlohmann::json::array();
    for (const auto& object : info.objects) {
      objects.push_back({{"path", object.path},
                         {"shape", object.shape},
                         {"type", object.type},
                         {"description", object.description},
                         {"dims", object.dims}});
    }
    auto list = nlohmann::json::array();
    for (const auto& e : events) list.push_back({{"time", e.time}, {"what", e.what}, {"source", e.source}});
    nlohmann::json all{{"attributes", info.attributes}, {"objects", objects}};
    if (!list.empty()) all["events"] = list;
    if (!faults.empty()) all["faults"] = faults;
    write_report(o, console, all.dump(2) + "\n");
    return kSuccess;
  }
  const std::size_t width = get_terminal_width();
  std::string text;
  for (const auto& [name, value] : info.attributes) text += name + ": " + value + "\n";
  text += '\n';
  std::size_t path_width = 0, shape_width = 0;
  for (const auto& object : info.objects) {
    path_width = std::max(path_width, object.path.size());
    shape_width = std::max(shape_width, object.shape.size());
  }
  const auto pad = [](const std::string& s, std::size_t to) { return s + std::string(to - s.size() + 2, ' '); };
  for (const auto& object : info.objects) {
    const std::string about =
        object.description + (object.dims.empty() || object.dims == "1" ? "" : " [" + object.dims + "]");
    std::string line = pad(object.path, path_width) + pad(object.shape, shape_width);
    // On a narrow terminal the description goes on below; elsewhere one object is one line.
    line += width > line.size() + 20 ? wrap(about, line.size(), width) : about;
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  if (!events.empty()) text += "\n" + format_events(events);
  if (!faults.empty()) text += "\nnot as the layout of the format:\n";
  for (const auto& fault : faults) text += "  " + fault + "\n";
  write_report(o, console, text);
  return kSuccess;
}

}  // namespace

void add_info(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_info, "info");
  verb->add_option("file", o->file, "HDF5 file, .FLX or flat body file")->required();
  add_common_options(*verb, *o, kOutput | kJson, "Write the list to this file instead of stdout");
}

}  // namespace bough::cli
