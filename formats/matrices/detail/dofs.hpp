#pragma once
/// \file Rows of a matrix named by node and component.
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace bough::matrices::detail {

using Dof = std::pair<int, int>;  ///< node id, component 1..6 (0: scalar point)

/// Numbers dofs in the order of the file; sorted by node and component at the end.
class DofNumbers {
 public:
  /// Returns the number of a dof; a new one gets the next number, from 0.
  int find_or_add(const Dof& dof) { return number_.try_emplace(dof, static_cast<int>(number_.size())).first->second; }
  /// Number of dofs so far.
  int size() const { return static_cast<int>(number_.size()); }
  /// New place of each number, and the dofs in their new order.
  std::vector<int> sort(Eigen::MatrixXi& dofs) const {
    std::vector<int> place(number_.size());
    dofs.resize(static_cast<Eigen::Index>(number_.size()), 2);
    int next = 0;
    for (const auto& [dof, number] : number_) {
      dofs.row(next) << dof.first, dof.second;
      place[static_cast<std::size_t>(number)] = next++;
    }
    return place;
  }

 private:
  std::map<Dof, int> number_;
};

}  // namespace bough::matrices::detail
