#include <fmt/format.h>

#include "formats/listing/detail/element_pages.hpp"

namespace bough::listing::detail {
namespace {

using records::ListedGridStresses;

/// 10 columns, as E10.3; zero is 0.0.
std::string show_short(double value) { return value == 0 ? "0.0       " : fmt::format("{:10.3E}", value); }

std::string name_system(const ListedGridStresses& block) {
  return block.is_element_system ? "ELEMENT" : block.cid == 0 ? "BASIC" : "CORD";
}

void add_surface(const records::ListedStep& step, const ListedGridStresses& block, Pages& pages) {
  auto headings = make_step_lines(step);
  std::string normal = block.normal.starts_with("X") ? std::string(1, "XYZ"[block.normal[1] - '1']) : block.normal;
  if (block.is_reversed) normal.insert(0, "M");
  headings.insert(
      headings.end(),
      {fmt::format("{:34}S T R E S S E S   A T   G R I D   P O I N T S   - -     S U R F A C E  {:>8}", "", block.id),
       fmt::format("0{:23}SURFACE X-AXIS {}  NORMAL(Z-AXIS)  {:<2}        REFERENCE COORDINATE SYSTEM FOR SURFACE "
                   "DEFINITION CID {:>8}",
                   "", "XYZ"[block.axis - 1], normal, block.cid),
       "     GRID      ELEMENT            STRESSES IN SURFACE SYSTEM           PRINCIPAL STRESSES            MAX",
       "     ID          ID    FIBRE   NORMAL-X   NORMAL-Y   SHEAR-XY     ANGLE      MAJOR      MINOR      SHEAR     "
       "VON MISES"});
  pages.begin_table(headings);
  for (std::size_t k = 0; k < block.grid.size(); ++k) {
    const auto row = block.values.row(static_cast<Eigen::Index>(k));
    const bool is_first = k == 0 || block.grid[k] != block.grid[k - 1] || block.element[k] != block.element[k - 1];
    std::string text =
        is_first ? fmt::format("0{:>8}    {:>8}", block.grid[k], block.element[k]) : std::string(21, ' ');
    text += fmt::format("    {:>3}  ", block.fibre[k]);
    for (const int c : {0, 1, 2}) text += " " + show_short(row[c]);
    text += fmt::format(" {:9.4f}", row[3]);
    for (const int c : {4, 5, 6, 7}) text += " " + show_short(row[c]);
    pages.add_row(text);
  }
}

void add_volume(const records::ListedStep& step, const ListedGridStresses& block, bool is_direct, Pages& pages) {
  auto headings = make_step_lines(step);
  headings.push_back(
      fmt::format("{:20}{}   S T R E S S E S   A T   G R I D   P O I N T S   - -       V O L U M E {:>8}", "",
                  is_direct ? "D I R E C T" : "P R I N C I P A L", block.id));
  headings.push_back(fmt::format("{:30}OUTPUT COORDINATE SYSTEM = {:7}  {}", "", block.cid, name_system(block)));
  if (is_direct)
    headings.insert(
        headings.end(),
        {"     GRID            NORMAL-X    NORMAL-Y    NORMAL-Z      SHEAR-XY    SHEAR-YZ    SHEAR-ZX       "
         " MEAN      VON MISES",
         "     ID                                                                                           "
         "PRESSURE"});
  else
    headings.insert(
        headings.end(),
        {"     GRID              PRINCIPAL STRESSES                            DIRECTION COSINES            "
         "           MEAN      VON MISES",
         "     ID            A           B           C       LXA   LXB   LXC   LYA   LYB   LYC   LZA   LZB  "
         " LZC     PRESSURE"});
  pages.begin_table(headings);
  for (std::size_t k = 0; k < block.grid.size(); ++k) {
    const auto row = block.values.row(static_cast<Eigen::Index>(k));
    std::string text = fmt::format(" {:>8}", block.grid[k]);
    if (is_direct) {
      for (int c = 0; c < 6; ++c) text += (c == 0 ? "          " : c == 3 ? "    " : "  ") + show_short(row[c]);
      text += "     ";
    } else {
      for (int c = 8; c < 11; ++c) text += "  " + show_short(row[c]);
      text += "  ";
      for (int c = 11; c < 20; ++c) text += fmt::format(" {:5.2f}", row[c]);
      text += "  ";
    }
    pages.add_row(text + show_short(row[6]) + "  " + show_short(row[7]));
  }
}

}  // namespace

void add_grid_stress_pages(const records::ListedStep& step, const ListedGridStresses& block, Pages& pages) {
  if (block.grid.empty()) return;
  if (!block.is_volume) return add_surface(step, block, pages);
  if (block.has_direct) add_volume(step, block, true, pages);
  if (block.has_principal) add_volume(step, block, false, pages);
}

}  // namespace bough::listing::detail
