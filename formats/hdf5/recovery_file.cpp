#include "formats/hdf5/detail/recovery.hpp"

namespace bough::hdf5 {
namespace {

using Eigen::MatrixXd;
using records::ThirdOrder;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::string name_degree(const std::string& path, int degree) { return path + "_" + std::to_string(degree); }

/// Rows of elements x components as three dimensions.
void write_rows(FileWriter& file, const std::string& path, const records::RecoveryBlock& block, const MatrixXd& rows) {
  const RowMajor data = rows;
  file.write_numbers(path, {block.id.size(), block.components.size(), static_cast<hsize_t>(data.cols())}, data.data());
}

MatrixXd read_rows(FileReader& file, const std::string& path, const records::RecoveryBlock& block, long columns) {
  const auto e = static_cast<long>(block.id.size()), c = static_cast<long>(block.components.size());
  const NumberArray data = file.read_array(path, {e, c, columns});
  return Eigen::Map<const RowMajor>(data.data.data(), e * c, columns);
}

}  // namespace

void write_recovery(FileWriter& file, const records::FlexBody& body) {
  if (body.recovery.empty()) return;
  file.write_matrix("/recovery/inertial_load", body.inertial_load);
  file.make_group("/recovery/elements");
  for (const auto& block : body.recovery) {
    const std::string path = "/recovery/elements/" + block.name;
    file.write_integers(path + "/id", block.id);
    file.write_strings(path + "/component", block.components);
    write_rows(file, path + "/matrix", block, block.matrix);
    for (int k = ThirdOrder::kMinField; k <= ThirdOrder::kMaxField && block.has_beyond(); ++k)
      write_rows(file, name_degree(path + "/matrix", k), block,
                 block.beyond[static_cast<std::size_t>(k - ThirdOrder::kMinField)]);
    write_rows(file, path + "/inertial", block, block.inertial);
    write_rows(file, path + "/external", block, block.external);
    write_rows(file, path + "/offset", block, block.offset);
  }
}

void read_recovery(FileReader& file, records::FlexBody& body) {
  if (!file.has("/recovery/elements")) return;
  const long n = body.num_modes(), ne = static_cast<long>(body.locators.size());
  body.inertial_load = file.read_matrix("/recovery/inertial_load");
  for (const auto& name : file.get_children("/recovery/elements")) {
    const std::string path = "/recovery/elements/" + name;
    auto& block = body.recovery.emplace_back();
    block.name = name;
    block.id = file.read_integers(path + "/id");
    block.components = file.read_strings(path + "/component");
    block.matrix = read_rows(file, path + "/matrix", block, n);
    for (int k = ThirdOrder::kMinField; k <= ThirdOrder::kMaxField; ++k) {
      const std::string beyond = name_degree(path + "/matrix", k);
      if (body.third_order.empty() || !file.has(beyond)) continue;
      block.beyond[static_cast<std::size_t>(k - ThirdOrder::kMinField)] = read_rows(
          file, beyond, block, records::count_monomials(body.third_order.num_variables(k, static_cast<int>(n)), k));
    }
    block.inertial = read_rows(file, path + "/inertial", block, records::kNumInertialLoads);
    block.external = read_rows(file, path + "/external", block, ne);
    block.offset = read_rows(file, path + "/offset", block, 1);
  }
}

}  // namespace bough::hdf5
