#include "report/svg_plot.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "base/diagnostic.hpp"
#include "base/xml_text.hpp"
#include "report/axis.hpp"
#include "report/label.hpp"
#include "report/thin.hpp"

namespace bough::report {

namespace {

// Okabe & Ito, "Color universal design" (2008), without yellow, which is faint on white; black last.
constexpr std::array<const char*, 7> kColors{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                             "#56B4E9", "#E69F00", "#000000"};
constexpr std::array<const char*, 3> kDashes{"", "8 4", "2 3"};
constexpr double kWidth = 900, kLeft = 84, kRight = 26, kPlotHeight = 400, kBottom = 62;
constexpr double kEqualHeight = 600;  // of plots with one scale for both axes, as the z plane
constexpr double kCharacter = 7.2;    // mean width of a character of the legend

std::string number(double x) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.2f", x);
  std::string text(buffer);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::size_t count_characters(const std::string& utf8) {
  return static_cast<std::size_t>(
      std::count_if(utf8.begin(), utf8.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string write_label(const std::string& label, int exponent) {
  std::string text = escape_xml(write_powers(label));
  if (exponent != 0) {
    std::string power = std::to_string(exponent);
    if (power[0] == '-') power.replace(0, 1, "\u2212");
    text += " (\u00d710<tspan dy=\"-5\" font-size=\"10\">" + power + "</tspan><tspan dy=\"5\">)</tspan>";
  }
  return text;
}

struct Frame {
  double left, top, width, height;
  Axis x, y;
  double map_x(double v) const { return left + (v - x.min) / (x.max - x.min) * width; }
  double map_y(double v) const { return top + (y.max - v) / (y.max - y.min) * height; }
};

/// The part of segment a-b inside [0,1]², as fractions of it (Liang & Barsky 1984); false when there is none.
bool clip_segment(double ax, double ay, double bx, double by, double& from, double& to) {
  from = 0;
  to = 1;
  const double p[4] = {-(bx - ax), bx - ax, -(by - ay), by - ay};
  const double q[4] = {ax, 1 - ax, ay, 1 - ay};
  for (int i = 0; i < 4; ++i) {
    if (p[i] == 0) {
      if (q[i] < 0) return false;
      continue;
    }
    const double r = q[i] / p[i];
    if (p[i] < 0)
      from = std::max(from, r);
    else
      to = std::min(to, r);
  }
  return from <= to;
}

/// SVG path of a curve, cut at the frame and broken at values that are not finite.
std::string draw_line(const Curve& curve, const Frame& f) {
  std::string path;
  double last_x = std::numeric_limits<double>::quiet_NaN(), last_y = last_x;
  auto unit_x = [&](double v) { return (v - f.x.min) / (f.x.max - f.x.min); };
  auto unit_y = [&](double v) { return (v - f.y.min) / (f.y.max - f.y.min); };
  auto put = [&](const char* command, double ux, double uy) {
    path += command + number(f.left + ux * f.width) + " " + number(f.top + (1 - uy) * f.height);
  };
  for (Eigen::Index i = 0; i + 1 < curve.x.size(); ++i) {
    const double ax = unit_x(curve.x[i]), ay = unit_y(curve.y[i]);
    const double bx = unit_x(curve.x[i + 1]), by = unit_y(curve.y[i + 1]);
    double from = 0, to = 1;
    if (!std::isfinite(ax + ay + bx + by) || !clip_segment(ax, ay, bx, by, from, to)) continue;
    const double x0 = ax + from * (bx - ax), y0 = ay + from * (by - ay);
    const double x1 = ax + to * (bx - ax), y1 = ay + to * (by - ay);
    if (x0 != last_x || y0 != last_y) put("M", x0, y0);
    put("L", x1, y1);
    last_x = x1;
    last_y = y1;
  }
  return path;
}

/// At most some points per pixel column, keeping the extremes: long histories stay small and look the same.
Curve thin_out(const Curve& curve) {
  constexpr Eigen::Index kMaxSamples = 6000;
  const Eigen::Index n = curve.x.size();
  if (n <= kMaxSamples || curve.markers_only || !curve.y.allFinite()) return curve;
  std::vector<Eigen::Index> keep;
  const auto ends = split_samples(curve.x, kMaxSamples / 4);
  for (std::size_t b = 0; b + 1 < ends.size(); ++b) {
    const Eigen::Index first = ends[b], size = ends[b + 1] - first;
    Eigen::Index low = 0, high = 0;
    curve.y.segment(first, size).minCoeff(&low);
    curve.y.segment(first, size).maxCoeff(&high);
    std::array<Eigen::Index, 4> some{first, first + std::min(low, high), first + std::max(low, high), first + size - 1};
    keep.insert(keep.end(), some.begin(), some.end());
  }
  keep.erase(std::unique(keep.begin(), keep.end()), keep.end());
  Curve thin = curve;
  thin.x = curve.x(keep);
  thin.y = curve.y(keep);
  return thin;
}

struct Range {
  double min = std::numeric_limits<double>::infinity(), max = -std::numeric_limits<double>::infinity();
  void add(const Eigen::VectorXd& values) {
    for (const double v : values) {
      if (!std::isfinite(v)) continue;
      min = std::min(min, v);
      max = std::max(max, v);
    }
  }
  bool is_empty() const { return min > max; }
};

std::string draw_axes(const Plot& plot, const Frame& f) {
  std::string svg = "<g stroke=\"#d9d9d9\" stroke-width=\"1\">\n";
  for (const double t : f.x.ticks) {
    svg += "<path d=\"M" + number(f.map_x(t)) + " " + number(f.top) + "V" + number(f.top + f.height) + "\"/>\n";
  }
  for (const double t : f.y.ticks) {
    svg += "<path d=\"M" + number(f.left) + " " + number(f.map_y(t)) + "H" + number(f.left + f.width) + "\"/>\n";
  }
  svg += "</g>\n";
  if (!plot.has_log_y && f.y.min < 0 && f.y.max > 0) {
    svg += "<path d=\"M" + number(f.left) + " " + number(f.map_y(0)) + "H" + number(f.left + f.width) +
           "\" stroke=\"#888888\" stroke-width=\"1\"/>\n";
  }
  // The boundary of stability of poles.
  if (plot.has_zero_x && f.x.min < 0 && f.x.max > 0) {
    svg += "<path d=\"M" + number(f.map_x(0)) + " " + number(f.top) + "V" + number(f.top + f.height) +
           "\" stroke=\"#888888\" stroke-width=\"1\"/>\n";
  }
  svg += "<g font-size=\"13\" fill=\"#333333\">\n";
  for (std::size_t i = 0; i < f.x.ticks.size(); ++i) {
    svg += "<text x=\"" + number(f.map_x(f.x.ticks[i])) + "\" y=\"" + number(f.top + f.height + 19) +
           "\" text-anchor=\"middle\">" + f.x.labels[i] + "</text>\n";
  }
  for (std::size_t i = 0; i < f.y.ticks.size(); ++i) {
    svg += "<text x=\"" + number(f.left - 8) + "\" y=\"" + number(f.map_y(f.y.ticks[i]) + 4.5) +
           "\" text-anchor=\"end\">" + f.y.labels[i] + "</text>\n";
  }
  svg += "</g>\n<g font-size=\"14\" fill=\"#111111\" text-anchor=\"middle\">\n";
  svg += "<text x=\"" + number(f.left + f.width / 2) + "\" y=\"" + number(f.top + f.height + 46) + "\">" +
         write_label(plot.x_label, f.x.exponent) + "</text>\n";
  svg += "<text transform=\"translate(17 " + number(f.top + f.height / 2) + ") rotate(-90)\">" +
         write_label(plot.y_label, f.y.exponent) + "</text>\n</g>\n";
  return svg;
}

/// Boxes of texts inside the frame: one that would cover another moves or is left out.
class TextPlacer {
 public:
  explicit TextPlacer(const Frame& frame) : frame_(frame) {}
  struct Box {
    double left, top, right, bottom;
  };
  /// A line of text; `x` is its left end, `y` its base line.
  static Box make_box(const std::string& text, double x, double y, double font_size) {
    const double width = kCharacter * font_size / 13 * static_cast<double>(count_characters(text));
    return {x - 2, y - font_size, x + width + 2, y + 0.3 * font_size};
  }
  /// A mark that no text covers.
  void reserve(double x, double y, double radius) {
    boxes_.push_back({x - radius, y - radius, x + radius, y + radius});
  }
  /// Takes the place unless the frame cuts it or a text is there.
  bool take(const Box& box) {
    if (box.left < frame_.left || box.right > frame_.left + frame_.width || box.top < frame_.top ||
        box.bottom > frame_.top + frame_.height)
      return false;
    for (const auto& b : boxes_)
      if (box.left < b.right && b.left < box.right && box.top < b.bottom && b.top < box.bottom) return false;
    const auto unit_x = [&](double x) { return (x - box.left) / (box.right - box.left); };
    const auto unit_y = [&](double y) { return (y - box.top) / (box.bottom - box.top); };
    for (const auto& [ax, ay, bx, by] : line_) {
      double from = 0, to = 1;
      if (clip_segment(unit_x(ax), unit_y(ay), unit_x(bx), unit_y(by), from, to)) return false;
    }
    boxes_.push_back(box);
    return true;
  }

  /// Segments (x, y of both ends) that no text crosses from now on.
  void set_line(std::vector<std::array<double, 4>> line) { line_ = std::move(line); }

 private:
  const Frame& frame_;
  std::vector<Box> boxes_;
  std::vector<std::array<double, 4>> line_;
};

struct PlacedText {
  double x = 0, y = 0;
  bool is_end = false;  ///< x is the right end of the text
};

/// Room next to a point, on either side of it, above or below, up to `lines` lines away.
std::optional<PlacedText> place_text(const std::string& text, double x, double y, double font_size, double gap,
                                     TextPlacer& placer, int lines = 1) {
  const auto size = TextPlacer::make_box(text, 0, 0, font_size);
  const double width = size.right - size.left - 4;
  for (int k = 0; k < 2 * lines; ++k)
    for (const bool is_end : {false, true}) {
      const double more = 1.1 * font_size * (k / 2);
      const double dy = k % 2 == 0 ? gap + 0.65 * font_size + more : -gap - more;
      const PlacedText at{is_end ? x - gap : x + gap, y + dy, is_end};
      if (placer.take(TextPlacer::make_box(text, is_end ? at.x - width : at.x, at.y, font_size))) return at;
    }
  return std::nullopt;
}

std::string write_text(const std::string& text, const PlacedText& at, double font_size, const char* color) {
  return "<text x=\"" + number(at.x) + "\" y=\"" + number(at.y) + "\" font-size=\"" + number(font_size) + "\"" +
         (at.is_end ? " text-anchor=\"end\"" : "") + " fill=\"" + color + "\">" + escape_xml(text) + "</text>\n";
}

/// Segments of the lines of the curves, in pixels; empty if there are more than `max_segments`.
std::vector<std::array<double, 4>> list_segments(const std::vector<Curve>& curves, const Frame& f,
                                                 std::size_t max_segments) {
  std::vector<std::array<double, 4>> segments;
  for (const auto& curve : curves) {
    if (curve.markers_only) continue;
    for (Eigen::Index i = 0; i + 1 < curve.x.size() && segments.size() <= max_segments; ++i) {
      const std::array<double, 4> ends{f.map_x(curve.x[i]), f.map_y(curve.y[i]), f.map_x(curve.x[i + 1]),
                                       f.map_y(curve.y[i + 1])};
      if (std::all_of(ends.begin(), ends.end(), [](double v) { return std::isfinite(v); })) segments.push_back(ends);
    }
  }
  if (segments.size() > max_segments) segments.clear();
  return segments;
}

/// Guides and their labels: next to the last point of each inside the frame, or where else on it there is room.
std::string draw_guides(const Plot& plot, const Frame& f, TextPlacer& placer) {
  std::string svg;
  constexpr std::size_t kMaxSegments = 20000;  // each is tested against each place
  const auto curves = list_segments(plot.curves, f, kMaxSegments);
  for (const auto& guide : plot.guides) {
    svg += "<path d=\"" + draw_line(guide, f) + "\" fill=\"none\" stroke=\"#b0b0b0\" stroke-width=\"1\"/>\n";
    if (guide.label.empty() || guide.x.size() < 2) continue;
    const auto unit_x = [&](double v) { return (v - f.x.min) / (f.x.max - f.x.min); };
    const auto unit_y = [&](double v) { return (v - f.y.min) / (f.y.max - f.y.min); };
    std::vector<std::pair<double, double>> points;
    std::vector<std::array<double, 4>> line;
    std::size_t best = 0;
    for (Eigen::Index i = 0; i + 1 < guide.x.size(); ++i) {
      const double ax = unit_x(guide.x[i]), ay = unit_y(guide.y[i]);
      const double bx = unit_x(guide.x[i + 1]), by = unit_y(guide.y[i + 1]);
      double from = 0, to = 1;
      if (!std::isfinite(ax + ay + bx + by) || !clip_segment(ax, ay, bx, by, from, to)) continue;
      line.push_back({f.map_x(guide.x[i]), f.map_y(guide.y[i]), f.map_x(guide.x[i + 1]), f.map_y(guide.y[i + 1])});
      if (i == 0 || guide.x.size() == 2 || i < guide.x.size() / 2) best = points.size();
      // A ray has room along its way too.
      for (const double share : {1.0, 0.6, 0.7, 0.8, 0.9}) {
        const double s = guide.x.size() == 2 ? from + share * (to - from) : to;
        points.emplace_back(f.left + (ax + s * (bx - ax)) * f.width, f.top + (1 - ay - s * (by - ay)) * f.height);
        if (guide.x.size() > 2) break;
      }
    }
    // From the best one backward, then from the far end; next to all lines, else to its own one, else anywhere.
    for (std::size_t k = 0; k < 3 * points.size(); ++k) {
      if (k == 0) line.insert(line.end(), curves.begin(), curves.end());
      if (k == points.size()) line.resize(line.size() - curves.size());
      if (k == 2 * points.size()) line.clear();
      if (k % points.size() == 0) placer.set_line(line);
      const auto& [x, y] = points[(best + 3 * points.size() - k) % points.size()];
      const auto at = place_text(guide.label, x, y, 11, 4, placer);
      if (!at) continue;
      svg += write_text(guide.label, *at, 11, "#777777");
      break;
    }
    placer.set_line({});
  }
  return svg;
}

std::string draw_notes(const Plot& plot, const Frame& f, TextPlacer& placer) {
  std::string svg;
  for (const auto& note : plot.notes) {
    if (note.x < f.x.min || note.x > f.x.max || note.y < f.y.min || note.y > f.y.max) continue;
    const double x = f.map_x(note.x), y = f.map_y(note.y);
    const auto at = place_text(note.text, x, y, 13, 8, placer, 4);
    svg += write_text(note.text, at.value_or(PlacedText{x + 9, y - 8}), 13, "#111111");
  }
  return svg;
}

struct Style {
  const char* color;
  const char* dash;
};
Style get_style(const Plot& plot, std::size_t curve) {
  const int given = plot.curves[curve].style;
  const auto i = given < 0 ? curve : static_cast<std::size_t>(given);
  return {kColors[i % kColors.size()], kDashes[i / kColors.size() % kDashes.size()]};
}

std::string draw_marker(Mark mark, double x, double y, const char* color) {
  if (mark == Mark::None) return "";
  if (mark == Mark::Cross)
    return "<path d=\"M" + number(x - 4.5) + " " + number(y - 4.5) + "l9 9m0 -9l-9 9\" fill=\"none\" stroke=\"" +
           color + "\" stroke-width=\"1.8\"/>\n";
  if (mark == Mark::Ring)
    return "<circle cx=\"" + number(x) + "\" cy=\"" + number(y) + "\" r=\"5.5\" fill=\"none\" stroke=\"" + color +
           "\" stroke-width=\"1.8\"/>\n";
  return "<circle cx=\"" + number(x) + "\" cy=\"" + number(y) + "\" r=\"4\" fill=\"#ffffff\" stroke=\"" + color +
         "\" stroke-width=\"1.8\"/>\n";
}

std::string draw_stroke(const std::string& path, const Style& style) {
  std::string svg = "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + style.color +
                    "\" stroke-width=\"1.8\" stroke-linejoin=\"round\" stroke-linecap=\"round\"";
  if (style.dash[0] != '\0') svg += std::string(" stroke-dasharray=\"") + style.dash + "\"";
  return svg + "/>\n";
}

/// Returns true if a curve, or its line between two points, is in the range of y.
bool is_in_view(const Curve& curve, double y_min, double y_max) {
  double before = std::nan("");
  for (const double y : curve.y) {
    if (y >= y_min && y <= y_max) return true;
    if (!curve.markers_only && ((before < y_min && y > y_max) || (before > y_max && y < y_min))) return true;
    before = y;
  }
  return false;
}

/// Entries in rows between title and frame, of the curves in view; returns the height they take.
double draw_legend(const Plot& plot, double top, std::string& svg) {
  double x = kLeft, y = top;
  bool any = false;
  for (std::size_t i = 0; i < plot.curves.size(); ++i) {
    const std::string label = write_powers(plot.curves[i].label);
    if (label.empty() || (plot.y_max > plot.y_min && !is_in_view(plot.curves[i], plot.y_min, plot.y_max))) continue;
    const double width = 36 + kCharacter * static_cast<double>(count_characters(label)) + 22;
    if (any && x + width > kWidth - kRight) {
      x = kLeft;
      y += 21;
    }
    const Style style = get_style(plot, i);
    svg += plot.curves[i].markers_only ? draw_marker(plot.curves[i].mark, x + 14, y - 4.5, style.color)
                                       : draw_stroke("M" + number(x) + " " + number(y - 4.5) + "h28", style);
    svg += "<text x=\"" + number(x + 36) + "\" y=\"" + number(y) + "\" font-size=\"13\" fill=\"#111111\">" +
           escape_xml(label) + "</text>\n";
    x += width;
    any = true;
  }
  return any ? y - top + 21 : 0;
}

}  // namespace

Plot take_logarithms(Plot plot) {
  const auto take = [](double v) { return v > 0 ? std::log10(v) : std::nan(""); };
  for (auto& curve : plot.curves) {
    if (plot.has_log_x) curve.x = curve.x.unaryExpr(take).eval();
    if (plot.has_log_y) curve.y = curve.y.unaryExpr(take).eval();
  }
  for (auto& guide : plot.guides) {
    if (plot.has_log_x) guide.x = guide.x.unaryExpr(take).eval();
    if (plot.has_log_y) guide.y = guide.y.unaryExpr(take).eval();
  }
  if (plot.has_log_y && plot.y_max > plot.y_min) {
    plot.y_min = take(plot.y_min);
    plot.y_max = take(plot.y_max);
  }
  return plot;
}

std::string draw_svg(const Plot& given) {
  const Plot plot = take_logarithms(given);
  Range x, y;
  for (const auto& curve : plot.curves) {
    BOUGH_DEMAND(curve.x.size() == curve.y.size());
    x.add(curve.x);
    y.add(curve.y);
  }
  if (x.is_empty()) x = {0, 1};
  if (y.is_empty()) y = {0, 1};
  const bool is_given = plot.y_max > plot.y_min;
  // No marker is cut by the frame.
  Range marked;
  for (const auto& curve : plot.curves)
    if (curve.markers_only) marked.add(curve.x);
  if (const double room = 0.015 * (x.max - x.min); !marked.is_empty() && !plot.has_log_x && room > 0) {
    x.min = std::min(x.min, marked.min - room);
    x.max = std::max(x.max, marked.max + room);
  }

  std::string legend;
  const double title_bottom = plot.title.empty() ? 20 : 44;
  const double legend_height = draw_legend(plot, title_bottom + 14, legend);
  const double plot_height = plot.is_equal ? kEqualHeight : kPlotHeight;
  Frame f{kLeft, title_bottom + legend_height + 8, kWidth - kLeft - kRight, plot_height, {}, {}};
  f.x = plot.has_log_x ? make_log_axis(x.min, x.max) : make_axis(x.min, x.max, 9, false, plot.x_step);
  f.y = plot.has_log_y ? (is_given ? make_log_axis(plot.y_min, plot.y_max)
                                   : make_log_axis(y.min - 0.03 * (y.max - y.min), y.max + 0.03 * (y.max - y.min)))
        : is_given     ? make_axis(plot.y_min, plot.y_max, 7, false, plot.y_step)
                       : make_axis(y.min, y.max, 7, true, plot.y_step);

  if (plot.is_equal) {
    const double unit = 1.08 * std::max((x.max - x.min) / f.width, (y.max - y.min) / f.height);
    const double middle_x = (x.min + x.max) / 2, middle_y = (y.min + y.max) / 2;
    f.x = make_axis(middle_x - unit * f.width / 2, middle_x + unit * f.width / 2, 9, false);
    f.y = make_axis(middle_y - unit * f.height / 2, middle_y + unit * f.height / 2, 7, false);
  }
  const double height = f.top + f.height + kBottom;
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(kWidth) + " " + number(height) +
                    "\" width=\"" + number(kWidth) + "\" height=\"" + number(height) +
                    "\" role=\"img\" font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\">\n";
  svg += "<title>" + escape_xml(plot.title) + "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  if (!plot.title.empty()) {
    svg += "<text x=\"" + number(f.left) + "\" y=\"32\" font-size=\"18\" font-weight=\"bold\" fill=\"#111111\">" +
           escape_xml(plot.title) + "</text>\n";
  }
  // Notes are of points, guides have room elsewhere.
  TextPlacer placer(f);
  for (const auto& curve : plot.curves)
    for (Eigen::Index k = 0; curve.markers_only && curve.mark != Mark::None && k < curve.x.size(); ++k)
      placer.reserve(f.map_x(curve.x[k]), f.map_y(curve.y[k]), 5);
  const std::string notes = draw_notes(plot, f, placer);
  svg += legend + draw_axes(plot, f) + draw_guides(plot, f, placer);
  for (std::size_t i = 0; i < plot.curves.size(); ++i) {
    const Curve curve = thin_out(plot.curves[i]);
    const Style style = get_style(plot, i);
    if (!curve.markers_only) {
      svg += draw_stroke(draw_line(curve, f), style);
      continue;
    }
    for (Eigen::Index k = 0; k < curve.x.size(); ++k) {
      const bool is_inside =
          curve.x[k] >= f.x.min && curve.x[k] <= f.x.max && curve.y[k] >= f.y.min && curve.y[k] <= f.y.max;
      if (is_inside) svg += draw_marker(curve.mark, f.map_x(curve.x[k]), f.map_y(curve.y[k]), style.color);
    }
  }
  svg += notes;
  svg += "<rect x=\"" + number(f.left) + "\" y=\"" + number(f.top) + "\" width=\"" + number(f.width) + "\" height=\"" +
         number(f.height) + "\" fill=\"none\" stroke=\"#333333\" stroke-width=\"1.2\"/>\n</svg>\n";
  return svg;
}

std::string draw_svg(const std::vector<Plot>& plots) {
  std::string inner;
  double height = 0;
  for (const auto& plot : plots) {
    std::string one = draw_svg(plot);
    const auto find_number = [&](const std::string& name) {
      const auto at = one.find(" " + name + "=\"") + name.size() + 3;
      return std::strtod(one.c_str() + at, nullptr);
    };
    const double own = find_number("height");
    one.insert(4, " y=\"" + number(height) + "\"");
    inner += one;
    height += own;
  }
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(kWidth) + " " + number(height) +
         "\" width=\"" + number(kWidth) + "\" height=\"" + number(height) + "\" role=\"img\">\n" + inner + "</svg>\n";
}

}  // namespace bough::report
