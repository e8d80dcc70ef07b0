#include "modal/response/function_table.hpp"

namespace bough::modal::response {

double calc_damping_ratio(const records::DampingCurve& curve, double hz) {
  records::DynamicTable table;
  table.points = curve.points;
  const double value = evaluate(table, hz);
  if (curve.type == "CRIT") return value;
  return curve.type == "Q" ? 0.5 / value : 0.5 * value;
}

const records::DynamicTable* find_table(const records::DynamicDeck& deck, int id) {
  for (const auto& table : deck.dynamics.tables)
    if (table.id == id) return &table;
  return nullptr;
}

}  // namespace bough::modal::response
