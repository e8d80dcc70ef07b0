#include "analysis/select/system_plant.hpp"

#include <algorithm>

#include "analysis/common/body_files.hpp"
#include "analysis/linearize/operating_point.hpp"
#include "formats/records/mode_subset.hpp"
#include "solver/builder/build_system.hpp"
#include "solver/linear/linearize.hpp"

namespace bough::analysis {

namespace {

void keep_some(std::vector<double>& values, const std::vector<int>& kept) {
  if (values.size() <= 1) return;
  std::vector<double> some;
  for (const int mode : kept) some.push_back(values[static_cast<std::size_t>(mode)]);
  values = std::move(some);
}

}  // namespace

void keep_values(records::BodyRecord& body, const std::vector<int>& kept) {
  for (auto* values : {&body.eta, &body.eta_dot, &body.damping_ratios}) keep_some(*values, kept);
  body.num_modes = static_cast<int>(kept.size());
}

void demand_one_level(const records::BodyRecord& body, const std::string& system) {
  if (body.levels.empty()) return;
  throw InputError(
      "select.levels", body.at.file.empty() ? SourceLocation{system} : body.at,
      "body '" + body.name + "' has fill levels: their modes differ, and one choice of modes is not the same in all",
      "set modes = N of the body, which keeps the lowest of every level, or rank the modes of one level in "
      "a copy of the system without levels");
}

SystemPlant::SystemPlant(const std::string& system, OperatingChoice choice, Diagnostics& diagnostics)
    : file_(system), choice_(std::move(choice)), loaded_(load_system(system, diagnostics, {}, choice_.set)) {}

std::vector<std::vector<BodyMode>> SystemPlant::list_uses(const std::string& body_file) const {
  std::vector<std::vector<BodyMode>> uses;
  for (const auto& record : loaded_.spec.bodies) {
    const auto found = loaded_.flex.find(record.file);
    const auto is_it = [&](const std::string& file) { return is_same_body(resolve_beside(file_, file), body_file); };
    if (std::any_of(record.levels.begin(), record.levels.end(), is_it)) demand_one_level(record, file_);
    if (found == loaded_.flex.end() || !is_it(record.file)) continue;
    uses.resize(static_cast<std::size_t>(found->second.num_modes()));
    const int num_used = record.num_modes < 0 ? found->second.num_modes() : record.num_modes;
    for (int mode = 0; mode < num_used; ++mode) uses[static_cast<std::size_t>(mode)].push_back({record.name, mode});
  }
  if (uses.empty())
    throw InputError("select.body-not-in-system", {file_}, "no body of the system has the file " + body_file,
                     "name the body file that the system uses");
  return uses;
}

records::LinearModel SystemPlant::linearize(const LoadedSystem& loaded, Diagnostics& diagnostics) const {
  auto plant = make_plant(loaded, choice_.open);
  if (const auto sampled = plant->list_sampled(); !choice_.open && !sampled.empty())
    throw InputError("select.sampled", {file_},
                     "the loops are sampled (" + sampled.front() +
                         "), and costs are of continuous models: the modes would be ranked with these loops open",
                     "replace the sampled blocks by continuous ones, or rank without controllers (--open)");
  auto point = choice_.at ? run_to(loaded, plant, *choice_.at, diagnostics) : plant->make_initial_point();
  if (choice_.equilibrium) point = find_rest(*plant, std::move(point), file_);
  plant->hold_commands(point);
  return solver::linearize(*plant, point, {choice_.inputs, choice_.outputs, false, {}}, {file_}, diagnostics);
}

records::LinearModel SystemPlant::linearize(Diagnostics& diagnostics) const { return linearize(loaded_, diagnostics); }

records::LinearModel SystemPlant::linearize_with(const std::vector<BodyMode>& all,
                                                 const std::vector<BodyMode>& kept) const {
  auto spec = loaded_.spec;
  auto flex = loaded_.flex;
  for (auto& body : spec.bodies) {
    const auto is_of_body = [&](const BodyMode& one) { return one.body == body.name; };
    if (std::none_of(all.begin(), all.end(), is_of_body)) continue;
    std::vector<int> modes;
    for (const auto& one : kept)
      if (is_of_body(one)) modes.push_back(one.mode);
    std::sort(modes.begin(), modes.end());
    const auto& whole = loaded_.flex.at(body.file);
    body.file += '|' + body.name;  // bodies of one file keep different modes
    flex[body.file] = records::keep_modes(whole, modes.empty() ? std::vector<int>{0} : modes);
    keep_values(body, modes);
  }
  Diagnostics ignored;
  auto system = solver::build_system(spec, flex, ignored);
  return linearize({std::move(spec), std::move(flex), loaded_.flex_path, std::move(system), {}}, ignored);
}

}  // namespace bough::analysis
