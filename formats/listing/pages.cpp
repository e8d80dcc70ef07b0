#include <fmt/format.h>

#include "formats/listing/detail/pages.hpp"

namespace bough::listing::detail {
namespace {
constexpr int kRowsOfPage = 50;
constexpr std::size_t kWidth = 124;
}  // namespace

std::string show_real(double value) {
  return value == 0 ? std::string(" 0.0         ") : fmt::format("{:13.6E}", value);
}

std::string centre(const std::string& text) {
  return text.size() >= kWidth ? text : std::string((kWidth - text.size()) / 2, ' ') + text;
}

void Pages::set_titles(const std::string& title, const std::string& subtitle, const std::string& label, int subcase) {
  title_ = title.substr(0, 64);
  subtitle_ = subtitle.substr(0, 96);
  label_ = label.substr(0, 64);
  subcase_ = subcase;
}

void Pages::begin_table(std::vector<std::string> headings) {
  headings_ = std::move(headings);
  begin_page();
}

void Pages::begin_page() {
  text_ += fmt::format("1    {:<64}{:>30}{:>19} PAGE {:>5}\n", title_, "", "BOUGH", ++page_);
  text_ += fmt::format("     {}\n", subtitle_);
  text_ += subcase_ > 0 ? fmt::format("0    {:<64}{:>42}SUBCASE {}\n", label_, "", subcase_)
                        : fmt::format("0    {}\n", label_);
  text_ += "\n";
  for (const auto& line : headings_) text_ += line + "\n";
  rows_ = 0;
}

void Pages::add_row(const std::string& lines, int count) {
  if (rows_ > 0 && rows_ + count > kRowsOfPage) begin_page();
  text_ += lines + "\n";
  rows_ += count;
}

}  // namespace bough::listing::detail
