#pragma once
/// \file The cross-section shapes of PBARL and PBEAML.
#include <string>
#include <string_view>
#include <vector>

namespace bough::nastran::detail {

/// Number of dimensions of a shape (upper case), 0 when there is no such shape.
int get_num_dimensions(std::string_view shape);
/// Names of all shapes.
std::vector<std::string> get_shapes();

}  // namespace bough::nastran::detail
