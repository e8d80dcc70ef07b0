#include "analysis/frequency/notching.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "base/diagnostic.hpp"
#include "base/platform.hpp"
#include "formats/export/random_text.hpp"
#include "formats/export/response_text.hpp"

namespace bough::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

[[noreturn]] void fail(const std::string& what, const std::string& advice) {
  throw InputError("cli.bad-notch", {}, what, advice);
}

double read_number(std::string_view word, const std::string& text) {
  double value = 0;
  const auto [end, code] = platform::read_number(word.data(), word.data() + word.size(), value);
  if (word.empty() || code != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    fail(fmt::format("cannot read \"{}\": \"{}\" is not a number", text, word),
         "write --limit acceleration:12:3=80, --limit acceleration:12:3=80@20:100 or --notch 20:40=0.5");
  return value;
}

/// MIN:MAX, ascending.
void read_range(std::string_view word, const std::string& text, double& min_hz, double& max_hz) {
  const auto colon = word.find(':');
  if (colon == std::string_view::npos) fail(fmt::format("\"{}\" has no range MIN:MAX", text), "write 20:100, in Hz");
  min_hz = read_number(word.substr(0, colon), text);
  max_hz = read_number(word.substr(colon + 1), text);
  if (!(min_hz >= 0 && max_hz > min_hz))
    fail(fmt::format("\"{}\": the range from {} to {} Hz is empty", text, min_hz, max_hz),
         "give the lower frequency first");
}

bool is_in(double hz, double min_hz, double max_hz) { return hz >= min_hz && hz <= max_hz; }

/// Lowers the factor of frequency i to `factor`.
void lower(double factor, const std::string& by, Index i, VectorXd& factors, std::vector<std::string>& names) {
  if (!(factor < factors[i])) return;
  factors[i] = factor;
  names[static_cast<std::size_t>(i)] = by;
}

void scale_rows(const VectorXd& factor, Eigen::MatrixXd& values) {
  if (values.rows() == factor.size()) values = factor.asDiagonal() * values;
}

/// Multiplies the input of a subcase.
void apply(const VectorXd& factor, records::ResponseSubcase& subcase, Notch& notch) {
  for (auto& curves : subcase.curves) {
    scale_rows(factor, curves.real);
    scale_rows(factor, curves.imag);
  }
  for (auto* elements : {&subcase.elements, &subcase.listed_forces})
    for (auto& curves : *elements) {
      scale_rows(factor, curves.real);
      scale_rows(factor, curves.imag);
    }
  notch.factor = notch.factor.cwiseProduct(factor);
}

[[noreturn]] void fail_unknown(const NotchLimit& limit, const std::vector<std::string>& names) {
  const auto kind = limit.name.substr(0, limit.name.find(':') + 1);
  std::string near;
  for (const auto& name : names)
    if (near.empty() || (!near.starts_with(kind) && name.starts_with(kind))) near = name;
  fail(fmt::format("the {} has no output \"{}\"", limit.is_density ? "random response" : "frequency response",
                   limit.name),
       near.empty() ? "request outputs in the case control, or by --grid"
                    : fmt::format("request it in the case control or by --grid; names are as {}", near));
}

}  // namespace

bool NotchRequest::has_densities() const {
  return std::any_of(limits.begin(), limits.end(), [](const auto& limit) { return limit.is_density; });
}

NotchLimit read_notch_limit(const std::string& text, bool is_density) {
  NotchLimit limit;
  limit.is_density = is_density;
  const auto equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0)
    fail(fmt::format("cannot read the limit \"{}\"", text), "write NAME=VALUE, as acceleration:12:3=80");
  limit.name = text.substr(0, equals);
  const auto rest = std::string_view(text).substr(equals + 1);
  const auto at = rest.find('@');
  limit.value = read_number(rest.substr(0, at), text);
  if (!(limit.value > 0)) fail(fmt::format("the limit \"{}\" is not positive", text), "give a positive value");
  if (at != std::string_view::npos) read_range(rest.substr(at + 1), text, limit.min_hz, limit.max_hz);
  return limit;
}

NotchBand read_notch_band(const std::string& text) {
  NotchBand band;
  const auto equals = text.find('=');
  if (equals == std::string::npos)
    fail(fmt::format("cannot read the notch \"{}\"", text), "write MIN:MAX=FACTOR, as 20:40=0.5");
  read_range(std::string_view(text).substr(0, equals), text, band.min_hz, band.max_hz);
  band.factor = read_number(std::string_view(text).substr(equals + 1), text);
  if (!(band.factor > 0 && band.factor <= 1))
    fail(fmt::format("the factor of the notch \"{}\" is not between 0 and 1", text),
         "give the factor of the input's amplitude, above 0 and up to 1");
  return band;
}

std::vector<Notch> make_notches(const std::vector<records::ResponseSubcase>& subcases) {
  std::vector<Notch> notches;
  for (const auto& subcase : subcases)
    notches.push_back({subcase.id, subcase.x, VectorXd::Ones(subcase.x.size()),
                       std::vector<std::string>(static_cast<std::size_t>(subcase.x.size()))});
  return notches;
}

void notch_magnitudes(const NotchRequest& request, std::vector<records::ResponseSubcase>& subcases,
                      std::vector<Notch>& notches) {
  std::vector<bool> is_found(request.limits.size(), false);
  std::vector<std::string> names;
  for (std::size_t s = 0; s < subcases.size(); ++s) {
    const VectorXd& hz = subcases[s].x;
    auto& by = notches[s].by;
    VectorXd factor = VectorXd::Ones(hz.size());
    for (const auto& band : request.bands)
      for (Index i = 0; i < hz.size(); ++i)
        if (is_in(hz[i], band.min_hz, band.max_hz)) lower(band.factor, "band", i, factor, by);
    const auto curves = exports::list_curves(subcases[s]);
    for (const auto& curve : curves) names.push_back(curve.name);
    for (std::size_t k = 0; k < request.limits.size(); ++k) {
      const auto& limit = request.limits[k];
      if (limit.is_density) continue;
      for (const auto& curve : curves) {
        if (curve.name != limit.name) continue;
        is_found[k] = true;
        for (Index i = 0; i < hz.size(); ++i) {
          const double size = std::hypot(curve.real[i], curve.imag[i]);
          if (is_in(hz[i], limit.min_hz, limit.max_hz) && size > 0)
            lower(limit.value / size, limit.name, i, factor, by);
        }
      }
    }
    apply(factor, subcases[s], notches[s]);
  }
  for (std::size_t k = 0; k < is_found.size(); ++k)
    if (!is_found[k] && !request.limits[k].is_density) fail_unknown(request.limits[k], names);
}

void notch_densities(const NotchRequest& request, const std::vector<records::RandomResponse>& random,
                     std::vector<records::ResponseSubcase>& subcases, std::vector<Notch>& notches) {
  std::vector<bool> is_found(request.limits.size(), false);
  std::vector<std::string> names;
  std::map<int, VectorXd> factors;  // by subcase
  std::map<int, std::vector<std::string>> by;
  for (const auto& notch : notches) by[notch.subcase] = notch.by;
  for (const auto& one : random) {
    const auto outputs = exports::list_random_outputs(one);
    for (const auto& output : outputs) names.push_back(output.name);
    for (std::size_t k = 0; k < request.limits.size(); ++k) {
      const auto& limit = request.limits[k];
      if (!limit.is_density) continue;
      for (const auto& output : outputs) {
        if (output.name != limit.name) continue;
        is_found[k] = true;
        for (const int id : one.subcases) {
          auto& factor = factors.try_emplace(id, VectorXd::Ones(one.hz.size())).first->second;
          for (Index i = 0; i < one.hz.size() && factor.size() == one.hz.size(); ++i) {
            const double density = output.curves->psd(i, output.column);
            if (is_in(one.hz[i], limit.min_hz, limit.max_hz) && density > 0)
              lower(std::sqrt(limit.value / density), limit.name, i, factor, by[id]);
          }
        }
      }
    }
  }
  for (std::size_t k = 0; k < is_found.size(); ++k)
    if (!is_found[k] && request.limits[k].is_density) fail_unknown(request.limits[k], names);
  for (std::size_t s = 0; s < subcases.size(); ++s) {
    const auto factor = factors.find(subcases[s].id);
    if (factor == factors.end() || factor->second.size() != subcases[s].x.size()) continue;
    apply(factor->second, subcases[s], notches[s]);
    notches[s].by = by[subcases[s].id];
  }
}

}  // namespace bough::analysis
