#include "solver/tree/coordinates.hpp"

namespace bough::solver {

std::string list_hinge_dims(const TreeBody& tb, HingeQuantity quantity, int first, int count) {
  std::string all;
  bool is_uniform = true;
  std::string one;
  for (int i = first; i < first + count; ++i) {
    const bool is_travel = quantity == HingeQuantity::Position ? is_length(tb, i) : is_translation(tb, i);
    std::string own = is_travel ? "L" : "1";
    if (quantity == HingeQuantity::Rate) own += "/T";
    if (quantity == HingeQuantity::Force) own = is_travel ? "F" : "F L";
    if (one.empty()) one = own;
    is_uniform = is_uniform && own == one;
    all += (all.empty() ? "" : ", ") + own;
  }
  return is_uniform ? one : all;
}

}  // namespace bough::solver
