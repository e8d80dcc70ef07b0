#include "formats/records/third_order.hpp"

#include <numeric>

namespace bough::records {

int count_monomials(int n, int degree) {
  long count = 1;
  for (int k = 1; k <= degree; ++k) count = count * (n + k - 1) / k;
  return static_cast<int>(count);
}

Eigen::MatrixXi list_exponents(int n, int degree) {
  Eigen::MatrixXi all(count_monomials(n, degree), n);
  Eigen::RowVectorXi row = Eigen::RowVectorXi::Zero(n);
  Eigen::Index next = 0;
  const auto fill = [&](const auto& self, int variable, int left) -> void {
    if (variable == n - 1) {
      row[variable] = left;
      all.row(next++) = row;
      return;
    }
    for (int e = 0; e <= left; ++e) {
      row[variable] = e;
      self(self, variable + 1, left - e);
    }
  };
  if (n > 0) fill(fill, 0, degree);
  return all;
}

void ThirdOrder::count_directions() {
  large.resize(static_cast<std::size_t>(directions.rows()));
  std::iota(large.begin(), large.end(), 0);
}

bool are_modes(const std::vector<int>& numbers, int num_modes) {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (numbers[i] < 0 || numbers[i] >= num_modes || (i > 0 && numbers[i] <= numbers[i - 1])) return false;
  return true;
}

bool is_valid_choice(const std::vector<int>& large, int num_modes) {
  return are_modes(large, num_modes) && !large.empty() && large.size() <= kMaxLargeModes &&
         num_modes <= kMaxThirdOrderModes;
}

}  // namespace bough::records
