#pragma once
/// \file Pages of a listing.
#include <string>
#include <vector>

namespace bough::listing::detail {

/// 13 columns, as E13.6; zero is 0.0.
std::string show_real(double value);
/// `text` in the middle of 124 columns, from the left.
std::string centre(const std::string& text);

class Pages {
 public:
  /// Sets the lines at the top of every page, from the next page on.
  void set_titles(const std::string& title, const std::string& subtitle, const std::string& label, int subcase);
  /// A page with these lines on top, and on each page that the rows go on to.
  void begin_table(std::vector<std::string> headings);
  /// Lines that stay on one page.
  void add_row(const std::string& lines, int count = 1);
  /// Returns the text of all pages; this is empty afterwards.
  std::string finish() { return std::move(text_); }

 private:
  void begin_page();
  std::string title_, subtitle_, label_;
  int subcase_ = 0, page_ = 0, rows_ = 0;
  std::vector<std::string> headings_;
  std::string text_;
};

}  // namespace bough::listing::detail
