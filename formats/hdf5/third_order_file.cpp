#include "formats/hdf5/detail/third_order.hpp"

namespace bough::hdf5 {
namespace {

using Eigen::MatrixXd;
using records::ThirdOrder;
using Tables = ThirdOrder::Tables;

std::string name_degree(const std::string& path, int degree) { return path + "_" + std::to_string(degree); }

}  // namespace

void write_third_order(FileWriter& file, const records::FlexBody& body) {
  const ThirdOrder& third = body.third_order;
  if (third.empty()) return;
  std::vector<int> numbers;
  for (const int j : third.large) numbers.push_back(j + 1);
  // One of both: programs that do not know directions find that the modes are missing.
  if (third.directions.size() > 0)
    file.write_matrix("/third_order/directions", third.directions);
  else
    file.write_integers("/third_order/large", numbers);
  for (int k = ThirdOrder::kMinEnergy; k <= ThirdOrder::kMaxEnergy; ++k)
    file.write_vector(name_degree("/third_order/energy", k),
                      third.energy[static_cast<std::size_t>(k - ThirdOrder::kMinEnergy)]);
  file.write_matrix("/third_order/energy_small", third.energy_small);
  std::vector<double> fields, nodes;
  const auto append = [](std::vector<double>& data, const MatrixXd& m) {
    for (Eigen::Index i = 0; i < m.rows(); ++i)
      for (Eigen::Index j = 0; j < m.cols(); ++j) data.push_back(m(i, j));
  };
  for (const auto& field : third.fields) append(fields, field);
  const auto m = static_cast<hsize_t>(third.num_fields());
  file.write_numbers("/third_order/fields", {third.fields.size(), 6, m}, fields.data());
  for (int k = ThirdOrder::kMinField; k <= ThirdOrder::kMaxField; ++k) {
    const auto at = static_cast<std::size_t>(k - ThirdOrder::kMinField);
    file.write_matrix(name_degree("/third_order/amplitudes", k), third.amplitudes[at]);
    nodes.clear();
    for (const auto& tables : third.node) append(nodes, tables[at]);
    file.write_numbers(name_degree("/third_order/node", k),
                       {third.node.size(), static_cast<hsize_t>(third.amplitudes[at].rows()), 6}, nodes.data());
    file.write_matrix(name_degree("/third_order/load", k), third.load[at]);
  }
  if (third.coupling.size() > 0) file.write_matrix("/third_order/coupling", third.coupling);
  write_integrals(file, "/third_order/integrals", third.integrals);
}

void read_third_order(FileReader& file, records::FlexBody& body) {
  if (!file.has("/third_order")) return;
  ThirdOrder& third = body.third_order;
  const int n = body.num_modes();
  if (file.has("/third_order/directions")) {
    third.directions = file.read_matrix("/third_order/directions");
    third.count_directions();
  } else {
    third.large = file.read_integers("/third_order/large");
    for (int& j : third.large) --j;
  }
  const int N = third.num_large();
  if (!records::is_valid_choice(third.large, n)) return;  // find_body_faults() says so
  for (int k = ThirdOrder::kMinEnergy; k <= ThirdOrder::kMaxEnergy; ++k)
    third.energy[static_cast<std::size_t>(k - ThirdOrder::kMinEnergy)] =
        file.read_vector(name_degree("/third_order/energy", k), records::count_monomials(N, k));
  third.energy_small = file.read_matrix("/third_order/energy_small", records::count_monomials(N, 2), n - N);
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const NumberArray fields = file.read_array("/third_order/fields");
  const long m = fields.shape.size() == 3 ? static_cast<long>(fields.shape[2]) : 0;
  for (int k = 0; k < body.num_nodes(); ++k)
    third.fields.emplace_back(Eigen::Map<const RowMajor>(fields.data.data() + k * 6 * m, 6, m));
  third.node.resize(body.interface_nodes.size());
  const auto num_nodes = static_cast<long>(third.node.size()), ne = static_cast<long>(body.locators.size());
  for (int k = ThirdOrder::kMinField; k <= ThirdOrder::kMaxField; ++k) {
    const auto at = static_cast<std::size_t>(k - ThirdOrder::kMinField);
    const long rows = records::count_monomials(third.num_variables(k, n), k);
    third.amplitudes[at] = file.read_matrix(name_degree("/third_order/amplitudes", k), rows, m);
    third.load[at] = file.read_matrix(name_degree("/third_order/load", k), rows, ne);
    const NumberArray nodes = file.read_array(name_degree("/third_order/node", k), {num_nodes, rows, 6});
    for (long i = 0; i < num_nodes; ++i)
      third.node[static_cast<std::size_t>(i)][at] =
          Eigen::Map<const RowMajor>(nodes.data.data() + i * rows * 6, rows, 6);
  }
  if (file.has("/third_order/coupling")) third.coupling = file.read_matrix("/third_order/coupling");
  third.integrals = read_integrals(file, "/third_order/integrals", n + m);
}

void write_next_order(FileWriter& file, const records::NextOrder& next) {
  if (next.empty()) return;
  std::vector<int> numbers;
  for (const int j : next.modes) numbers.push_back(j + 1);
  file.write_integers("/next_order/modes", numbers);
  file.write_vector("/next_order/energy_3", next.cubic);
  file.write_vector("/next_order/energy_4", next.quartic);
}

records::NextOrder read_next_order(FileReader& file, int num_modes) {
  records::NextOrder next;
  if (!file.has("/next_order")) return next;
  next.modes = file.read_integers("/next_order/modes");
  for (int& j : next.modes) --j;
  const auto N = static_cast<int>(next.modes.size());
  if (!records::are_modes(next.modes, num_modes) || N > records::kMaxLargeModes) return next;  // a body fault
  next.cubic = file.read_vector("/next_order/energy_3", records::count_monomials(N, 3));
  next.quartic = file.read_vector("/next_order/energy_4", records::count_monomials(N, 4));
  return next;
}

}  // namespace bough::hdf5
