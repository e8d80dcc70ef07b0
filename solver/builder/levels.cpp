#include "solver/builder/levels.hpp"

#include <algorithm>

#include "solver/builder/build.hpp"
#include "solver/text/names.hpp"

namespace bough::solver {
namespace {

constexpr int kMaxVariants = 256;
constexpr double kSamePlace = 1e-6;  // of the size of the body

class VariantBuilder {
 public:
  VariantBuilder(const records::SystemSpec& spec, const FlexMap& flex, System& system, Diagnostics& diagnostics)
      : spec_(spec), flex_(flex), system_(system), diagnostics_(diagnostics) {}

  void build() {
    int count = 1;
    system_.num_levels.assign(static_cast<size_t>(system_.num_bodies()), 1);
    for (int b = 0; b < system_.num_bodies(); ++b) {
      const auto& r = get_record(b);
      if (r.levels.empty()) continue;
      check_start(r);
      system_.num_levels[static_cast<size_t>(b)] = static_cast<int>(r.levels.size());
      count *= static_cast<int>(r.levels.size());
      if (count > kMaxVariants)
        return refuse(r,
                      "has levels that with those of other bodies are more than " + std::to_string(kMaxVariants) +
                          " combinations",
                      "give fewer levels");
    }
    check_controllers();
    if (diagnostics_.num_errors() > 0) return;
    const int errors = diagnostics_.num_errors();
    system_.variant = find_start();
    system_.variants.resize(static_cast<size_t>(count));
    for (int k = 0; k < count && diagnostics_.num_errors() == errors; ++k)
      if (k != system_.variant) system_.variants[static_cast<size_t>(k)] = build_one(k);
  }

 private:
  const records::BodyRecord& get_record(int b) const {
    const auto is_it = [&](const records::BodyRecord& r) { return r.name == system_.body_name(b); };
    return *std::find_if(spec_.bodies.begin(), spec_.bodies.end(), is_it);
  }
  void refuse(const records::BodyRecord& r, const std::string& message, const std::string& advice) {
    diagnostics_.error("system.bad-levels", r.at, "body " + quote(r.name) + " " + message, advice);
  }

  void check_start(const records::BodyRecord& r) {
    if (system_.is_lagged) refuse(r, "has levels, and its stiffening is lagged", "take stiffening = \"consistent\"");
    if (std::find(r.levels.begin(), r.levels.end(), r.file) == r.levels.end())
      return refuse(r, "has levels without its file " + quote(r.file), "list the files of all levels");
    const auto& start = flex_.at(r.file);
    for (const auto& file : r.levels) {
      const auto found = flex_.find(file);
      if (found != flex_.end()) check_level(r, start, file, found->second);
    }
  }

  /// Equal modes, and common nodes at equal places of the body frame.
  void check_level(const records::BodyRecord& r, const records::FlexBody& start, const std::string& file,
                   const records::FlexBody& level) {
    const int modes = r.num_modes < 0 ? start.num_modes() : std::min(r.num_modes, start.num_modes());
    if (modes != (r.num_modes < 0 ? level.num_modes() : std::min(r.num_modes, level.num_modes())))
      return refuse(r,
                    "has levels of " + std::to_string(start.num_modes()) + " and " + std::to_string(level.num_modes()) +
                        " modes: " + quote(r.file) + ", " + quote(file),
                    "give modes, the number that all levels have");
    const double size = start.node_xyz.rowwise().norm().maxCoeff();
    int common = 0;
    for (size_t i = 0; i < start.node_id.size(); ++i) {
      const auto other = std::find(level.node_id.begin(), level.node_id.end(), start.node_id[i]);
      if (other == level.node_id.end()) continue;
      ++common;
      const auto row = other - level.node_id.begin();
      if ((level.node_xyz.row(row) - start.node_xyz.row(static_cast<Eigen::Index>(i))).norm() <= kSamePlace * size)
        continue;
      return refuse(r,
                    "has levels in which node " + std::to_string(start.node_id[i]) +
                        " is at different places: " + quote(r.file) + ", " + quote(file),
                    "reduce all levels with one origin and axes, of one structure");
    }
    if (common == 0)
      refuse(r, "has levels without a common node: " + quote(r.file) + ", " + quote(file),
             "reduce all levels with the same interface and output nodes");
  }

  void check_controllers() {
    for (const auto& controller : spec_.controllers)
      if (controller.type == "library" || controller.type == "fmu")
        diagnostics_.error("system.bad-levels", controller.at,
                           "controller " + quote(controller.name) + " of type " + controller.type +
                               " keeps states that no switch of fill levels carries over",
                           "take another type of controller, or bodies without levels");
  }

  int find_start() const {
    int k = 0;
    for (int b = system_.num_bodies() - 1; b >= 0; --b) {
      const auto& levels = get_record(b).levels;
      const auto level = std::find(levels.begin(), levels.end(), get_record(b).file) - levels.begin();
      k = k * system_.num_levels[static_cast<size_t>(b)] + (levels.empty() ? 0 : static_cast<int>(level));
    }
    return k;
  }

  std::shared_ptr<const System> build_one(int k) {
    auto spec = spec_;
    std::string files;
    const records::BodyRecord* at = nullptr;
    for (int b = 0; b < system_.num_bodies(); ++b) {
      const auto& r = get_record(b);
      if (r.levels.empty()) continue;
      const auto& file = r.levels[static_cast<size_t>(system_.get_level(k, b))];
      for (auto& body : spec.bodies) {
        if (body.name != r.name) continue;
        body.file = file;
        body.levels.clear();
      }
      at = &r;
      files += (files.empty() ? "" : ", ") + quote(file);
    }
    Diagnostics found;
    const std::shared_ptr<System> variant(new System(draft_system(spec, flex_, found)));  // not moved: errors
    for (const auto& item : found.items())
      if (item.severity == Severity::Error) refuse(*at, "at the levels " + files + ": " + item.what, item.advice);
    if (found.num_errors() > 0) return nullptr;
    variant->num_levels = system_.num_levels;
    variant->variant = k;
    if (variant->num_z() != system_.num_z() || variant->signals.num_memory != system_.signals.num_memory ||
        variant->tree.num_q != system_.tree.num_q || variant->tree.num_u != system_.tree.num_u)
      refuse(*at, "at the levels " + files + " has other states than at the start", "reduce all levels alike");
    return variant;
  }

  const records::SystemSpec& spec_;
  const FlexMap& flex_;
  System& system_;
  Diagnostics& diagnostics_;
};

}  // namespace

void build_variants(const records::SystemSpec& spec, const FlexMap& flex, System& system, Diagnostics& diagnostics) {
  VariantBuilder(spec, flex, system, diagnostics).build();
}

}  // namespace bough::solver
