#include "report/label.hpp"

#include "formats/records/unit_names.hpp"

namespace bough::report {

std::string make_label(const std::string& name, const std::string& unit) {
  if (unit.empty() || unit == "1") return name;
  return name + (name.empty() ? "[" : " [") + unit + "]";
}

std::string label_frequency(const std::string& time_unit) {
  return make_label("frequency", records::name_frequency_unit(time_unit));
}

std::string make_density_unit(const std::string& unit, const std::string& time_unit) {
  if (unit.empty()) return {};
  const bool is_product = unit.find_first_of(" /^") != std::string::npos;
  const auto square = (is_product ? "(" + unit + ")" : unit) + "^2";
  if (time_unit.empty() || time_unit == "s" || time_unit == "T") return square + "/Hz";
  return square + (time_unit == "ms" ? "/kHz" : " " + time_unit);
}

std::string write_powers(std::string label) {
  for (const auto& [plain, raised] : {std::pair{"^2", "²"}, {"^3", "³"}, {"^4", "⁴"}})
    for (auto at = label.find(plain); at != std::string::npos; at = label.find(plain, at)) label.replace(at, 2, raised);
  return label;
}

void label_units(Plot& plot) {
  const Curve* first = nullptr;
  bool is_common = true;
  for (const auto& curve : plot.curves) {
    if (curve.markers_only) continue;  // reference points have the unit of the axis
    if (!first) first = &curve;
    is_common = is_common && curve.unit == first->unit;
  }
  if (!first) return;
  if (is_common) {
    plot.y_label = make_label(plot.y_label, first->unit);
    return;
  }
  for (auto& curve : plot.curves)
    if (!curve.label.empty()) curve.label = make_label(curve.label, curve.unit);
}

}  // namespace bough::report
