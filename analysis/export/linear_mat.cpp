#include "analysis/export/linear_mat.hpp"

namespace bough::analysis {

using records::LinearModel;

namespace {

matrices::MatCells make_cells(const std::vector<std::string>& words) { return {words.begin(), words.end()}; }

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

void write_linear_mat(const LinearModel& model, const std::string& path) {
  matrices::write_mat(path, make_linear_fields(model));
}

}  // namespace bough::analysis
