#include <algorithm>

#include "formats/toml/detail/density_table.hpp"
#include "formats/toml/detail/fields.hpp"
#include "formats/toml/detail/schema.hpp"
#include "formats/toml/detail/text_columns.hpp"
#include "formats/toml/specs.hpp"

namespace bough::toml_files {

namespace {

void wrong(const SourceLocation& at, const std::string& what, const std::string& advice, Diagnostics& diagnostics) {
  diagnostics.error("linear.bad-psd", at, what, advice);
}

void check_lengths(const Fields& table, const records::InputDensity& term, Diagnostics& diagnostics) {
  const std::size_t size = std::max<std::size_t>(1, term.frequency_hz.size());
  const auto check = [&](const char* key, const std::vector<double>& values) {
    if (!table.has(key) || values.size() == size) return;
    wrong(table.locate(key),
          std::string(key) + " has " + std::to_string(values.size()) + " numbers, expected " + std::to_string(size) +
              (term.frequency_hz.empty() ? " without frequency_hz" : ", one for each frequency_hz"),
          "give as many numbers as frequencies", diagnostics);
  };
  check("density", term.real);
  check("imaginary", term.imag);
}

void check_values(const Fields& table, const records::InputDensity& term, Diagnostics& diagnostics) {
  const bool is_auto = term.with.empty() || term.with == term.input;
  const char* key = table.has("file") ? "file" : "density";
  if (is_auto && std::any_of(term.real.begin(), term.real.end(), [](double value) { return value < 0; }))
    wrong(table.locate(key), "the auto-spectral density of input '" + term.input + "' is negative",
          "give values of zero or above", diagnostics);
  if (is_auto && std::any_of(term.imag.begin(), term.imag.end(), [](double value) { return value != 0; }))
    wrong(table.locate("imaginary"),
          "the spectral densities are not Hermitian: the auto-spectral density of input '" + term.input +
              "' has an imaginary part",
          "remove imaginary, or name another input by with", diagnostics);
  for (std::size_t k = 1; k < term.frequency_hz.size(); ++k)
    if (!(term.frequency_hz[k] > term.frequency_hz[k - 1])) {
      wrong(table.locate(table.has("file") ? "file" : "frequency_hz"), "the frequencies do not rise",
            "give them in ascending order", diagnostics);
      break;
    }
  if (!term.is_log) return;
  const bool has_zero = std::any_of(term.real.begin(), term.real.end(), [](double value) { return !(value > 0); });
  if (!is_auto || term.frequency_hz.empty() || !(term.frequency_hz.front() > 0) || has_zero)
    wrong(table.locate("interpolation"),
          "interpolation = \"log\" is for auto-spectral densities above 0 at frequencies "
          "above 0",
          "set interpolation = \"linear\"", diagnostics);
}

}  // namespace

records::InputDensity read_density(const Fields& table, const std::string& path, Diagnostics& diagnostics) {
  records::InputDensity term;
  term.at = table.locate();
  term.input = table.get_string("input");
  term.with = table.get_string("with");
  term.is_log = table.get_string("interpolation") == "log";
  if (table.has("file")) {
    refuse_keys(table, {"frequency_hz", "imaginary"}, "if there is file", diagnostics);
    read_columns(resolve_path(path, table.get_string("file")), table.locate("file"), {}, term.frequency_hz, term.real,
                 diagnostics);
  } else {
    term.frequency_hz = table.get_numbers("frequency_hz");
    term.real = table.get_numbers("density");
    term.imag = table.get_numbers("imaginary");
    check_lengths(table, term, diagnostics);
  }
  check_values(table, term, diagnostics);
  return term;
}

bool read_checked(const std::string& path, const char* schema_text, Value& root, Diagnostics& diagnostics) {
  std::string text;
  if (!read_text(path, text, diagnostics) || !parse_toml(text, path, root, diagnostics)) return false;
  const int errors = diagnostics.num_errors();
  check_schema(root, schema_text, path, diagnostics);
  return diagnostics.num_errors() == errors;
}

std::vector<records::InputDensity> read_input_densities(const std::string& path, Diagnostics& diagnostics) {
  std::vector<records::InputDensity> terms;
  Value root;
  if (!read_checked(path, get_psd_schema(), root, diagnostics)) return terms;
  for (const Fields& table : Fields(root, path).get_tables("psd"))
    terms.push_back(read_density(table, path, diagnostics));
  return terms;
}

}  // namespace bough::toml_files
