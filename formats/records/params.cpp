#include "formats/records/params.hpp"

#include <charconv>

#include "base/platform.hpp"

namespace bough::records {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

std::optional<double> parse_real(std::string_view text) {
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (!text.empty() && text.front() == '-') return std::nullopt;
  }
  if (text.empty()) return std::nullopt;
  const char first = text.front() == '-' && text.size() > 1 ? text[1] : text.front();
  if (!is_digit(first) && first != '.') return std::nullopt;  // from_chars would take "inf" and "nan"
  double value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = platform::read_number(text.data(), last, value);
  if (end == last) {
    if (error == std::errc()) return value;
    return std::nullopt;
  }
  // Text before a letter D or a bare sign is the mantissa: the number is written in the usual form and read again.
  char buffer[64];
  const std::size_t mantissa = static_cast<std::size_t>(end - text.data());
  if (mantissa == 0 || text.size() + 2 > sizeof buffer) return std::nullopt;
  const bool has_letter = *end == 'D' || *end == 'd';
  if (!has_letter && *end != '+' && *end != '-') return std::nullopt;
  for (std::size_t i = 0; i < mantissa; ++i)
    if (text[i] == 'e' || text[i] == 'E') return std::nullopt;
  text.copy(buffer, mantissa);
  std::size_t n = mantissa;
  buffer[n++] = 'e';
  for (std::size_t i = mantissa + (has_letter ? 1 : 0); i < text.size(); ++i) buffer[n++] = text[i];
  const auto again = platform::read_number(buffer, buffer + n, value);
  if (again.ec != std::errc() || again.ptr != buffer + n) return std::nullopt;
  return value;
}

double get_real_param(const Deck& deck, const std::string& name, double fallback, Diagnostics& diagnostics) {
  const Param* param = deck.find_param(name);
  if (!param) return fallback;
  if (const auto value = parse_real(param->value)) return *value;
  diagnostics.error("fe.bad-param", deck.locate(param->at),
                    "PARAM," + name + " is \"" + param->value + "\", expected a number", "correct the value");
  return fallback;
}

}  // namespace bough::records
