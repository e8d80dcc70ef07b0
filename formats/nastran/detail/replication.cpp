#include "formats/nastran/detail/replication.hpp"

#include <charconv>
#include <climits>

#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

/// The n of "*n", "*(n)", "=n", "=(n)".
std::string_view get_argument(std::string_view field) {
  field = trim(field.substr(1));
  if (field.size() >= 2 && field.front() == '(' && field.back() == ')') field = trim(field.substr(1, field.size() - 2));
  return field;
}

}  // namespace

bool Replicator::is_relative(const CardText& card) {
  if (!card.name.empty() && card.name.front() == '=') return true;
  // Keywords of EIGRL are written NAME = value, equations have the sign in their text.
  if (card.name == "EIGRL" || card.name == "DEQATN") return false;
  for (const auto field : card.fields)
    if (field == "=" || field == "==") return true;
  return false;
}

std::optional<int> Replicator::find_repeats(const CardText& card) {
  if (card.name.size() < 2 || card.name.front() != '=' || card.name == "==") return std::nullopt;
  return parse_int(get_argument(card.name));
}

std::string Replicator::add_increment(std::string_view field, std::string_view increment, std::string_view& sum) {
  char buffer[40];
  const auto b = parse_int(increment);
  // A blank field counts as zero, of the kind of the increment.
  const auto a = field.empty() && b ? std::optional<int>(0) : parse_int(field);
  if (a && b) {
    const long total = static_cast<long>(*a) + *b;
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, total).ptr;
    storage_.emplace_back(buffer, end);
  } else {
    const auto x = field.empty() ? std::optional<double>(0.0) : parse_real(field);
    const auto dx = parse_real(increment);
    if (!dx) return "increment '" + std::string(increment) + "' is not a number";
    if (!x || a) return "a real increment cannot be added to '" + std::string(field) + "'";
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, *x + *dx).ptr;
    storage_.emplace_back(buffer, end);
    // Shortest text that reads back the same; a point keeps it a real.
    if (storage_.back().find_first_of(".e") == std::string::npos) storage_.back() += '.';
  }
  sum = storage_.back();
  return {};
}

std::string Replicator::resolve(CardText& card) {
  if (!has_previous_) return "there is no card before to copy from";
  if (card.name.front() == '=') {
    if (card.name != "=" && card.name != "==") return "'" + card.name + "' is no replication";
    if (card.name == "==") card.fields.insert(card.fields.begin(), "==");
    card.name = previous_.name;
  } else if (card.name != previous_.name) {
    return "the card before is " + previous_.name + ", not " + card.name;
  }
  increments_.clear();
  const auto before = [&](std::size_t i) {
    return i < previous_.fields.size() ? previous_.fields[i] : std::string_view{};
  };
  for (std::size_t i = 0; i < card.fields.size(); ++i) {
    auto& field = card.fields[i];
    if (field == "=") {
      field = before(i);
    } else if (field == "==") {
      card.fields.resize(std::max(i, previous_.fields.size()));
      for (std::size_t j = i; j < card.fields.size(); ++j) card.fields[j] = before(j);
      break;
    } else if (!field.empty() && field.front() == '*') {
      increments_.resize(i + 1);
      increments_[i] = get_argument(field);
      if (auto wrong = add_increment(before(i), increments_[i], field); !wrong.empty()) return wrong;
    }
  }
  return {};
}

std::string Replicator::make_copy(CardText& card) {
  if (!has_previous_) return "there is no card before to repeat";
  card.name = previous_.name;
  card.fields = previous_.fields;
  for (std::size_t i = 0; i < increments_.size() && i < card.fields.size(); ++i) {
    if (increments_[i].empty()) continue;
    if (auto wrong = add_increment(previous_.fields[i], increments_[i], card.fields[i]); !wrong.empty()) return wrong;
  }
  return {};
}

}  // namespace bough::nastran::detail
