#pragma once
/// \file Watches whether a flexible body leaves the range of linear modes (the habit of Adams/Flex).
#include <optional>
#include <string>
#include <vector>

#include "solver/system/system.hpp"

namespace bough::solver {

/// Share of a body's size (largest distance of a node from Bo) that a deflection may reach before it is reported.
inline constexpr double kLinearLimit = 0.10;

class LinearLimit {
 public:
  explicit LinearLimit(const System& system);

  struct Crossing {
    std::string body;
    int node = 0;  ///< id
    double deflection = 0, size = 0;
  };
  /// The next body that passes the limit for the first time at q; empty when none does. Linear modes only. No
  /// allocation while nothing crosses. O(nodes · modes).
  std::optional<Crossing> find_crossing(const Eigen::Ref<const VectorXd>& q);

 private:
  struct Watched {
    int body = 0;
    double size = 0;
    bool reported = false;
  };
  const System& system_;
  std::vector<Watched> watched_;
};

}  // namespace bough::solver
