#include "formats/matrices/test_functions.hpp"

#include <algorithm>
#include <cmath>

#include "formats/matrices/detail/uff_input.hpp"

namespace bough::matrices {
namespace {

using namespace detail;

constexpr long kFrequencyResponse = 4, kSpectrum = 12, kFrequency = 18;

/// A column of a line as an integer; blank: 0.
long read_column(const TextInput& in, std::size_t at, std::size_t width, const char* expected) {
  const auto line = in.get_line();
  const auto word = at < line.size() ? trim(line.substr(at, width)) : std::string_view();
  if (word.empty()) return 0;
  const auto value = parse_integer(word);
  if (!value) in.fail_line(expected);
  return *value;
}

double read_real_column(const TextInput& in, std::size_t at, std::size_t width, const char* expected) {
  const auto line = in.get_line();
  const auto value = at < line.size() ? parse_real(line.substr(at, width)) : std::nullopt;
  if (!value || !std::isfinite(*value)) in.fail_line(expected);
  return *value;
}

class FunctionReader {
 public:
  explicit FunctionReader(const std::string& path) : in_(path) {}

  std::vector<TestFunction> read() {
    in_.read_datasets([&](long number) {
      if (number == 58)
        read_function();
      else
        in_.skip_dataset();
    });
    return std::move(functions_);
  }

 private:
  /// Columns of the lines of values: uneven ones repeat the abscissa of 13 columns.
  std::vector<double> read_values(std::size_t count, bool is_even, bool is_complex, bool is_double) {
    std::vector<std::size_t> widths;
    if (!is_double)
      widths.assign(6, 13);
    else if (is_even)
      widths.assign(4, 20);
    else if (is_complex)
      widths = {13, 20, 20};
    else
      widths = {13, 20, 13, 20};
    std::vector<double> values;
    while (values.size() < count) {
      in_.demand_of_dataset("the values of the function");
      std::size_t at = 0;
      for (const auto width : widths) {
        if (values.size() == count) break;
        if (at >= in_.get_line().size() || trim(in_.get_line().substr(at)).empty()) break;
        values.push_back(read_real_column(in_, at, width, "values of the function in columns"));
        at += width;
      }
      if (at == 0) in_.fail_line("the values of the function");
    }
    return values;
  }

  void read_function() {
    TestFunction f;
    f.line = in_.get_line_number();
    for (int i = 0; i < 5; ++i) {
      in_.demand_of_dataset("five lines of identification");
      if (i == 0) f.name = std::string(trim(in_.get_line()));
    }
    // 2(I5,I10), 2(1X,10A1,I10,I4)
    in_.demand_of_dataset("the type of the function");
    const char* expected = "type, number, response and reference of the function";
    const long type = read_column(in_, 0, 5, expected);
    f.load_case = static_cast<int>(read_column(in_, 20, 10, expected));
    f.node = static_cast<int>(read_column(in_, 41, 10, expected));
    f.direction = static_cast<int>(read_column(in_, 51, 4, expected));
    f.reference = static_cast<int>(read_column(in_, 66, 10, expected));
    f.reference_direction = static_cast<int>(read_column(in_, 76, 4, expected));
    // 3I10, 3E13.5
    in_.demand_of_dataset("the form of the data");
    expected = "data type, number of values, spacing";
    const long data = read_column(in_, 0, 10, expected), count = read_column(in_, 10, 10, expected);
    const bool is_even = read_column(in_, 20, 10, expected) == 1;
    const double first = is_even ? read_real_column(in_, 30, 13, "the first frequency") : 0;
    const double step = is_even ? read_real_column(in_, 43, 13, "the step of frequency") : 0;
    in_.demand_of_dataset("the abscissa");
    const long abscissa = read_column(in_, 0, 10, "the type of the abscissa");
    in_.demand_of_dataset("the ordinate");
    f.quantity = static_cast<int>(read_column(in_, 0, 10, "the type of the ordinate"));
    in_.demand_of_dataset("the denominator of the ordinate");
    in_.demand_of_dataset("the third axis");
    const bool is_complex = data == 5 || data == 6;
    const bool is_response = (type == kFrequencyResponse || type == kSpectrum) && abscissa == kFrequency && is_complex;
    if (!is_response) return in_.skip_dataset();
    if (count < 1 || static_cast<std::size_t>(count) > in_.count_most(1))
      in_.fail("matrices.uff",
               "the function of line " + std::to_string(f.line) + " has " + std::to_string(count) + " values",
               "export the function again");
    if (is_even && !(step > 0) && count > 1)
      in_.fail("matrices.uff", "the function of line " + std::to_string(f.line) + " has a step that is not positive",
               "export the function again");
    const auto n = static_cast<std::size_t>(count), each = is_even ? std::size_t{2} : std::size_t{3};
    const auto values = read_values(n * each, is_even, is_complex, data == 6);
    f.hz.resize(count);
    f.value.resize(count);
    for (std::size_t i = 0; i < n; ++i) {
      const auto* at = &values[each * i];
      const auto k = static_cast<Eigen::Index>(i);
      f.hz[k] = is_even ? first + static_cast<double>(i) * step : at[0];
      f.value[k] = {at[each - 2], at[each - 1]};
      if (i > 0 && !(f.hz[k] > f.hz[k - 1]))
        in_.fail("matrices.uff", "the frequencies of the function of line " + std::to_string(f.line) + " do not ascend",
                 "export the function again");
    }
    functions_.push_back(std::move(f));
    in_.skip_dataset();
  }

  UffInput in_;
  std::vector<TestFunction> functions_;
};

}  // namespace

std::vector<TestFunction> read_test_functions(const std::string& path) { return FunctionReader(path).read(); }

}  // namespace bough::matrices
