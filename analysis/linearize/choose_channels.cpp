#include "analysis/linearize/choose_channels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/diagnostic.hpp"
#include "solver/statespace/hankel.hpp"

namespace bough::analysis {

using records::LinearModel;

LinearModel choose_channels(LinearModel model, const std::vector<std::string>& inputs,
                            const std::vector<std::string>& outputs, const std::string& file) {
  Diagnostics diagnostics;
  const auto choose = [&](const std::vector<std::string>& requested, const records::Signals& known, const char* noun,
                          const char* id) {
    std::vector<int> chosen;
    for (int i = 0; requested.empty() && i < known.size(); ++i) chosen.push_back(i);
    for (const auto& name : requested) {
      const auto size = chosen.size();
      for (int i = 0; i < known.size(); ++i) {
        const auto& one = known.name[static_cast<std::size_t>(i)];
        if (one == name || one.starts_with(name + ":")) chosen.push_back(i);
      }
      if (chosen.size() > size) continue;
      const auto near = find_nearest(name, known.name);
      diagnostics.error(id, {file}, fmt::format("there is no {} '{}'", noun, name),
                        !near.empty() ? "did you mean '" + near + "'?"
                                      : fmt::format("the model has {}", fmt::join(known.name, ", ")));
    }
    return chosen;
  };
  const auto in = choose(inputs, model.inputs, "input", "linear.unknown-input");
  const auto out = choose(outputs, model.outputs, "output", "linear.unknown-output");
  diagnostics.throw_if_errors();
  const auto take = [](const records::Signals& all, const std::vector<int>& some) {
    records::Signals taken;
    for (const int i : some) {
      taken.name.push_back(all.name[static_cast<std::size_t>(i)]);
      taken.dims.push_back(all.dims[static_cast<std::size_t>(i)]);
    }
    return taken;
  };
  const bool is_all = inputs.empty() && outputs.empty();
  model.inputs = take(model.inputs, in);
  model.outputs = take(model.outputs, out);
  model.B = Eigen::MatrixXd(model.B(Eigen::all, in));
  model.C = Eigen::MatrixXd(model.C(out, Eigen::all));
  model.D = Eigen::MatrixXd(model.D(out, in));
  if (!is_all) {
    model.has_zeros = false;
    if (model.sample_time == 0) model.hankel = statespace::calc_hankel(model.A, model.B, model.C);
  }
  return model;
}

}  // namespace bough::analysis
