#include "analysis/select/system_selection.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "analysis/common/inputs.hpp"
#include "analysis/select/system_plant.hpp"
#include "formats/records/mode_subset.hpp"
#include "formats/toml/key_editor.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

namespace {

std::string make_list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "[" : ", ") + fmt::format("{}", value);
  return text.empty() ? "[]" : text + "]";
}

/// Sets the keys of a body's table: its file, and the values of its modes.
void set_body_keys(std::string& text, const records::BodyRecord& all, const std::string& file,
                   const std::vector<int>& kept) {
  auto record = all;
  keep_values(record, kept);
  const std::string table = "body." + all.name + ".";
  const auto set = [&](const std::string& key, const std::string& value) {
    const auto wrong = toml_files::set_key(text, table + key, value);
    BOUGH_DEMAND(wrong.empty());
  };
  set("file", toml_files::quote_text(file));
  if (all.eta.size() > 1) set("eta", make_list(record.eta));
  if (all.eta_dot.size() > 1) set("eta_dot", make_list(record.eta_dot));
  if (all.damping_ratios.size() > 1) set("damping", make_list(record.damping_ratios));
  if (all.num_modes >= 0 || kept.empty()) set("modes", std::to_string(kept.size()));
}

std::string read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace

std::vector<int> SystemSelection::list_kept(std::size_t number) const {
  int first = 0;
  for (std::size_t i = 0; i < number; ++i) first += bodies[i].body.num_modes();
  std::vector<int> kept;
  for (const int row : selection.kept)
    if (row >= first && row < first + bodies[number].body.num_modes()) kept.push_back(row - first);
  return kept;
}

SystemSelection select_system_modes(const SelectRequest& request, Events& events) {
  demand_select_numbers(request);
  Diagnostics diagnostics;
  SystemSelection answer{list_system_bodies(request, diagnostics), {}};
  RankedModes modes{request.systems.front(), {}, {}};
  for (std::size_t i = 0; i < answer.bodies.size(); ++i) {
    const auto& [name, file, body] = answer.bodies[i];
    statespace::add_traits(body, static_cast<int>(i), modes.traits);
    for (int mode = 1; mode <= body.num_modes(); ++mode) modes.names.push_back(name + ":" + std::to_string(mode));
  }
  Diagnostics again;  // loading has reported already
  const auto weighings = weigh_in_systems(request, answer.bodies, again);
  for (const auto& message : again.items())
    if (message.id.starts_with("select.")) diagnostics.add(message);
  answer.selection = choose_and_measure(request, modes, weighings, events, diagnostics);
  for (std::size_t i = 0; i < answer.bodies.size(); ++i)
    if (const auto& one = answer.bodies[i]; answer.list_kept(i).size() < static_cast<std::size_t>(one.body.num_modes()))
      warn_of_lost_order(one.body, one.file, diagnostics);
  add_messages(diagnostics, events);
  return answer;
}

SelectedFiles make_selected_files(const SelectRequest& request, const SystemSelection& answer,
                                  const std::string& folder) {
  SelectedFiles files;
  const auto sources = calc_sources(list_select_inputs(request));
  for (std::size_t i = 0; i < answer.bodies.size(); ++i) {
    const auto& one = answer.bodies[i];
    const auto kept = answer.list_kept(i);
    auto small = records::keep_modes(one.body, kept.empty() ? std::vector<int>{0} : kept);
    small.source.insert(small.source.end(), sources.begin(), sources.end());
    files.bodies.push_back({one.name + ".h5", std::move(small)});
  }
  const auto base = fs::absolute(folder).lexically_normal();
  for (const auto& system : request.systems) {
    auto text = read_text(system);
    toml_files::change_file_keys(text, [&](const std::string& path) {
      return fs::relative(fs::absolute(resolve_beside(system, path)), base).generic_string();
    });
    Diagnostics ignored;
    const auto loaded = load_system(system, ignored, {}, request.set);
    for (std::size_t i = 0; i < answer.bodies.size(); ++i)
      for (const auto& record : loaded.spec.bodies)
        if (record.name == answer.bodies[i].name)
          set_body_keys(text, record, files.bodies[i].name, answer.list_kept(i));
    files.systems.push_back({fs::path(system).filename().string(), std::move(text)});
  }
  return files;
}

}  // namespace bough::analysis
