#pragma once
/// \file Small pieces of HTML: numbers, tables, figures. Text that comes from files is escaped here.
#include <string>
#include <vector>

#include "report/svg_plot.hpp"

namespace bough::report {

/// Six digits, "–" where it is not finite.
std::string format_value(double value, int digits = 6);
/// "27.3 %".
std::string format_percent(double share);

/// Cells are plain text; columns of numbers are set to the right by `is_text` = false.
class HtmlTable {
 public:
  struct Column {
    std::string heading;
    bool is_text = false;
  };
  HtmlTable(std::string caption, std::vector<Column> columns);
  /// Adds a row, a cell for each column.
  void add_row(std::vector<std::string> cells);
  /// Returns true if the table has no row.
  bool empty() const { return rows_.empty(); }
  /// \param max_rows  number of rows in the table; a line reports the others.
  std::string to_html(std::size_t max_rows = 2000) const;

 private:
  std::string caption_;
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// A picture for readers without a script; `live` names what the script puts in its place, empty: nothing.
std::string make_figure(const Plot& plot, const std::string& live = {});
/// Diagrams one above the other.
std::string make_figure(const std::vector<Plot>& plots);
/// A place that only the script fills.
std::string make_place(const std::string& live, const std::string& without);
/// A place with pictures that the script replaces.
std::string make_live(const std::string& live, const std::string& html);
/// <p> of plain text.
std::string make_text(const std::string& text, const std::string& css_class = {});

/// At max_rows about `max_rows` points: of each bin the extremes, so that peaks stay.
Curve thin_curve(const Curve& curve, Eigen::Index max_rows, bool has_log_x = false);

}  // namespace bough::report
