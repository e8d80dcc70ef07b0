#include "formats/nastran/detail/equation.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

/// A number with its FORTRAN type.
struct Number {
  double value = 0;
  bool is_integer = false;
};

using Numbers = std::vector<Number>;

constexpr int kMaxDepth = 200;  // nested parentheses

struct Function {
  std::size_t min_arguments, max_arguments;
  double (*apply)(const Numbers&);
  bool keeps_integers = false;  ///< an integer of integers
};

double sum_squares(const Numbers& a) {
  double sum = 0;
  for (const auto& x : a) sum += x.value * x.value;
  return sum;
}
double sum(const Numbers& a) {
  double total = 0;
  for (const auto& x : a) total += x.value;
  return total;
}
bool is_below(const Number& a, const Number& b) { return a.value < b.value; }

template <double (*F)(double)>
Function make_function() {
  return {1, 1, [](const Numbers& a) { return F(a[0].value); }};
}

const Function* find_function(const std::string& name) {
  constexpr std::size_t many = 1000;
  static const std::map<std::string, Function> functions{
      {"ABS", {1, 1, [](const Numbers& a) { return std::abs(a[0].value); }, true}},
      {"ACOS", make_function<std::acos>()},
      {"ACOSH", make_function<std::acosh>()},
      {"ASIN", make_function<std::asin>()},
      {"ASINH", make_function<std::asinh>()},
      {"ATAN", make_function<std::atan>()},
      {"ATAN2", {2, 2, [](const Numbers& a) { return std::atan2(a[0].value, a[1].value); }}},
      {"ATANH", make_function<std::atanh>()},
      {"AVG", {1, many, [](const Numbers& a) { return sum(a) / static_cast<double>(a.size()); }}},
      {"COS", make_function<std::cos>()},
      {"COSH", make_function<std::cosh>()},
      {"DB", {2, 2, [](const Numbers& a) { return 20 * std::log10(a[0].value / a[1].value); }}},
      {"DIM", {2, 2, [](const Numbers& a) { return std::max(a[0].value - a[1].value, 0.0); }, true}},
      {"EXP", make_function<std::exp>()},
      {"INT", {1, 1, [](const Numbers& a) { return std::trunc(a[0].value); }}},
      {"INVDB", {2, 2, [](const Numbers& a) { return std::pow(10, a[0].value / 20) * a[1].value; }}},
      {"LOG", make_function<std::log>()},
      {"LOG10", make_function<std::log10>()},
      {"LOGX", {2, 2, [](const Numbers& a) { return std::log(a[1].value) / std::log(a[0].value); }}},
      {"MAX", {1, many, [](const Numbers& a) { return std::max_element(a.begin(), a.end(), is_below)->value; }, true}},
      {"MIN", {1, many, [](const Numbers& a) { return std::min_element(a.begin(), a.end(), is_below)->value; }, true}},
      {"MOD", {2, 2, [](const Numbers& a) { return std::fmod(a[0].value, a[1].value); }, true}},
      {"PI", {1, 1, [](const Numbers& a) { return std::numbers::pi * a[0].value; }}},
      {"RSS", {1, many, [](const Numbers& a) { return std::sqrt(sum_squares(a)); }}},
      {"SIN", make_function<std::sin>()},
      {"SINH", make_function<std::sinh>()},
      {"SQRT", make_function<std::sqrt>()},
      {"SSQ", {1, many, sum_squares}},
      {"SUM", {1, many, sum, true}},
      {"TAN", make_function<std::tan>()},
      {"TANH", make_function<std::tanh>()}};
  const auto found = functions.find(name);
  return found == functions.end() ? nullptr : &found->second;
}

[[noreturn]] void fail(const std::string& what) { throw std::invalid_argument(what); }

/// Recursive descent over one expression without blanks.
class Expression {
 public:
  Expression(std::string_view text, const std::map<std::string, double>& values) : text_(text), values_(values) {}

  double evaluate() {
    const auto result = read_sum();
    if (at_ < text_.size()) fail("'" + std::string(text_.substr(at_)) + "' is not expected");
    return result.value;
  }

 private:
  bool take(std::string_view token) {
    if (text_.substr(at_, token.size()) != token) return false;
    at_ += token.size();
    return true;
  }

  static Number combine(const Number& a, const Number& b, double value) {
    return {value, a.is_integer && b.is_integer};
  }

  Number read_sum() {
    if (++depth_ > kMaxDepth) fail("parentheses are nested too deeply");
    const bool is_negative = take("-");
    if (!is_negative) take("+");
    Number result = read_product();
    if (is_negative) result.value = -result.value;
    while (at_ < text_.size()) {
      const bool is_minus = text_[at_] == '-';
      if (!take("+") && !take("-")) break;
      const auto term = read_product();
      result = combine(result, term, result.value + (is_minus ? -term.value : term.value));
    }
    --depth_;
    return result;
  }

  Number read_product() {
    Number result = read_power();
    while (at_ < text_.size()) {
      const bool is_quotient = text_[at_] == '/';
      if (!take("*") && !take("/")) break;
      const auto factor = read_power();
      if (is_quotient && factor.value == 0) fail("it divides by zero");
      result = combine(result, factor, is_quotient ? result.value / factor.value : result.value * factor.value);
      if (is_quotient && result.is_integer) result.value = std::trunc(result.value);
    }
    return result;
  }

  Number read_power() {
    const auto base = read_primary();
    if (!take("**")) return base;
    if (++depth_ > kMaxDepth) fail("powers are nested too deeply");
    const bool is_negative = take("-");
    if (!is_negative) take("+");
    auto exponent = read_power();
    --depth_;
    if (is_negative) exponent.value = -exponent.value;
    auto result = combine(base, exponent, std::pow(base.value, exponent.value));
    if (result.is_integer) result.value = std::trunc(result.value);
    return result;
  }

  Number read_primary() {
    if (at_ >= text_.size()) fail("it ends where a value is expected");
    if (take("(")) {
      const auto inner = read_sum();
      if (!take(")")) fail("a parenthesis is not closed");
      return inner;
    }
    const auto c = static_cast<unsigned char>(text_[at_]);
    if (std::isdigit(c) || c == '.') return read_number();
    if (!std::isalpha(c)) fail("'" + std::string(text_.substr(at_)) + "' is not expected");
    const auto start = at_;
    while (at_ < text_.size() && std::isalnum(static_cast<unsigned char>(text_[at_]))) ++at_;
    const std::string name(text_.substr(start, at_ - start));
    if (take("(")) return call(name);
    const auto found = values_.find(name);
    if (found == values_.end()) fail(name + " is neither an argument nor assigned before");
    return {found->second, false};
  }

  Number call(const std::string& name) {
    const auto* function = find_function(name);
    if (!function) fail("the function " + name + " is not supported");
    Numbers arguments;
    do arguments.push_back(read_sum());
    while (take(","));
    if (!take(")")) fail("a parenthesis of " + name + " is not closed");
    if (arguments.size() < function->min_arguments || arguments.size() > function->max_arguments)
      fail(name + " has " + std::to_string(arguments.size()) + " arguments");
    const bool is_integer = function->keeps_integers &&
                            std::all_of(arguments.begin(), arguments.end(), [](const auto& a) { return a.is_integer; });
    return {function->apply(arguments), is_integer};
  }

  Number read_number() {
    const auto is_digit = [this](std::size_t i) {
      return i < text_.size() && std::isdigit(static_cast<unsigned char>(text_[i]));
    };
    const auto start = at_;
    bool is_integer = true;
    while (is_digit(at_)) ++at_;
    if (at_ < text_.size() && text_[at_] == '.') {
      is_integer = false;
      ++at_;
      while (is_digit(at_)) ++at_;
    }
    if (at_ < text_.size() && (text_[at_] == 'E' || text_[at_] == 'D')) {
      const auto sign = at_ + 1 < text_.size() && (text_[at_ + 1] == '+' || text_[at_ + 1] == '-') ? 1u : 0u;
      if (is_digit(at_ + 1 + sign)) {
        is_integer = false;
        at_ += 1 + sign;
        while (is_digit(at_)) ++at_;
      }
    }
    const auto token = text_.substr(start, at_ - start);
    if (is_integer) {
      const auto integer = parse_int(token);
      if (!integer) fail("'" + std::string(token) + "' is not a number");
      return {static_cast<double>(*integer), true};
    }
    const auto value = parse_real(token);
    if (!value) fail("'" + std::string(token) + "' is not a number");
    return {*value, false};
  }

  std::string_view text_;
  const std::map<std::string, double>& values_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

/// Reads the names of NAME(A, B) into `arguments`.
std::string split_head(std::string_view head, std::vector<std::string>& arguments) {
  const auto open = head.find('(');
  if (open == std::string_view::npos || head.back() != ')') fail("it does not begin with NAME(ARGUMENTS) =");
  auto list = head.substr(open + 1, head.size() - open - 2);
  while (!list.empty()) {
    const auto comma = std::min(list.find(','), list.size());
    arguments.emplace_back(list.substr(0, comma));
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return std::string(head.substr(0, open));
}

double evaluate(std::string_view equation, const std::vector<double>& values) {
  std::map<std::string, double> known;
  double value = 0;
  for (bool is_first = true; !equation.empty(); is_first = false) {
    const auto end = std::min(equation.find(';'), equation.size());
    const auto statement = equation.substr(0, end);
    equation.remove_prefix(std::min(end + 1, equation.size()));
    if (statement.empty()) continue;
    const auto equals = statement.find('=');
    if (equals == std::string_view::npos) fail("'" + std::string(statement) + "' has no equals sign");
    std::string name(statement.substr(0, equals));
    if (is_first) {
      std::vector<std::string> arguments;
      name = split_head(name, arguments);
      if (arguments.size() != values.size())
        fail("it has " + std::to_string(arguments.size()) + " arguments, and " + std::to_string(values.size()) +
             " values are given");
      for (std::size_t i = 0; i < values.size(); ++i) known[arguments[i]] = values[i];
    }
    value = Expression(statement.substr(equals + 1), known).evaluate();
    if (!std::isfinite(value)) fail(name + " is no finite number");
    known[name] = value;
  }
  if (known.empty()) fail("it has no assignment");
  return value;
}

}  // namespace

std::optional<int> find_equation_id(const CardText& text) {
  const std::string_view line = text.lines.front().text;
  const auto end = std::min(line.find_first_of(", "), line.size());
  if (end == line.size()) return std::nullopt;
  // Fixed fields: columns 9 to 16, and the equation may follow without a blank.
  return parse_int(line[end] == ',' ? trim(line.substr(end + 1, line.find(',', end + 1) - end - 1))
                                    : trim(line.substr(8, 8)));
}

std::string join_equation(const CardText& text) {
  std::string joined;
  for (std::size_t i = 0; i < text.lines.size(); ++i) {
    std::string_view line = text.lines[i].text;
    const auto word_end = std::min(line.find_first_of(", "), line.size());
    const bool is_free = i == 0 ? word_end < line.size() && line[word_end] == ','
                                : word_end < 8 && word_end < line.size() && line[word_end] == ',' &&
                                      (word_end == 0 || line.front() == '+');
    constexpr std::size_t width = 72;
    if (!is_free) {
      const std::size_t first = i == 0 ? 16 : 8;
      line = line.substr(std::min(first, line.size()), width - first);
    } else {
      line.remove_prefix(word_end + 1);
      if (i == 0) line.remove_prefix(std::min(line.find(',') + 1, line.size()));
    }
    joined += line;
  }
  std::erase_if(joined, [](char c) { return c == ' ' || c == '\t' || c == '\r'; });
  return make_upper(joined);
}

EquationValue evaluate_equation(std::string_view equation, const std::vector<double>& values) {
  try {
    return {evaluate(equation, values), {}};
  } catch (const std::invalid_argument& error) {
    return {0, error.what()};
  }
}

}  // namespace bough::nastran::detail
