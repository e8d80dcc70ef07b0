#include "formats/records/unit_labels.hpp"

#include <algorithm>

#include "formats/records/dims.hpp"

namespace bough::records {

namespace {

std::string label_one(const std::string& dims, const UnitLabels& labels, bool has_angle) {
  if (!parse_dims(dims)) return {};
  if (dims == "1") return has_angle ? "rad" : "";
  std::string text;
  for (const char c : dims) {
    const std::string* label = c == 'L'   ? &labels.length
                               : c == 'M' ? &labels.mass
                               : c == 'T' ? &labels.time
                               : c == 'F' ? &labels.force
                                          : nullptr;
    if (label && label->empty()) return {};
    text += label ? *label : std::string(1, c);
  }
  return has_angle && text.starts_with("1/") ? "rad" + text.substr(1) : text;
}

template <typename Visit>
void visit_list(const std::string& list, const Visit& visit) {
  for (std::size_t from = 0; from <= list.size();) {
    const auto to = std::min(list.find(", ", from), list.size());
    visit(list.substr(from, to - from));
    from = to + 2;
  }
}

}  // namespace

std::string label_units(const std::string& dims, const UnitLabels& labels, bool has_angle) {
  std::string text;
  bool is_first = true, has_any = false;
  visit_list(dims, [&](const std::string& one) {
    const auto label = label_one(one, labels, has_angle);
    has_any = has_any || !label.empty();
    text += (is_first ? "" : ", ") + label;
    is_first = false;
  });
  return has_any ? text : "";
}

std::string pick_unit(const std::string& list, int component, int num_components) {
  int count = 0;
  std::string found;
  visit_list(list, [&](const std::string& one) {
    if (count++ == component) found = one;
  });
  return count > 1 && count == num_components ? found : list;
}

}  // namespace bough::records
