#include "report/terminal_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <tuple>
#include <vector>

namespace bough::report {

namespace {

constexpr std::array<int, 6> kTerminalColors{34, 31, 32, 35, 36, 33};

std::string paint(const std::string& text, int curve, bool has_color) {
  if (!has_color || curve < 0) return text;
  return "\033[" + std::to_string(kTerminalColors[static_cast<std::size_t>(curve) % kTerminalColors.size()]) + "m" +
         text + "\033[0m";
}

/// U+2800 and the bits of the dots in UTF-8.
std::string to_braille(int bits) {
  const int code = 0x2800 + bits;
  return {static_cast<char>(0xE0 | (code >> 12)), static_cast<char>(0x80 | ((code >> 6) & 0x3F)),
          static_cast<char>(0x80 | (code & 0x3F))};
}

class Canvas {
 public:
  Canvas(int columns, int rows)
      : columns_(columns),
        rows_(rows),
        bits_(static_cast<std::size_t>(columns * rows)),
        curve_(bits_.size(), -1),
        marks_(bits_.size()) {}

  /// x to the right and y up, from 0 to 1.
  void put(double x, double y, int curve) {
    if (!(x >= 0 && x <= 1 && y >= 0 && y <= 1)) return;
    const int i = static_cast<int>(std::lround(x * (2 * columns_ - 1)));
    const int j = static_cast<int>(std::lround((1 - y) * (4 * rows_ - 1)));
    static constexpr int kBits[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    const auto cell = static_cast<std::size_t>(j / 4 * columns_ + i / 2);
    bits_[cell] |= kBits[j % 4][i % 2];
    curve_[cell] = curve;
  }
  void put_line(double ax, double ay, double bx, double by, int curve) {
    // Lines are clipped, so that none has more steps than the frame is wide.
    const double steps = std::max(std::abs(bx - ax) * 2 * columns_, std::abs(by - ay) * 4 * rows_);
    if (!std::isfinite(steps)) return;
    const int n = static_cast<int>(std::min(steps, 4.0 * (columns_ + rows_) * 4)) + 1;
    for (int k = 0; k <= n; ++k) put(ax + (bx - ax) * k / n, ay + (by - ay) * k / n, curve);
  }
  /// A character in place of the dots of its cell.
  void put_mark(double x, double y, const char* mark, int curve) {
    if (!(x >= 0 && x <= 1 && y >= 0 && y <= 1)) return;
    const int i = static_cast<int>(std::lround(x * (2 * columns_ - 1)));
    const int j = static_cast<int>(std::lround((1 - y) * (4 * rows_ - 1)));
    const auto cell = static_cast<std::size_t>(j / 4 * columns_ + i / 2);
    // A pole on a zero shows as both.
    marks_[cell] = !marks_[cell].empty() && marks_[cell] != mark ? "\u2297" : mark;
    curve_[cell] = curve;
  }
  std::string take_row(int row, bool has_color) const {
    std::string text;
    for (int c = 0; c < columns_; ++c) {
      const auto cell = static_cast<std::size_t>(row * columns_ + c);
      const std::string own = marks_[cell].empty() && bits_[cell] != 0 ? to_braille(bits_[cell]) : marks_[cell];
      text += own.empty() ? " " : paint(own, curve_[cell], has_color);
    }
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
  }

 private:
  int columns_, rows_;
  std::vector<int> bits_, curve_;
  std::vector<std::string> marks_;
};

std::string format_end(double value, bool is_log) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", is_log ? std::pow(10.0, value) : value);
  return buffer;
}

/// Truncates to a number of UTF-8 characters.
std::string cut_text(const std::string& text, int max_letters) {
  int count = 0;
  for (std::size_t i = 0; i < text.size(); ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80 && ++count > max_letters) return text.substr(0, i);
  return text;
}

bool is_marked(const Curve& curve) {
  return curve.markers_only && (curve.mark == Mark::Cross || curve.mark == Mark::Ring);
}
const char* get_mark(const Curve& curve) { return curve.mark == Mark::Cross ? "\u00d7" : "o"; }

struct Ends {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double v) {
    if (!std::isfinite(v)) return;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  void open() {
    if (low > high) low = 0, high = 1;
    if (low == high) low -= low == 0 ? 1 : 0.5 * std::abs(low), high += high == 0 ? 1 : 0.5 * std::abs(high);
  }
  double map(double v) const { return (v - low) / (high - low); }
};

/// Labels of the rows: the ends of the axis; with `y_step` its multiples, and the ends move out to multiples.
std::vector<std::string> make_row_labels(const Plot& plot, int height, Ends& y) {
  std::vector<std::string> labels(static_cast<std::size_t>(height));
  if (plot.y_step > 0 && !plot.has_log_y) {
    double step = plot.y_step;
    const auto round_out = [&] {
      return std::pair(std::floor(y.low / step + 1e-9) * step, std::ceil(y.high / step - 1e-9) * step);
    };
    auto [low, high] = round_out();
    while ((high - low) / step > 0.5 * height) {
      step *= 2;
      std::tie(low, high) = round_out();
    }
    if (high > low) {
      y.low = low, y.high = high;
      for (double value = low; value <= high + 0.5 * step; value += step) {
        const auto row = std::lround((1 - y.map(value)) * (4 * height - 1)) / 4;
        labels[static_cast<std::size_t>(std::clamp<long>(row, 0, height - 1))] = format_end(value, false);
      }
      return labels;
    }
  }
  labels.back() = format_end(y.low, plot.has_log_y);
  labels.front() = format_end(y.high, plot.has_log_y);
  return labels;
}

}  // namespace

std::string draw_text(const Plot& given, int width, int height, bool has_color) {
  width = std::max(width, 40);
  const Plot plot = take_logarithms(given);
  Ends x, y;
  for (const auto& curve : plot.curves)
    for (Eigen::Index i = 0; i < curve.x.size(); ++i)
      if (std::isfinite(curve.x[i]) && std::isfinite(curve.y[i])) x.add(curve.x[i]), y.add(curve.y[i]);
  if (plot.y_max > plot.y_min) y.low = plot.y_min, y.high = plot.y_max;
  x.open();
  y.open();
  const auto labels = make_row_labels(plot, height, y);
  std::size_t widest = 0;
  for (const auto& label : labels) widest = std::max(widest, label.size());
  const int margin = static_cast<int>(widest);
  const int columns = std::max(10, width - margin - 2);
  Canvas canvas(columns, height);
  for (std::size_t c = 0; c < plot.curves.size(); ++c) {
    const auto& curve = plot.curves[c];
    const int index = static_cast<int>(c);
    if (curve.mark == Mark::None) continue;
    for (Eigen::Index i = 0; i < curve.x.size(); ++i) {
      const double bx = x.map(curve.x[i]), by = y.map(curve.y[i]);
      if (is_marked(curve))
        canvas.put_mark(bx, by, get_mark(curve), index);
      else if (i == 0 || curve.markers_only)
        canvas.put(bx, by, index);
      else
        canvas.put_line(x.map(curve.x[i - 1]), y.map(curve.y[i - 1]), bx, by, index);
    }
  }
  // The unit circle of the z plane; more lines would hide the marks.
  if (plot.is_equal && !plot.guides.empty()) {
    const auto& circle = plot.guides.front();
    for (Eigen::Index i = 0; i + 1 < circle.x.size(); ++i)
      canvas.put_line(x.map(circle.x[i]), y.map(circle.y[i]), x.map(circle.x[i + 1]), y.map(circle.y[i + 1]), -1);
  }
  std::string text;
  if (!plot.title.empty()) text += cut_text(plot.title, width) + "\n";
  for (std::size_t c = 0; c < plot.curves.size(); ++c)
    if (!plot.curves[c].label.empty() && plot.curves.size() > 1)
      text += paint(is_marked(plot.curves[c]) ? get_mark(plot.curves[c]) + std::string("  ") : "\u2501\u2501 ",
                    static_cast<int>(c), has_color) +
              cut_text(plot.curves[c].label, width - 3) + "\n";
  for (const auto& note : plot.notes) text += cut_text(note.text, width) + "\n";
  for (int row = 0; row < height; ++row) {
    const std::string& label = labels[static_cast<std::size_t>(row)];
    text += std::string(static_cast<std::size_t>(margin) - label.size(), ' ') + label +
            (label.empty() ? "\u2502" : "\u2524") + canvas.take_row(row, has_color) + "\n";
  }
  text += std::string(static_cast<std::size_t>(margin), ' ') + "\u2514";
  for (int c = 0; c < columns; ++c) text += "\u2500";
  const std::string first = format_end(x.low, plot.has_log_x), last = format_end(x.high, plot.has_log_x);
  const auto room = columns - static_cast<int>(first.size() + last.size()) - 2;
  std::string name = cut_text(plot.x_label, std::max(0, room));
  const auto used =
      static_cast<int>(std::count_if(name.begin(), name.end(), [](char c) { return (c & 0xC0) != 0x80; }));
  const int left = std::max(1, (room + 2 - used) / 2), right = std::max(1, room + 2 - used - left);
  return text + "\n" + std::string(static_cast<std::size_t>(margin) + 1, ' ') + first +
         std::string(static_cast<std::size_t>(left), ' ') + name + std::string(static_cast<std::size_t>(right), ' ') +
         last + "\n";
}

}  // namespace bough::report
