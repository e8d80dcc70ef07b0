#include "solver/text/settings.hpp"
#include "solver/text/names.hpp"

#include <algorithm>
#include <cmath>

namespace bough::solver {

double SettingsReader::get(const std::string& key) {
  known_.insert(key);
  const auto it = settings_.numbers.find(key);
  if (it == settings_.numbers.end() || it->second.size() != 1) {
    error("control.missing-key", "has no number '" + key + "'", "give " + key + " = NUMBER");
    return 0;
  }
  return it->second[0];
}

double SettingsReader::get(const std::string& key, double otherwise) {
  known_.insert(key);
  return has(key) ? get(key) : otherwise;
}

double SettingsReader::get_positive(const std::string& key) {
  const double value = get(key);
  demand(value > 0 || has_failed_, "has a " + key + " that is not positive", "give " + key + " > 0");
  return value;
}

double SettingsReader::get_size(const std::string& key, double otherwise) {
  const double value = get(key, otherwise);
  demand(value >= 0, "has a negative " + key, "give " + key + " >= 0");
  return value;
}

std::vector<double> SettingsReader::get_list(const std::string& key) {
  known_.insert(key);
  const auto it = settings_.numbers.find(key);
  if (it != settings_.numbers.end() && !it->second.empty()) return it->second;
  error("control.missing-key", "has no list '" + key + "'", "give " + key + " = [NUMBERS]");
  return {0.0};
}

VectorXd SettingsReader::get_vector(const std::string& key, int size, double otherwise) {
  known_.insert(key);
  if (!has(key)) return VectorXd::Constant(size, otherwise);
  return get_vector(key, size);
}

VectorXd SettingsReader::get_vector(const std::string& key, int size) {
  const auto list = get_list(key);
  if (list.size() == 1) return VectorXd::Constant(size, list[0]);
  if (static_cast<int>(list.size()) == size) return Eigen::Map<const VectorXd>(list.data(), size);
  error("control.bad-size",
        "has " + std::to_string(list.size()) + " numbers in " + key + ", expected " + std::to_string(size),
        "give one a component, or one for all");
  return VectorXd::Zero(size);
}

MatrixXd SettingsReader::get_matrix(const std::string& key, int rows, int columns) {
  known_.insert(key);
  MatrixXd m;
  if (const auto it = settings_.matrices.find(key); it != settings_.matrices.end()) {
    m = it->second;
  } else if (const auto list = settings_.numbers.find(key); list != settings_.numbers.end()) {
    const auto n = static_cast<Eigen::Index>(list->second.size());
    const bool is_row = rows == 1 || (rows < 0 && columns != 1);
    m = Eigen::Map<const MatrixXd>(list->second.data(), is_row ? 1 : n, is_row ? n : 1);
  } else {
    return m;
  }
  if ((rows >= 0 && m.rows() != rows) || (columns >= 0 && m.cols() != columns)) {
    error("control.bad-size",
          "has a " + key + " of " + std::to_string(m.rows()) + " x " + std::to_string(m.cols()) + ", expected " +
              (rows < 0 ? "any" : std::to_string(rows)) + " x " + (columns < 0 ? "any" : std::to_string(columns)),
          "give it row by row");
    return MatrixXd::Zero(std::max(0, rows), std::max(0, columns));
  }
  if (!m.allFinite()) error("control.bad-value", "has a " + key + " with numbers that are not finite", "correct it");
  return m;
}

std::string SettingsReader::get_word(const std::string& key, const std::string& otherwise) {
  const auto words = get_words(key);
  return words.empty() ? otherwise : words.front();
}

std::vector<std::string> SettingsReader::get_words(const std::string& key) {
  known_.insert(key);
  const auto it = settings_.words.find(key);
  return it == settings_.words.end() ? std::vector<std::string>() : it->second;
}

void SettingsReader::demand(bool condition, const std::string& what, const std::string& advice) {
  if (!condition) error("control.bad-value", what, advice);
}

std::string SettingsReader::get_lent() const {
  const auto it = settings_.words.find(kLentKey);
  return it == settings_.words.end() ? "" : it->second.front();
}

void SettingsReader::error(const char* id, const std::string& what, const std::string& advice) {
  has_failed_ = true;
  diagnostics_.error(id, at_, what_ + " " + what, advice);
}

void SettingsReader::refuse_others() {
  const std::vector<std::string> names(known_.begin(), known_.end());
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + name;
  const auto check = [&](const auto& map) {
    for (const auto& [key, value] : map) {
      if (known_.count(key) || key == kLentKey) continue;
      error("control.unknown-key", "has the key '" + key + "', which it does not take",
            suggest_name(key, names, "it takes: " + (list.empty() ? "none" : list)));
    }
  };
  check(settings_.numbers);
  check(settings_.matrices);
  check(settings_.words);
}

}  // namespace bough::solver
