#include "formats/export/response_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <sstream>
#include <tuple>

#include "base/phase.hpp"
#include "formats/export/random_text.hpp"
#include "formats/records/group_names.hpp"

namespace bough::exports {
namespace {

using records::ResponseSubcase;

/// Lines of 72 columns, each followed by its number.
class PunchLines {
 public:
  void add(const std::string& line) {
    char number[16];
    std::snprintf(number, sizeof number, "%8d", ++count_);
    std::string padded = line.substr(0, 72);
    padded.resize(72, ' ');
    text_ += padded + number + "\n";
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
  int count_ = 0;
};

std::string format_value(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%18.6E", value);
  return text;
}

/// The values of one point at one sample, three to a line.
void add_values(const std::string& head, const std::vector<double>& values, PunchLines& lines) {
  for (std::size_t i = 0; i < values.size() || i == 0; i += 3) {
    std::string line = i == 0 ? head : "-CONT-            ";
    for (std::size_t k = i; k < std::min(i + 3, values.size()); ++k) line += format_value(values[k]);
    lines.add(line);
  }
}

struct Block {
  const char* title;
  bool is_phase;
  std::string who;  ///< POINT ID or ELEMENT ID
  int id;
  char kind;  ///< G a grid, S a scalar point, blank an element
};

void add_block(const ResponseSubcase& s, const Block& block, const Eigen::MatrixXd& real, const Eigen::MatrixXd& imag,
               PunchLines& lines) {
  const bool is_over_time = imag.size() == 0;
  lines.add("$TITLE   = " + s.title);
  lines.add("$SUBTITLE= " + s.subtitle);
  lines.add("$LABEL   = " + s.label);
  lines.add(std::string("$") + block.title);
  lines.add(is_over_time ? "$REAL OUTPUT" : block.is_phase ? "$MAGNITUDE-PHASE OUTPUT" : "$REAL-IMAGINARY OUTPUT");
  char text[96];
  std::snprintf(text, sizeof text, "$SUBCASE ID = %11d", std::max(s.id, 1));
  lines.add(text);
  std::snprintf(text, sizeof text, "$%s = %11d  IDENTIFIED BY %s", block.who.c_str(), block.id,
                is_over_time ? "TIME" : "FREQUENCY");
  lines.add(text);
  for (Eigen::Index i = 0; i < s.x.size(); ++i) {
    std::snprintf(text, sizeof text, "%16.6E %c", s.x(i), block.kind);
    std::vector<double> values;
    for (Eigen::Index c = 0; c < real.cols(); ++c)
      values.push_back(!is_over_time && block.is_phase ? to_polar(real(i, c), imag(i, c)).first : real(i, c));
    while (block.kind != ' ' && values.size() % 3 != 0) values.push_back(0);
    for (Eigen::Index c = 0; c < imag.cols(); ++c) {
      const std::complex<double> z(real(i, c), imag(i, c));
      values.push_back(block.is_phase ? calc_phase_degrees(z, kListedPhase) : z.imag());
    }
    while (block.kind != ' ' && values.size() % 3 != 0) values.push_back(0);
    add_values(text, values, lines);
  }
}

const char* get_punch_title(const std::string& quantity);

void add_random_head(const std::string& title, const ResponseSubcase* subcase, int id, PunchLines& lines) {
  lines.add("$TITLE   = " + (subcase ? subcase->title : ""));
  lines.add("$SUBTITLE= " + (subcase ? subcase->subtitle : ""));
  lines.add("$LABEL   = " + (subcase ? subcase->label : ""));
  lines.add("$" + title);
  lines.add("$REAL OUTPUT");
  char text[96];
  std::snprintf(text, sizeof text, "$SUBCASE ID = %11d", id);
  lines.add(text);
}

/// Spectral densities, running RMS and autocorrelation by point, RMS and N0 of all points; with `chosen_only` of the
/// quantities that the subcase punches.
void add_random(const records::DeckResponse& response, const records::RandomResponse& random, bool chosen_only,
                PunchLines& lines) {
  const int id = random.subcases.empty() ? 1 : random.subcases.front();
  const auto found = std::find_if(response.subcases.begin(), response.subcases.end(),
                                  [id](const auto& s) { return std::max(s.id, 1) == id; });
  const auto* subcase = found == response.subcases.end() ? nullptr : &*found;
  for (const auto& curves : random.curves) {
    const auto is_chosen = [&](const auto& of) { return of.quantity == curves.quantity && of.is_punched; };
    if (!curves.card.empty()) continue;
    if (chosen_only && (!subcase || std::none_of(subcase->curves.begin(), subcase->curves.end(), is_chosen))) continue;
    const std::string name = get_punch_title(curves.quantity);
    const Eigen::MatrixXd cumulative = records::calc_cumulative_rms(random, curves);
    const auto take_six = [](const auto& values) {
      std::vector<double> six(values.begin(), values.end());
      while (six.size() % 3 != 0) six.push_back(0);
      return six;
    };
    const auto for_each_point = [&](const auto& add) {
      for (std::size_t first = 0, last = 0; first < curves.dofs.size(); first = last) {
        while (last < curves.dofs.size() && curves.dofs[last].first == curves.dofs[first].first) ++last;
        add(curves.dofs[first].first, static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(last - first));
      }
    };
    const auto add_curves = [&](const char* what, const char* by, const Eigen::VectorXd& at,
                                const Eigen::MatrixXd& values) {
      if (values.size() == 0) return;
      for_each_point([&](int point, Eigen::Index first, Eigen::Index count) {
        char text[96];
        add_random_head(name + " - " + what, subcase, id, lines);
        std::snprintf(text, sizeof text, "$POINT ID = %11d  IDENTIFIED BY %s", point, by);
        lines.add(text);
        for (Eigen::Index i = 0; i < at.size(); ++i) {
          std::snprintf(text, sizeof text, "%16.6E %c", at(i), count == 1 ? 'S' : 'G');
          add_values(text, take_six(values.row(i).segment(first, count)), lines);
        }
      });
    };
    const auto add_rows = [&](const char* what, const Eigen::VectorXd& values) {
      add_random_head(name + " - " + what, subcase, id, lines);
      for_each_point([&](int point, Eigen::Index first, Eigen::Index count) {
        char text[96];
        std::snprintf(text, sizeof text, "%10d       %c", point, count == 1 ? 'S' : 'G');
        add_values(text, take_six(values.segment(first, count)), lines);
      });
    };
    add_curves("PSDF", "FREQUENCY", random.hz, curves.psd);
    add_curves("CRMS", "FREQUENCY", random.hz, cumulative);
    add_curves("AUTO", "TIME", random.lags, curves.autocorrelation);
    add_rows("RMS", curves.rms);
    add_rows("NO", curves.crossing_hz);
  }
}

const char* get_punch_title(const std::string& quantity) {
  if (quantity == "displacement") return "DISPLACEMENTS";
  if (quantity == "velocity") return "VELOCITY";
  if (quantity == "acceleration") return "ACCELERATION";
  return "SPCF";
}

template <class Curves>
bool has_punched(const std::vector<Curves>& all) {
  return std::any_of(all.begin(), all.end(), [](const auto& curves) { return curves.is_punched; });
}

}  // namespace

std::pair<double, double> to_polar(double real, double imag) {
  return {std::hypot(real, imag), std::atan2(imag, real) * 180 / std::numbers::pi};
}

CurvePeak find_peak(const NamedCurve& curve, const Eigen::VectorXd& x) {
  CurvePeak peak{&curve, -1, 0, 0};
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const auto [size, phase] = to_polar(curve.real(i), curve.imag.size() > 0 ? curve.imag(i) : 0);
    if (size > peak.size) peak = {&curve, size, x(i), phase};
  }
  return peak;
}

std::vector<NamedCurve> list_curves(const ResponseSubcase& s) {
  std::vector<NamedCurve> all;
  const auto add = [&](const auto& curves, const std::string& quantity, int id, const std::string& component,
                       Eigen::Index column) {
    NamedCurve curve{quantity + ":" + std::to_string(id) + ":" + component,
                     quantity,
                     id,
                     component,
                     curves.is_phase,
                     curves.real.col(column),
                     Eigen::VectorXd(0)};
    if (curves.imag.size() > 0) curve.imag = curves.imag.col(column);
    all.push_back(std::move(curve));
  };
  for (const auto& curves : s.curves)
    for (std::size_t i = 0; i < curves.dofs.size(); ++i)
      add(curves, curves.quantity, curves.dofs[i].first, std::to_string(curves.dofs[i].second),
          static_cast<Eigen::Index>(i));
  for (const auto& curves : s.elements)
    for (std::size_t e = 0; e < curves.ids.size(); ++e)
      for (std::size_t c = 0; c < curves.components.size(); ++c)
        add(curves, records::get_card_of_group(curves.card) + (curves.is_stress ? ":stress" : ""), curves.ids[e],
            curves.components[c], static_cast<Eigen::Index>(e * curves.components.size() + c));
  return all;
}

std::vector<CsvColumn> make_response_columns(const ResponseSubcase& s) {
  std::vector<CsvColumn> columns;
  const auto curves = list_curves(s);
  const bool is_over_time = curves.empty() || curves.front().imag.size() == 0;
  columns.push_back({is_over_time ? "time" : "frequency_hz", s.x});
  for (const auto& curve : curves) {
    if (curve.imag.size() == 0) {
      columns.push_back({curve.name, curve.real});
      continue;
    }
    CsvColumn first{curve.name + (curve.is_phase ? ":magnitude" : ":real"), curve.real};
    CsvColumn second{curve.name + (curve.is_phase ? ":phase_deg" : ":imag"), curve.imag};
    for (Eigen::Index i = 0; curve.is_phase && i < s.x.size(); ++i)
      std::tie(first.values(i), second.values(i)) = to_polar(curve.real(i), curve.imag(i));
    columns.push_back(std::move(first));
    columns.push_back(std::move(second));
  }
  return columns;
}

std::string make_response_csv(const records::DeckResponse& response) {
  std::ostringstream text;
  for (const auto& subcase : response.subcases) {
    auto columns = make_response_columns(subcase);
    if (response.subcases.size() > 1) {
      if (&subcase != &response.subcases.front()) text << "\n";
      const auto rows = columns.front().values.size();
      columns.insert(columns.begin(), {"subcase", Eigen::VectorXd::Constant(rows, subcase.id)});
    }
    write_csv(text, columns);
  }
  for (const auto& random : response.random)
    for (const auto& columns : {make_psd_columns(random), make_autocorrelation_columns(random),
                                make_cross_columns(random), make_correlation_columns(random)}) {
      if (columns.empty()) continue;
      text << "\n";
      write_csv(text, columns);
    }
  for (const auto& random : response.random) text << "\n" << make_rms_csv(random);
  return text.str();
}

std::string make_punch_text(const records::DeckResponse& response) {
  const bool chosen_only = std::any_of(response.subcases.begin(), response.subcases.end(),
                                       [](const auto& s) { return has_punched(s.curves) || has_punched(s.elements); });
  PunchLines lines;
  for (const auto& s : response.subcases) {
    for (const auto& curves : s.curves) {
      if (chosen_only && !curves.is_punched) continue;
      for (std::size_t first = 0, last = 0; first < curves.dofs.size(); first = last) {
        while (last < curves.dofs.size() && curves.dofs[last].first == curves.dofs[first].first) ++last;
        const auto at = static_cast<Eigen::Index>(first), count = static_cast<Eigen::Index>(last - first);
        const Block block{get_punch_title(curves.quantity), curves.is_phase, "POINT ID", curves.dofs[first].first,
                          count == 1 ? 'S' : 'G'};
        add_block(s, block, curves.real.middleCols(at, count),
                  curves.imag.size() > 0 ? Eigen::MatrixXd(curves.imag.middleCols(at, count)) : curves.imag, lines);
      }
    }
    for (const auto& curves : s.elements) {
      if (chosen_only && !curves.is_punched) continue;
      const auto count = static_cast<Eigen::Index>(curves.components.size());
      for (std::size_t e = 0; e < curves.ids.size(); ++e) {
        const auto at = static_cast<Eigen::Index>(e) * count;
        const std::string title = (curves.is_stress ? "ELEMENT STRESSES OF " : "ELEMENT FORCES OF ") +
                                  records::get_card_of_group(curves.card);
        add_block(s, {title.c_str(), curves.is_phase, "ELEMENT ID", curves.ids[e], ' '},
                  curves.real.middleCols(at, count),
                  curves.imag.size() > 0 ? Eigen::MatrixXd(curves.imag.middleCols(at, count)) : curves.imag, lines);
      }
    }
  }
  for (const auto& random : response.random) add_random(response, random, chosen_only, lines);
  return lines.take();
}

}  // namespace bough::exports
