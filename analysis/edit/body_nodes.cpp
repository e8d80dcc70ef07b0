#include "analysis/edit/body_nodes.hpp"

#include <filesystem>
#include <regex>

#include "analysis/common/body_files.hpp"
#include "base/diagnostic.hpp"
#include "formats/toml/system_editor.hpp"

namespace bough::analysis {

std::vector<std::string> list_body_nodes(const std::string& text, const std::string& system_file,
                                         const std::string& body) {
  std::vector<std::string> ids{"0"};
  for (const auto& item : toml_files::list_items(text)) {
    if (item.kind != "body" || item.name != body) continue;
    const auto own = toml_files::get_value_text(text, item.path() + ".nodes");
    static const std::regex id("\\bid\\s*=\\s*([0-9]+)");
    for (std::sregex_iterator at(own.begin(), own.end(), id), end; at != end; ++at) ids.push_back((*at)[1]);
    auto file = toml_files::get_value_text(text, item.path() + ".file");
    if (file.size() < 3) return ids;
    file = file.substr(1, file.size() - 2);
    try {
      Diagnostics quiet;
      const auto flexible = read_body((std::filesystem::path(system_file).parent_path() / file).string(), quiet);
      for (const int node : flexible.node_id) ids.push_back(std::to_string(node));
    } catch (const Failure&) {  // not reduced yet, or damaged: `check` says so
      if (ids.size() == 1) return {};
    }
    return ids;
  }
  return {};
}

}  // namespace bough::analysis
