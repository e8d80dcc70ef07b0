#include "formats/records/unit_names.hpp"

namespace bough::records {

std::string name_frequency_unit(const std::string& time) {
  if (time.empty() || time == "s" || time == "T") return "Hz";
  return time == "ms" ? "kHz" : "1/" + time;
}

std::string label_dims(const std::string& dims, const UnitLabels& units) {
  const auto label = label_units(dims, units, false);
  return label.empty() ? dims : label;
}

}  // namespace bough::records
