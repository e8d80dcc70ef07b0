#include "formats/toml/detail/unit_edits.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "formats/toml/detail/source_text.hpp"
#include "formats/toml/system_editor.hpp"

namespace bough::toml_files {

std::string write_decimal(double value) {
  char digits[40];
  std::snprintf(digits, sizeof digits, "%.15g", value);
  if (std::abs(std::strtod(digits, nullptr) - value) > 4.5e-16 * std::abs(value))
    std::snprintf(digits, sizeof digits, "%.17g", value);
  std::string text = digits;
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string rewrite_formula(const std::string& formula, double factor, double time, const std::vector<double>& units) {
  const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  std::string out;
  for (std::size_t i = 0; i < formula.size();) {
    std::size_t end = i + 1;
    const bool is_digit = std::isdigit(static_cast<unsigned char>(formula[i])) != 0;
    if (is_digit || formula[i] == '.') {  // 1e3 has no name in it
      while (end < formula.size() &&
             (is_word(formula[end]) || formula[end] == '.' ||
              ((formula[end] == '-' || formula[end] == '+') && (formula[end - 1] == 'e' || formula[end - 1] == 'E'))))
        ++end;
    } else if (is_word(formula[i])) {
      while (end < formula.size() && is_word(formula[end])) ++end;
    }
    const std::string word = formula.substr(i, end - i);
    double unit = 1;
    if (word == "t") unit = time;
    if (word.size() > 1 && word[0] == 'u' && word.find_first_not_of("0123456789", 1) == std::string::npos) {
      const auto k = static_cast<std::size_t>(std::strtoul(word.c_str() + 1, nullptr, 10));
      if (k >= 1 && k <= units.size()) unit = units[k - 1];
    }
    out += unit == 1 ? word : "(" + word + "/" + write_decimal(unit) + ")";
    i = end;
  }
  return factor == 1 ? out : write_decimal(factor) + "*(" + out + ")";
}

UnitEdits::UnitEdits(const std::string& text, const std::string& file, Diagnostics& diagnostics)
    : text_(text), file_(file), diagnostics_(diagnostics) {}

void UnitEdits::put(const toml::source_region& place, const std::string& text) {
  edits_.push_back({find_byte(text_, place.begin), find_byte(text_, place.end), text});
}

void UnitEdits::scale(const toml::node* node, double factor) {
  if (node == nullptr) return;
  if (const auto* list = node->as_array()) {
    for (const auto& item : *list) scale(&item, factor);
  } else if (const auto* word = node->as_string(); word != nullptr && word->get().starts_with("$")) {
    const auto [at, is_new] =
        parameters_.emplace(word->get().substr(1), std::pair{factor, static_cast<int>(node->source().begin.line)});
    if (std::abs(at->second.first / factor - 1) > 1e-14 && in_two_.insert(at->first).second)
      error("toml.unit-parameter", *node,
            "parameter " + at->first + " has another dimension here than in line " + std::to_string(at->second.second),
            "make two parameters of it");
  } else if (const auto value = node->value<double>(); value && node->is_number() && factor != 1 && *value != 0) {
    put(node->source(), write_decimal(*value * factor));
  }
}

void UnitEdits::scale(const toml::node* node, const std::vector<double>& factors) {
  if (node == nullptr || factors.empty()) return;
  const bool is_one = std::all_of(factors.begin(), factors.end(), [&](double f) { return f == factors.front(); });
  if (is_one) return scale(node, factors.front());
  if (const auto* list = node->as_array()) {
    for (std::size_t i = 0; i < std::min(list->size(), factors.size()); ++i) scale(list->get(i), factors[i]);
  } else if (node->is_string()) {
    error("toml.unit-parameter", *node, "the parameter stands for quantities of different dimensions",
          "write a list with a number for each");
  } else if (const auto value = node->value<double>(); value && *value != 0) {
    std::string all;
    for (const double factor : factors) all += (all.empty() ? "" : ", ") + write_decimal(*value * factor);
    put(node->source(), "[" + all + "]");
  }
}

void UnitEdits::replace(const toml::node& node, const std::string& value) { put(node.source(), value); }

void UnitEdits::rename_key(const toml::key& key, const std::string& name) { put(key.source(), name); }

void UnitEdits::add(const std::string& path, const std::string& value) { added_.emplace_back(path, value); }

void UnitEdits::error(const char* id, const toml::node& node, const std::string& what, const std::string& fix) {
  diagnostics_.error(id, {file_, static_cast<int>(node.source().begin.line)}, what, fix);
}

std::string UnitEdits::apply(const toml::table& root) {
  const auto* parameters = root["parameters"].as_table();
  for (const auto& [name, use] : parameters_)
    if (const auto* value = parameters == nullptr ? nullptr : parameters->get(name); value && value->is_number())
      scale(value, use.first);
  std::sort(edits_.begin(), edits_.end(), [](const Edit& a, const Edit& b) { return a.begin > b.begin; });
  std::string text = text_;
  for (const auto& edit : edits_) text.replace(edit.begin, edit.end - edit.begin, edit.text);
  for (const auto& [path, value] : added_) set_value(text, path, value);
  return text;
}

}  // namespace bough::toml_files
