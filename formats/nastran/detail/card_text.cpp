#include "formats/nastran/detail/card_text.hpp"

#include <algorithm>
#include <charconv>

#include "base/diagnostic.hpp"

namespace bough::nastran::detail {
namespace {

/// value = ±0.d1d2d3... 10^exponent
struct Decimal {
  bool is_negative = false;
  std::string digits;
  int exponent = 0;
};

/// `precision` significant digits, or the fewest that read back as the same double when 0.
Decimal make_decimal(double value, int precision) {
  char buffer[40];
  const auto end = precision == 0 ? std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific)
                                  : std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific,
                                                  precision - 1);
  Decimal d;
  const char* p = buffer;
  if (*p == '-') {
    d.is_negative = true;
    ++p;
  }
  for (; p != end.ptr && *p != 'e'; ++p)
    if (*p != '.') d.digits += *p;
  BOUGH_DEMAND(p != end.ptr);  // infinity and NaN are no reals of a deck
  ++p;
  if (*p == '+') ++p;
  std::from_chars(p, end.ptr, d.exponent);
  ++d.exponent;
  while (d.digits.size() > 1 && d.digits.back() == '0') d.digits.pop_back();
  return d;
}

/// The shorter of "12.5", ".00125" and "1.25-7".
std::string make_text(const Decimal& d) {
  const std::string sign = d.is_negative ? "-" : "";
  const int n = static_cast<int>(d.digits.size());
  std::string scientific =
      sign + d.digits[0] + '.' + d.digits.substr(1) + (d.exponent - 1 < 0 ? "" : "+") + std::to_string(d.exponent - 1);
  std::string fixed = sign;
  if (d.exponent > 30 || d.exponent < -30) return scientific;
  if (d.exponent <= 0)
    fixed += '.' + std::string(static_cast<std::size_t>(-d.exponent), '0') + d.digits;
  else if (d.exponent >= n)
    fixed += d.digits + std::string(static_cast<std::size_t>(d.exponent - n), '0') + '.';
  else
    fixed += d.digits.substr(0, static_cast<std::size_t>(d.exponent)) + '.' +
             d.digits.substr(static_cast<std::size_t>(d.exponent));
  return fixed.size() <= scientific.size() ? fixed : scientific;
}

}  // namespace

std::string format_real(double value, int width) {
  if (value == 0) return "0.";
  const Decimal shortest = make_decimal(value, 0);
  std::string text = make_text(shortest);
  for (int digits = static_cast<int>(shortest.digits.size()) - 1; static_cast<int>(text.size()) > width; --digits) {
    BOUGH_DEMAND(digits > 0);
    text = make_text(make_decimal(value, digits));
  }
  return text;
}

std::string format_exact_real(double value) { return value == 0 ? "0." : make_text(make_decimal(value, 0)); }

CardFields& CardFields::add(int value) {
  fields_.emplace_back(value);
  return *this;
}
CardFields& CardFields::add(double value) {
  fields_.emplace_back(value);
  return *this;
}
CardFields& CardFields::add(const Eigen::Vector3d& v) { return add(v[0]).add(v[1]).add(v[2]); }
CardFields& CardFields::add_word(std::string_view word) {
  fields_.emplace_back(std::string(word));
  return *this;
}
CardFields& CardFields::add_blank(int count) {
  fields_.resize(fields_.size() + static_cast<std::size_t>(count));
  return *this;
}
CardFields& CardFields::add(const std::optional<double>& value) { return value ? add(*value) : add_blank(); }

CardFields& CardFields::add_id(int id) { return id == 0 ? add_blank() : add(id); }
CardFields& CardFields::add_components(unsigned mask) {
  if (mask == 0) return add_blank();
  std::string list;
  for (unsigned c = 0; c < 6; ++c)
    if ((mask & (1u << c)) != 0) list += static_cast<char>('1' + c);
  return add_word(list);
}
CardFields& CardFields::end_line() {
  fields_.resize((fields_.size() + 7) / 8 * 8);
  return *this;
}

bool CardFields::fits(int width, bool exactly) const {
  for (const auto& field : fields_) {
    std::size_t length = 0;
    if (const int* i = std::get_if<int>(&field)) length = std::to_string(*i).size();
    if (const auto* word = std::get_if<std::string>(&field)) length = word->size();
    if (const double* x = std::get_if<double>(&field); x != nullptr && exactly) length = format_exact_real(*x).size();
    if (length > static_cast<std::size_t>(width)) return false;
  }
  return true;
}

void CardFields::write(FieldFormat format, std::string& out) const {
  std::size_t count = fields_.size();
  while (count > 0 && std::holds_alternative<std::monostate>(fields_[count - 1])) --count;
  if (format != FieldFormat::Free && fits(8, format == FieldFormat::Large))
    write_fixed(8, count, out);
  else if (format != FieldFormat::Free && fits(16, false))
    write_fixed(16, count, out);
  else
    write_free(count, out);
}

void CardFields::write_fixed(int width, std::size_t count, std::string& out) const {
  const std::size_t per_line = width == 8 ? 8 : 4;
  // Large lines come in pairs.
  const std::size_t rounded = (count + 7) / 8 * 8;
  const std::size_t last = width == 8 ? count : rounded;
  const auto w = static_cast<std::size_t>(width);
  std::string line;
  for (std::size_t i = 0; i < std::max<std::size_t>(last, 1); i += per_line) {
    line = i > 0 ? (width == 8 ? "+" : "*") : name_ + (width == 8 ? "" : "*");
    line.resize(8, ' ');
    for (std::size_t k = i; k < i + per_line && k < count; ++k) {
      std::string text;
      if (const int* number = std::get_if<int>(&fields_[k])) text = std::to_string(*number);
      if (const double* x = std::get_if<double>(&fields_[k])) text = format_real(*x, width);
      if (const auto* word = std::get_if<std::string>(&fields_[k])) text = *word;
      line.append(w - text.size(), ' ').append(text);
    }
    line.resize(line.find_last_not_of(' ') + 1);
    // A line that goes on is written to its full width: some readers count its fields.
    if (i + per_line < last) line.resize(72, ' ');
    out.append(line).append(1, '\n');
  }
}

void CardFields::write_free(std::size_t count, std::string& out) const {
  out += name_;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0 && i % 8 == 0) out += ",+\n+";
    out += ',';
    if (const int* number = std::get_if<int>(&fields_[i])) out += std::to_string(*number);
    if (const double* x = std::get_if<double>(&fields_[i])) out += format_exact_real(*x);
    if (const auto* word = std::get_if<std::string>(&fields_[i])) out += *word;
  }
  // Without a comma the line would be read in columns.
  if (count == 0) out += ',';
  out += '\n';
}

}  // namespace bough::nastran::detail
