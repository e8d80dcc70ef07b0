#include "formats/nastran/detail/field_list.hpp"

namespace bough::nastran::detail {

FieldList& FieldList::pass(const char* name) {
  if (names_ != nullptr) names_->emplace_back(name);
  ++next_;
  return *this;
}

FieldList& FieldList::id(const char* name, int& value) {
  return field(
      name, [&](Card& card, int i) { value = card.read_id(i, name); }, [&](CardFields& out) { out.add(value); });
}

FieldList& FieldList::id(const char* name, int& value, int fallback) {
  return field(
      name, [&](Card& card, int i) { value = card.read_id(i, name, fallback); },
      [&](CardFields& out) { out.add(value); });
}

FieldList& FieldList::reference(const char* name, int& value) {
  return field(
      name, [&](Card& card, int i) { value = card.read_reference(i, name); },
      [&](CardFields& out) { out.add_id(value); });
}

FieldList& FieldList::integer(const char* name, int& value, int fallback) {
  return field(
      name, [&](Card& card, int i) { value = card.read_int(i, name, fallback); },
      [&](CardFields& out) { out.add(value); });
}

FieldList& FieldList::real(const char* name, double& value) {
  return field(
      name, [&](Card& card, int i) { value = card.read_real(i, name); }, [&](CardFields& out) { out.add(value); });
}

FieldList& FieldList::real(const char* name, double& value, double fallback) {
  return field(
      name, [&](Card& card, int i) { value = card.read_real(i, name, fallback); },
      [&](CardFields& out) { out.add(value); });
}

FieldList& FieldList::component(const char* name, int& value) {
  return field(
      name, [&](Card& card, int i) { value = card.read_component(i, name); }, [&](CardFields& out) { out.add(value); });
}

FieldList& FieldList::set_or_real(const char* name, int& set, double& value, double fallback) {
  return field(
      name,
      [&](Card& card, int i) {
        if (card.is_integer(i))
          set = card.read_reference(i, name);
        else
          value = card.read_real(i, name, fallback);
      },
      [&](CardFields& out) {
        if (set != 0)
          out.add(set);
        else
          out.add(value);
      });
}

FieldList& FieldList::flag(const char* name, bool& value, const char* off, const char* on) {
  return field(
      name,
      [&](Card& card, int i) {
        value = card.read_word(i, name, off, {off, on}) == on;
      },
      [&](CardFields& out) { out.add_word(value ? on : off); });
}

FieldList& FieldList::word(const char* name, std::string& value, const char* fallback,
                           const std::vector<std::string>& choices) {
  return field(
      name, [&](Card& card, int i) { value = card.read_word(i, name, fallback, choices); },
      [&](CardFields& out) { out.add_word(value); });
}

FieldList& FieldList::blank(int count) {
  if (fields_ != nullptr) fields_->add_blank(count);
  if (names_ != nullptr) names_->insert(names_->end(), static_cast<std::size_t>(count), "-");
  next_ += count;
  return *this;
}

}  // namespace bough::nastran::detail
