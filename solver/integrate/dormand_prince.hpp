#pragma once
/// \file The pair of orders 8 and 7 that `rk` steps with.
#include <arkode/arkode_butcher.h>
#include <arkode/arkode_butcher_erk.h>

#include <memory>

#include "base/diagnostic.hpp"

namespace bough::solver {

struct FreeButcherTable {
  void operator()(ARKodeButcherTableMem* table) const { ARKodeButcherTable_Free(table); }
};
using ButcherTable = std::unique_ptr<ARKodeButcherTableMem, FreeButcherTable>;

/// 13 stages; c1 = 0, c12 = c13 = 1.
ButcherTable make_dormand_prince_87();

}  // namespace bough::solver
