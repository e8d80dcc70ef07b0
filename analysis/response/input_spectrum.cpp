#include "analysis/response/input_spectrum.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>

#include "analysis/common/inputs.hpp"
#include "analysis/common/spectrum_file.hpp"
#include "formats/toml/specs.hpp"

namespace bough::analysis {

namespace {

using Eigen::Index;
using records::InputDensity;
using Term = statespace::InputSpectrum::Term;

std::optional<double> read_number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') return {};
  return value;
}

/// "NUMBER" or "NAME=NUMBER"; nothing: the item is a file.
std::optional<InputDensity> read_constant(const std::string& item, const std::string& file) {
  const auto sign = item.rfind('=');
  const auto value = read_number(sign == std::string::npos ? item : item.substr(sign + 1));
  if (!value) return {};
  InputDensity term;
  if (sign != std::string::npos) term.input = item.substr(0, sign);
  term.real = {*value};
  term.at = {file};
  if (!std::isfinite(*value) || *value < 0)
    throw InputError("linear.bad-psd", {file}, fmt::format("--psd {}: the density is {}", item, *value),
                     "give a finite number of zero or above");
  return term;
}

/// Rows of the inputs with this name or these components.
std::vector<Index> find_inputs(const std::string& name, const records::Signals& known) {
  std::vector<Index> found;
  for (int i = 0; i < known.size(); ++i) {
    const auto& one = known.name[static_cast<std::size_t>(i)];
    if (name.empty() || one == name || one.starts_with(name + ":")) found.push_back(i);
  }
  return found;
}

void report_unknown(const InputDensity& term, const std::string& name, const records::Signals& known,
                    Diagnostics& diagnostics) {
  const auto near = find_nearest(name, known.name);
  diagnostics.error(
      "linear.unknown-input", term.at, fmt::format("there is no input '{}'", name),
      !near.empty() ? "did you mean '" + near + "'?" : fmt::format("the model has {}", fmt::join(known.name, ", ")));
}

Term make_term(const InputDensity& given, Index a, Index b) {
  Term term{a, b, Eigen::VectorXd(static_cast<Index>(given.frequency_hz.size())),
            Eigen::VectorXcd(static_cast<Index>(given.real.size())), given.is_log};
  std::copy(given.frequency_hz.begin(), given.frequency_hz.end(), term.frequency_hz.begin());
  for (Index k = 0; k < term.density.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    term.density[k] = {given.real[at], given.imag.empty() ? 0 : given.imag[at]};
  }
  return term;
}

std::vector<Term> read_table(const std::string& path, const records::Signals& known) {
  const auto spectrum = read_spectrum(path, known.name, "linear.bad-psd");
  std::vector<Term> terms;
  for (Index j = 0; j < known.size(); ++j)
    terms.push_back({j, j, spectrum.frequency_hz,
                     spectrum.density.col(spectrum.density.cols() == 1 ? 0 : j).cast<std::complex<double>>(), false});
  return terms;
}

class Reader {
 public:
  Reader(const records::Signals& known, Diagnostics& diagnostics) : known_(known), diagnostics_(diagnostics) {}

  /// \param name  of the density in messages; empty: its line or file.
  void add(const InputDensity& given, const std::string& name = {}) {
    const auto rows = find_inputs(given.input, known_);
    if (rows.empty()) report_unknown(given, given.input, known_, diagnostics_);
    if (given.with.empty() || given.with == given.input) {
      for (const Index row : rows) add_auto(make_term(given, row, row), given.at, name);
      return;
    }
    const auto columns = find_inputs(given.with, known_);
    if (columns.empty()) report_unknown(given, given.with, known_, diagnostics_);
    if (rows.empty() || columns.empty()) return;
    if (rows.size() > 1 || columns.size() > 1)
      diagnostics_.error("linear.bad-psd", given.at,
                         fmt::format("'{}' with '{}' are several inputs", given.input, given.with),
                         "name one component each");
    else
      add_cross(given, rows[0], columns[0]);
  }
  void add(const std::vector<Term>& terms, const SourceLocation& at) {
    for (const auto& term : terms) add_auto(term, at, {});
  }
  const std::vector<Term>& terms() const { return terms_; }

 private:
  /// One density for each input; a column of zeros is none.
  void add_auto(const Term& term, const SourceLocation& at, const std::string& name) {
    terms_.push_back(term);
    if (term.density.isZero(0)) return;
    const auto source = !name.empty() ? name
                        : at.line > 0 ? fmt::format("line {} of '{}'", at.line, at.file)
                                      : fmt::format("'{}'", at.file);
    const auto [other, is_first] = sources_.emplace(term.a, source);
    if (is_first) return;
    diagnostics_.error("linear.bad-psd", at,
                       fmt::format("the spectral density of '{}' is given twice, by {} and {}",
                                   known_.name[static_cast<std::size_t>(term.a)], other->second, source),
                       "give one density for each input; that of uncorrelated sources is their sum");
  }

  /// S_ab once, or S_ab and S_ba that are conjugate to each other.
  void add_cross(const InputDensity& given, Index a, Index b) {
    const auto term = make_term(given, a, b);
    const auto [other, is_first] = crosses_.emplace(std::minmax(a, b), std::pair(term, given.at));
    if (is_first) return terms_.push_back(term);
    const auto& [before, at] = other->second;
    if (before.a == a)
      diagnostics_.error("linear.bad-psd", given.at,
                         fmt::format("the cross-spectral density of '{}' with '{}' is given in line {} too",
                                     given.input, given.with, at.line),
                         "remove one of them");
    else if (before.frequency_hz.size() != term.frequency_hz.size() || before.frequency_hz != term.frequency_hz ||
             before.density != term.density.conjugate())
      diagnostics_.error("linear.bad-psd", given.at,
                         fmt::format("the spectral densities are not Hermitian: '{}' with '{}' is not the conjugate of "
                                     "'{}' with '{}' of line {}",
                                     given.input, given.with, given.with, given.input, at.line),
                         "remove one of them");
  }

  const records::Signals& known_;
  Diagnostics& diagnostics_;
  std::vector<Term> terms_;
  std::map<Index, std::string> sources_;
  std::map<std::pair<Index, Index>, std::pair<Term, SourceLocation>> crosses_;
};

}  // namespace

statespace::InputSpectrum read_input_spectrum(const std::vector<std::string>& items, const records::LinearModel& model,
                                              const std::string& file) {
  Diagnostics diagnostics;
  Reader reader(model.inputs, diagnostics);
  for (const auto& item : items) {
    if (const auto constant = read_constant(item, file)) {
      reader.add(*constant, "--psd " + item);
      continue;
    }
    demand_file(item);
    if (!has_suffix(item, ".toml"))
      reader.add(read_table(item, model.inputs), {item});
    else
      for (const auto& term : toml_files::read_input_densities(item, diagnostics)) reader.add(term);
  }
  diagnostics.throw_if_errors();
  return {model.B.cols(), reader.terms()};
}

statespace::InputSpectrum make_input_spectrum(const std::vector<InputDensity>& densities,
                                              const records::LinearModel& model, Diagnostics& diagnostics) {
  Reader reader(model.inputs, diagnostics);
  for (const auto& term : densities) reader.add(term);
  return {model.B.cols(), reader.terms()};
}

std::vector<std::string> list_spectrum_files(const std::vector<std::string>& items) {
  std::vector<std::string> files;
  for (const auto& item : items)
    if (!read_constant(item, {})) files.push_back(item);
  return files;
}

void check_input_spectrum(const statespace::InputSpectrum& input, const std::vector<double>& hz,
                          const std::vector<std::string>& items, const std::string& file) {
  auto all = input.list_corners();
  all.insert(all.end(), hz.begin(), hz.end());
  const auto worst = input.find_indefinite(all);
  if (!worst) return;
  const auto files = list_spectrum_files(items);
  throw InputError(
      "linear.bad-psd", {files.empty() ? file : files.front()},
      fmt::format("the matrix of spectral densities of the inputs is not positive semi-definite at {:g} Hz", *worst),
      "keep |S_ab|^2 at or below S_aa S_bb");
}

void choose_band(const records::LinearModel& model, const statespace::InputSpectrum& input,
                 statespace::FrequencyRange& range) {
  const double nyquist = model.sample_time > 0 ? 0.5 / model.sample_time : std::numeric_limits<double>::infinity();
  const bool is_open = range.from_hz <= 0;
  if (const auto band = input.get_range()) {
    if (range.from_hz <= 0) range.from_hz = band->first;
    if (range.to_hz <= 0) range.to_hz = std::min(band->second, nyquist);
  }
  bool has_origin = false;
  for (Eigen::Index i = 0; i < model.poles.size(); ++i)
    if (std::hypot(model.poles.real[i], model.poles.imag[i]) <= records::calc_origin_radius(model.poles, i))
      has_origin = true;
  const double max_hz = range.to_hz > 0 ? range.to_hz : nyquist;
  for (const double hz : input.list_corners())
    if (hz > 0 && (is_open || hz >= range.from_hz) && hz <= max_hz) range.corners_hz.push_back(hz);
  if (is_open && range.from_hz <= 0 && !has_origin) range.corners_hz.push_back(0);
}

}  // namespace bough::analysis
