#include <fmt/format.h>

#include <algorithm>
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

void add_bush_stresses(const ListedElements& block, Pages& pages) {
  for (std::size_t k = 0; k < block.id.size(); ++k)
    pages.add_row(fmt::format("{:>14}   ", block.id[k]) + show_columns(block, k, 0, 6, " "));
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
    pages.add_row(fmt::format("0{:>8} {:>3} {} {:6.2f} {}", block.id[k], block.point[k],
                              show_columns(block, k, 0, 5, " "), block.real(static_cast<Eigen::Index>(k), 5),
                              show_columns(block, k, 6, 9, " ")));
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

/// Columns first .. last, real parts above imaginary ones.
void add_two_lines(const std::string& head, const ListedElements& block, std::size_t k, int first, int last,
                   std::string& text) {
  const auto row = static_cast<Eigen::Index>(k);
  for (const auto* part : {&block.real, &block.imag}) {
    text += part == &block.real ? (text.empty() ? "" : "\n") + head : "\n" + std::string(head.size(), ' ');
    for (int c = first; c < last; ++c) text += "  " + show_value((*part)(row, c));
  }
}

void add_complex_stresses(const ListedElements& block, Pages& pages) {
  for (std::size_t k = 0; k < block.id.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    std::string text;
    if (block.type == 34) {
      add_two_lines(fmt::format("0{:>18}     ENDA   ", block.id[k]), block, k, 0, 5, text);
      add_two_lines(fmt::format("{:19}     ENDB   ", ""), block, k, 5, 9, text);
    } else if (block.type == 2) {
      for (const int end : {0, 1})
        add_two_lines(
            fmt::format("{}{:>17}{:>9}   {:.3f}", end == 0 ? "0" : " ", end == 0 ? fmt::to_string(block.id[k]) : "",
                        block.ends[k][static_cast<std::size_t>(end)], double(end)),
            block, k, 4 * end, 4 * end + 4, text);
    } else if (block.type == 33 || block.type == 74) {
      for (const int side : {0, 4}) {
        text += side == 0 ? fmt::format("0{:>8}   ", block.id[k]) : fmt::format("\n{:12}", "");
        text += show_value(block.real(row, side));
        for (int c = side + 1; c < side + 4; ++c) text += "   " + show_pair(block, k, c);
      }
    } else if (block.type == 95 || block.type == 97) {
      add_two_lines(fmt::format("0{:>17}{:>16} ", block.id[k], block.point[k]), block, k, 0, 5, text);
    } else if (block.type == 39 || block.type == 67 || block.type == 68 || block.type == 255) {
      const bool is_centre = block.point[k] == 0;
      if (is_centre) text = fmt::format("0{:>10}", block.id[k]);
      add_two_lines(fmt::format("{:12}{:>9}", "", is_centre ? "CENTER" : fmt::to_string(block.point[k])), block, k, 0,
                    6, text);
    } else {
      text = fmt::format("{:>24}          {}          {}", block.id[k], show_pair(block, k, 0), show_pair(block, k, 1));
    }
    pages.add_row(text, static_cast<int>(std::count(text.begin(), text.end(), '\n')) + 1);
  }
}

std::string name_plate(int type) { return type == 33 || type == 95 ? "Q U A D 4" : "T R I A 3"; }

std::string name_stresses(const ListedElements& block) {
  switch (block.type) {
    case 34:
      return "S T R E S S E S   I N   B A R   E L E M E N T S          ( C B A R )";
    case 102:
      return "S T R E S S E S   I N   B U S H   E L E M E N T S        ( C B U S H )";
    case 2:
      return "S T R E S S E S   I N   B E A M   E L E M E N T S        ( C B E A M )";
    case 33:
    case 74:
      return (block.type == 33 ? "S T R E S S E S   I N   Q U A D R I L A T E R A L   E L E M E N T S   ( "
                               : "S T R E S S E S   I N   T R I A N G U L A R   E L E M E N T S   ( ") +
             name_plate(block.type) + " )";
    case 95:
    case 97:
      return "S T R E S S E S   I N   L A Y E R E D   C O M P O S I T E   E L E M E N T S   ( " +
             name_plate(block.type) + " )";
    case 67:
      return "S T R E S S E S   I N   H E X A H E D R O N   S O L I D   E L E M E N T S   ( H E X A )";
    case 68:
      return "S T R E S S E S   I N   P E N T A H E D R O N   S O L I D   E L E M E N T S   ( P E N T A )";
    case 255:
      return "S T R E S S E S   I N   P Y R A M I D   S O L I D   E L E M E N T S   ( P Y R A M )";
    case 39:
      return "S T R E S S E S   I N   T E T R A H E D R O N   S O L I D   E L E M E N T S   ( C T E T R A )";
    default:
      return "S T R E S S E S   I N   R O D   E L E M E N T S      ( " + space_out(block.card) + " )";
  }
}

void replace_all(const std::string& word, const std::string& by, std::string& text) {
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size()))
    text.replace(at, word.size(), by);
}

/// Titles of strains with the blanks of Nastran's, by which readers find them.
std::string name_strains(const ListedElements& block) {
  std::string name = name_stresses(block);
  replace_all("S T R E S S E S", block.type == 34 ? "S T R A I N S " : "S T R A I N S", name);
  replace_all("I N   T E T R A", "I N    T E T R A", name);
  return name;
}

/// Headings of stresses with words of equal length.
void name_strain_columns(const ListedElements& block, std::string& line) {
  replace_all("STRESSES", " STRAINS", line);
  replace_all("STRESS", "STRAIN", line);
  if (block.table != records::PointTable::CurvatureStrain) return;
  replace_all("FIBER  ", "STRAIN ", line);
  replace_all("DISTANCE ", "CURVATURE", line);
}

std::vector<std::string> name_complex_columns(int type) {
  switch (type) {
    case 34:
      return {
          "            ELEMENT                    LOCATION       LOCATION       LOCATION       LOCATION        AVERAGE",
          "              ID.                          1              2              3              4        AXIAL "
          "STRESS"};
    case 2:
      return {"                           STAT DIST/   LOCATION       LOCATION       LOCATION       LOCATION",
              "        ELEMENT-ID   GRID   LENGTH         C              D              E              F"};
    case 33:
    case 74:
      return {"  ELEMENT      FIBER                              STRESSES IN ELEMENT COORD SYSTEM",
              "    ID.       DISTANCE               NORMAL-X                        NORMAL-Y                        "
              "SHEAR-XY"};
    case 95:
    case 97:
      return {
          "           ELEMENT             PLY     STRESSES IN FIBER AND MATRIX DIRECTIONS         INTER-LAMINAR  "
          "STRESSES",
          "             ID                 ID    NORMAL-1       NORMAL-2       SHEAR-12      SHEAR XZ-MAT   SHEAR "
          "YZ-MAT"};
    case 39:
    case 67:
    case 68:
    case 255:
      return {"                CORNER       ---------------------CENTER AND CORNER POINT STRESSES---------------------",
              "  ELEMENT-ID    GRID-ID     NORMAL-X       NORMAL-Y       NORMAL-Z       SHEAR-XY       SHEAR-YZ       "
              "SHEAR-ZX"};
    default:
      return {"                 ELEMENT                       AXIAL                                  TORSIONAL",
              "                   ID.                         STRESS                                  STRESS"};
  }
}

}  // namespace

void add_stress_pages(const ListedStep& step, const ListedElements& block, Pages& pages) {
  const auto begin = [&](std::vector<std::string> columns) {
    if (block.is_strain())
      for (auto& line : columns) name_strain_columns(block, line);
    begin_table(step, block, block.is_strain() ? name_strains(block) : name_stresses(block), columns, pages);
  };
  if (block.imag.size() > 0) {
    begin(name_complex_columns(block.type));
    return add_complex_stresses(block, pages);
  }
  switch (block.type) {
    case 102:
      begin(
          {"                  ELEMENT-ID        STRESS-TX     STRESS-TY     STRESS-TZ    STRESS-RX     STRESS-RY     "
           "STRESS-RZ"});
      return add_bush_stresses(block, pages);
    case 34:
      begin(
          {"  ELEMENT        SA1            SA2            SA3            SA4           AXIAL          SA-MAX         "
           "SA-MIN     M.S.-T",
           "    ID.          SB1            SB2            SB3            SB4           STRESS         SB-MAX         "
           "SB-MIN     M.S.-C"});
      return add_bar_stresses(block, pages);
    case 2:
      begin({"                    STAT DIST/",
             "   ELEMENT-ID  GRID   LENGTH    SXC           SXD           SXE           SXF           S-MAX         "
             "S-MIN         M.S.-T   M.S.-C"});
      return add_beam_stresses(block, pages);
    case 33:
    case 74:
      begin(
          {"  ELEMENT      FIBER               STRESSES IN ELEMENT COORD SYSTEM             PRINCIPAL STRESSES (ZERO "
           "SHEAR)",
           "    ID.       DISTANCE           NORMAL-X       NORMAL-Y      SHEAR-XY       ANGLE         MAJOR           "
           "MINOR        VON MISES"});
      return add_plate_stresses(block, pages);
    case 95:
    case 97:
      begin(
          {"  ELEMENT PLY   STRESSES IN FIBER AND MATRIX DIRECTIONS      INTER-LAMINAR  STRESSES       PRINCIPAL "
           "STRESSES (ZERO SHEAR)     MAX",
           "    ID     ID    NORMAL-1      NORMAL-2      SHEAR-12     SHEAR XZ-MAT  SHEAR YZ-MAT   ANGLE     MAJOR    "
           "     MINOR         SHEAR"});
      return add_ply_stresses(block, pages);
    case 39:
    case 67:
    case 68:
    case 255:
      begin(
          {"0                CORNER        ------CENTER AND CORNER POINT STRESSES---------       DIR.  COSINES       "
           "MEAN",
           "  ELEMENT-ID    GRID-ID        NORMAL              SHEAR             PRINCIPAL       -A-  -B-  -C-     "
           "PRESSURE       VON MISES"});
      return add_solid_stresses(block, pages);
    default:
      begin(
          {"       ELEMENT       AXIAL       SAFETY      TORSIONAL     SAFETY       ELEMENT       AXIAL       SAFETY "
           "     TORSIONAL     SAFETY",
           "         ID.        STRESS       MARGIN        STRESS      MARGIN         ID.        STRESS       MARGIN "
           "        STRESS      MARGIN"});
      return add_rod_stresses(block, pages);
  }
}

}  // namespace bough::listing::detail
