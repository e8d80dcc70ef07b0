#include "analysis/export/linear_mat.hpp"

namespace bough::analysis {

using records::LinearModel;

namespace {

matrices::MatCells make_cells(const std::vector<std::string>& words) { return {words.begin(), words.end()}; }

/// One matrix for each model, the index of the first parameter fastest.
matrices::MatArray make_array(const records::LinearSweep& sweep, Eigen::MatrixXd LinearModel::*part) {
  const auto& first = sweep.models.front().*part;
  matrices::MatArray array{{static_cast<std::size_t>(first.rows()), static_cast<std::size_t>(first.cols())}, {}};
  std::vector<std::size_t> sizes;
  for (const auto& values : sweep.grid_value) sizes.push_back(static_cast<std::size_t>(values.size()));
  if (sizes.empty()) sizes.push_back(sweep.models.size());
  array.dims.insert(array.dims.end(), sizes.begin(), sizes.end());
  for (std::size_t k = 0; k < sweep.models.size(); ++k) {
    std::size_t at = 0, rest = k;
    for (const std::size_t size : sizes) {  // digits of k, first fastest, into an index with the last fastest
      at = at * size + rest % size;
      rest /= size;
    }
    const Eigen::MatrixXd& m = sweep.models[at].*part;
    array.data.insert(array.data.end(), m.data(), m.data() + m.size());
  }
  return array;
}

}  // namespace

matrices::MatFields make_linear_fields(const LinearModel& model) {
  matrices::MatFields fields{{"A", model.A},
                             {"B", model.B},
                             {"C", model.C},
                             {"D", model.D},
                             {"state_name", make_cells(model.states.name)},
                             {"input_name", make_cells(model.inputs.name)},
                             {"output_name", make_cells(model.outputs.name)}};
  if (model.sample_time > 0) fields.emplace_back("sample_time", Eigen::MatrixXd::Constant(1, 1, model.sample_time));
  if (!model.uncertainty.empty()) {
    const auto count = static_cast<Eigen::Index>(model.uncertainty.size());
    std::vector<std::string> names;
    Eigen::MatrixXd range(count, 2), size(count, 1);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto& one = model.uncertainty[static_cast<std::size_t>(i)];
      names.push_back(one.name);
      range.row(i) << one.low, one.high;
      size(i, 0) = one.size;
    }
    fields.emplace_back("delta_name", make_cells(names));
    fields.emplace_back("delta_range", range);
    fields.emplace_back("delta_size", size);
  }
  return fields;
}

matrices::MatFields make_second_order_fields(const LinearModel& model) {
  const auto second = records::make_second_order(model);
  if (second.M.size() == 0) return {};
  matrices::MatFields fields{
      {"mass", second.M}, {"damping", second.D}, {"stiffness", second.K}, {"input_force", second.F}};
  if (second.Z.cols() > 0) fields.emplace_back("state_force", second.Z);
  return fields;
}

matrices::MatFields make_sweep_fields(const records::LinearSweep& sweep) {
  const auto& first = sweep.models.front();
  matrices::MatCells values;
  for (const auto& value : sweep.grid_value) values.emplace_back(value);
  if (values.empty()) values.emplace_back(sweep.value);
  matrices::MatFields fields{
      {"A", make_array(sweep, &LinearModel::A)},
      {"B", make_array(sweep, &LinearModel::B)},
      {"C", make_array(sweep, &LinearModel::C)},
      {"D", make_array(sweep, &LinearModel::D)},
      {"parameter_name", make_cells(sweep.grid_name.empty() ? std::vector{sweep.parameter} : sweep.grid_name)},
      {"parameter_value", std::move(values)},
      {"state_name", make_cells(first.states.name)},
      {"input_name", make_cells(first.inputs.name)},
      {"output_name", make_cells(first.outputs.name)}};
  if (first.sample_time > 0) fields.emplace_back("sample_time", first.sample_time);
  return fields;
}

void write_sweep_mat(const records::LinearSweep& sweep, const std::string& path) {
  matrices::write_mat(path, make_sweep_fields(sweep));
}

void write_linear_mat(const LinearModel& model, const std::string& path) {
  matrices::write_mat(path, make_linear_fields(model));
}

}  // namespace bough::analysis
