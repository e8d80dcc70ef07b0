#include "analysis/select/system_plant.hpp"

#include "analysis/common/body_files.hpp"
#include "analysis/linearize/operating_point.hpp"
#include "formats/records/mode_subset.hpp"
#include "solver/builder/build_system.hpp"
#include "solver/linear/linearize.hpp"

namespace bough::analysis {

namespace {

/// Keeps the values of the retained modes, of one value per mode.
void keep_values(std::vector<double>& values, const std::vector<int>& kept) {
  if (values.size() <= 1) return;
  std::vector<double> some;
  for (const int mode : kept) some.push_back(values[static_cast<std::size_t>(mode)]);
  values = std::move(some);
}

}  // namespace

SystemPlant::SystemPlant(const std::string& system, const std::string& body, OperatingChoice choice,
                         Diagnostics& diagnostics)
    : file_(system), choice_(std::move(choice)), loaded_(load_system(system, diagnostics, {}, choice_.set)) {
  for (const auto& record : loaded_.spec.bodies) {
    if (loaded_.flex_path.count(record.file) == 0 || !is_same_body(resolve_beside(system, record.file), body)) continue;
    users_.push_back(record.name);
    key_ = record.file;
  }
  if (users_.empty())
    throw InputError("select.body-not-in-system", {system}, "no body of the system has the file " + body,
                     "name the body file that the system uses");
}

records::LinearModel SystemPlant::linearize(const LoadedSystem& loaded, Diagnostics& diagnostics) const {
  auto plant = make_plant(loaded, choice_.open);
  if (const auto sampled = plant.list_sampled(); !choice_.open && !sampled.empty())
    throw InputError("select.sampled", {file_},
                     "the loops are sampled (" + sampled.front() +
                         "), and costs are of continuous models: the modes would be ranked with these loops open",
                     "replace the sampled blocks by continuous ones, or rank without controllers (--open)");
  auto point = choice_.at ? run_to(loaded, plant, *choice_.at, diagnostics) : plant.make_initial_point();
  if (choice_.equilibrium) point = find_rest(plant, std::move(point), file_);
  plant.hold_commands(point);
  return solver::linearize(plant, point, {choice_.inputs, choice_.outputs, false, {}}, {file_}, diagnostics);
}

records::LinearModel SystemPlant::linearize(Diagnostics& diagnostics) const { return linearize(loaded_, diagnostics); }

records::LinearModel SystemPlant::linearize_with(const std::vector<int>& kept) const {
  auto spec = loaded_.spec;
  auto flex = loaded_.flex;
  const int num_modes = flex.at(key_).num_modes();
  for (auto& body : spec.bodies) {
    if (body.file != key_) continue;
    const int num_used = body.num_modes < 0 ? num_modes : body.num_modes;
    std::vector<int> used;
    for (const int mode : kept)
      if (mode < num_used) used.push_back(mode);
    for (auto* values : {&body.eta, &body.eta_dot, &body.damping_ratios}) keep_values(*values, used);
    body.num_modes = static_cast<int>(used.size());
  }
  flex[key_] = records::keep_modes(flex.at(key_), kept);
  Diagnostics ignored;
  auto system = solver::build_system(spec, flex, ignored);
  return linearize({std::move(spec), std::move(flex), loaded_.flex_path, std::move(system), {}}, ignored);
}

}  // namespace bough::analysis
