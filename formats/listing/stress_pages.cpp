#include <fmt/format.h>

#include <cmath>

#include "formats/listing/detail/element_pages.hpp"

namespace bough::listing::detail {
namespace {

using records::ListedElements;
using records::ListedStep;

/// 13 columns; blank where there is no number.
std::string show_value(double value) { return std::isnan(value) ? std::string(13, ' ') : show_real(value); }
/// A margin of safety: two digits and a power.
std::string show_margin(double value) {
  return std::isnan(value) ? std::string(8, ' ') : fmt::format("{:8.1E}", value);
}

std::string show_columns(const ListedElements& block, std::size_t k, int first, int last, const char* gap) {
  std::string text;
  for (int c = first; c < last; ++c)
    text += (c == first ? "" : gap) + show_value(block.real(static_cast<Eigen::Index>(k), c));
  return text;
}

void add_bar_stresses(const ListedElements& block, Pages& pages) {
  for (std::size_t k = 0; k < block.id.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    std::string text =
        fmt::format("0{:>8}   {} {}", block.id[k], show_columns(block, k, 0, 7, "  "), show_margin(block.real(row, 7)));
    text += fmt::format("\n{:12}{}{:17}{} {}", "", show_columns(block, k, 8, 12, "  "), "",
                        show_columns(block, k, 12, 14, "  "), show_margin(block.real(row, 14)));
    pages.add_row(text, 2);
  }
}

void add_beam_stresses(const ListedElements& block, Pages& pages) {
  for (std::size_t k = 0; k < block.id.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    std::string text = fmt::format("0 {:>8}", block.id[k]);
    for (int end = 0; end < 2; ++end)
      text += fmt::format("\n{:11}{:>8}   {:.3f}   {} {} {}", "", block.ends[k][static_cast<std::size_t>(end)],
                          double(end), show_columns(block, k, 8 * end, 8 * end + 6, " "),
                          show_margin(block.real(row, 8 * end + 6)), show_margin(block.real(row, 8 * end + 7)));
    pages.add_row(text, 3);
  }
}

void add_rod_stresses(const ListedElements& block, Pages& pages) {
  for (std::size_t k = 0; k < block.id.size(); k += 2) {
    std::string text;
    for (std::size_t i = k; i < std::min(k + 2, block.id.size()); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      text +=
          fmt::format("{:>14}  {} {}  {} {}", block.id[i], show_value(block.real(row, 0)),
                      show_margin(block.real(row, 1)), show_value(block.real(row, 2)), show_margin(block.real(row, 3)));
    }
    pages.add_row(text);
  }
}

void add_plate_stresses(const ListedElements& block, Pages& pages) {
  for (std::size_t k = 0; k < block.id.size(); ++k) {
    std::string text = fmt::format("0{:>8}   ", block.id[k]);
    for (int side = 0; side < 2; ++side) {
      if (side == 1) text += fmt::format("\n{:12}", "");
      const int c = 8 * side;
      text += fmt::format("{}   {}   {:8.4f}   {}", show_columns(block, k, c, c + 1, ""),
                          show_columns(block, k, c + 1, c + 4, "  "), block.real(static_cast<Eigen::Index>(k), c + 4),
                          show_columns(block, k, c + 5, c + 8, "   "));
    }
    pages.add_row(text, 2);
  }
}

void add_ply_stresses(const ListedElements& block, Pages& pages) {
  for (std::size_t k = 0; k < block.id.size(); ++k)
    pages.add_row(fmt::format("0{:>8} {:>3} {} {:20} {:6.2f} {}", block.id[k], block.point[k],
                              show_columns(block, k, 0, 3, " "), "",  // no shear between plies
                              block.real(static_cast<Eigen::Index>(k), 5), show_columns(block, k, 6, 9, " ")));
}

void add_solid_stresses(const ListedElements& block, Pages& pages) {
  int corners = 0;
  for (std::size_t k = 0; k < block.id.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const bool is_centre = block.point[k] == 0;
    if (is_centre) {
      corners = 0;
      while (k + 1 + static_cast<std::size_t>(corners) < block.id.size() &&
             block.point[k + 1 + static_cast<std::size_t>(corners)] != 0)
        ++corners;
    }
    std::string text;
    if (is_centre) text += fmt::format("0{:>8}           0GRID CS  {} GP\n", block.id[k], corners);
    const std::string who = is_centre ? "CENTER" : std::to_string(block.point[k]);
    for (int axis = 0; axis < 3; ++axis) {
      static constexpr const char *normal[] = {"X", "Y", "Z"}, *shear[] = {"XY", "YZ", "ZX"}, *main[] = {"A", "B", "C"};
      const auto cosine = [&](int of) { return block.real(row, (of == 0 ? 3 : of == 1 ? 11 : 17) + axis); };
      const int at = axis == 0 ? 0 : axis == 1 ? 8 : 14;
      text += fmt::format("{}{:>22}  {}  {}  {}  {}   {}  {}  L{}{:5.2f}{:5.2f}{:5.2f}", axis == 0 ? "0" : "\n ",
                          axis == 0 ? who : "", normal[axis], show_value(block.real(row, at)), shear[axis],
                          show_value(block.real(row, at + 1)), main[axis], show_value(block.real(row, at + 2)),
                          normal[axis], cosine(0), cosine(1), cosine(2));
      if (axis == 0) text += fmt::format("  {}  {}", show_value(block.real(row, 6)), show_value(block.real(row, 7)));
    }
    pages.add_row(text, is_centre ? 4 : 3);
  }
}

std::string name_plate(int type) { return type == 33 || type == 95 ? "Q U A D 4" : "T R I A 3"; }

}  // namespace

void add_stress_pages(const ListedStep& step, const ListedElements& block, Pages& pages) {
  auto headings = make_step_lines(step);
  const auto begin = [&](const std::string& title, const std::vector<std::string>& columns) {
    headings.push_back(centre(title));
    headings.insert(headings.end(), columns.begin(), columns.end());
    pages.begin_table(headings);
  };
  switch (block.type) {
    case 34:
      begin(
          "S T R E S S E S   I N   B A R   E L E M E N T S          ( C B A R )",
          {"  ELEMENT        SA1            SA2            SA3            SA4           AXIAL          SA-MAX         "
           "SA-MIN     M.S.-T",
           "    ID.          SB1            SB2            SB3            SB4           STRESS         SB-MAX         "
           "SB-MIN     M.S.-C"});
      return add_bar_stresses(block, pages);
    case 2:
      begin("S T R E S S E S   I N   B E A M   E L E M E N T S        ( C B E A M )",
            {"                    STAT DIST/",
             "   ELEMENT-ID  GRID   LENGTH    SXC           SXD           SXE           SXF           S-MAX         "
             "S-MIN "
             "        M.S.-T   M.S.-C"});
      return add_beam_stresses(block, pages);
    case 33:
    case 74:
      begin(
          (block.type == 33 ? "S T R E S S E S   I N   Q U A D R I L A T E R A L   E L E M E N T S   ( "
                            : "S T R E S S E S   I N   T R I A N G U L A R   E L E M E N T S   ( ") +
              name_plate(block.type) + " )",
          {"  ELEMENT      FIBER               STRESSES IN ELEMENT COORD SYSTEM             PRINCIPAL STRESSES (ZERO "
           "SHEAR)",
           "    ID.       DISTANCE           NORMAL-X       NORMAL-Y      SHEAR-XY       ANGLE         MAJOR           "
           "MINOR        VON MISES"});
      return add_plate_stresses(block, pages);
    case 95:
    case 97:
      begin(
          "S T R E S S E S   I N   L A Y E R E D   C O M P O S I T E   E L E M E N T S   ( " + name_plate(block.type) +
              " )",
          {"   ELEMENT  PLY   STRESSES IN FIBER AND MATRIX DIRECTIONS      INTER-LAMINAR  STRESSES   PRINCIPAL "
           "STRESSES (ZERO SHEAR)      MAX",
           "     ID      ID     NORMAL-1      NORMAL-2      SHEAR-12      SHEAR XZ-MAT  SHEAR YZ-MAT   ANGLE    MAJOR "
           "        MINOR        SHEAR"});
      return add_ply_stresses(block, pages);
    case 39:
    case 67:
    case 68:
      begin(block.type == 67 ? "S T R E S S E S   I N   H E X A H E D R O N   S O L I D   E L E M E N T S   ( H E X A )"
            : block.type == 68
                ? "S T R E S S E S   I N   P E N T A H E D R O N   S O L I D   E L E M E N T S   ( P E N T A )"
                : "S T R E S S E S   I N   T E T R A H E D R O N   S O L I D   E L E M E N T S   ( C T E T R A )",
            {"0                CORNER        ------CENTER AND CORNER POINT STRESSES---------       DIR.  COSINES       "
             "MEAN",
             "  ELEMENT-ID    GRID-ID        NORMAL              SHEAR             PRINCIPAL       -A-  -B-  -C-     "
             "PRESSURE       VON MISES"});
      return add_solid_stresses(block, pages);
    default:
      begin("S T R E S S E S   I N   R O D   E L E M E N T S      ( " + space_out(block.card) + " )",
            {"       ELEMENT       AXIAL       SAFETY      TORSIONAL     SAFETY       ELEMENT       AXIAL       SAFETY "
             "    "
             " TORSIONAL     SAFETY",
             "         ID.        STRESS       MARGIN        STRESS      MARGIN         ID.        STRESS       MARGIN "
             "    "
             "   STRESS      MARGIN"});
      return add_rod_stresses(block, pages);
  }
}

}  // namespace bough::listing::detail
