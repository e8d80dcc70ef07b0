#include "analysis/common/spec_functions.hpp"

#include <algorithm>
#include <cmath>

namespace bough::analysis {

const solver::TimeFunction* SpecFunctions::find(const std::string& name) {
  if (const auto made = made_.find(name); made != made_.end()) return made->second;
  made_[name] = nullptr;  // of itself: a loop, which no run has
  for (const auto& record : spec_.functions) {
    if (record.name != name) continue;
    for (const auto& other : record.of) find(other);
    Diagnostics unused;
    const auto& run = spec_.simulation;
    kept_.push_back(solver::make_time_function(record, unused, {run.start, run.start + run.duration}, made_));
    return made_[name] = kept_.back().get();
  }
  return nullptr;
}

std::vector<FunctionCurve> list_function_curves(const records::SystemSpec& spec) {
  constexpr int kPoints = 400;
  SpecFunctions functions(spec);
  std::vector<FunctionCurve> curves;
  for (const auto& record : spec.functions) {
    const auto* function = functions.find(record.name);
    if (function == nullptr) continue;
    FunctionCurve curve{record.name, record.type, true, {}, {}};
    double low = spec.simulation.start, high = low + spec.simulation.duration;
    if (record.x.size() > 1 && record.type == "table") {
      const double margin = 0.1 * (record.x.back() - record.x.front());
      low = record.x.front() - margin, high = record.x.back() + margin;
      curve.is_of_time = false;
    }
    if (!(high > low)) high = low + 1;
    std::vector<double> x;
    for (int i = 0; i <= kPoints; ++i) x.push_back(low + (high - low) * i / kPoints);
    for (const double t : function->mesh_times())
      if (t > low && t < high) x.push_back(t);
    for (const double t : function->jump_times())
      if (t > low && t < high) x.insert(x.end(), {std::nextafter(t, low), t});
    for (const double t : record.x)
      if (!curve.is_of_time) x.push_back(t);
    std::sort(x.begin(), x.end());
    x.erase(std::unique(x.begin(), x.end()), x.end());
    curve.x = Eigen::Map<Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
    curve.y = curve.x.unaryExpr([&](double t) { return function->calc(t).f; });
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace bough::analysis
