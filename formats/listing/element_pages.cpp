#include "formats/listing/detail/element_pages.hpp"

#include <fmt/format.h>

namespace bough::listing::detail {
namespace {

using records::ListedElements;
using records::ListedStep;

std::string show_row(const Eigen::MatrixXd& values, std::size_t k, const std::string& gap) {
  std::string text;
  for (Eigen::Index c = 0; c < values.cols(); ++c)
    text += (c == 0 ? "" : gap) + show_real(values(static_cast<Eigen::Index>(k), c));
  return text;
}

/// Several elements per line; of complex values one, real and imaginary part next to each other.
void add_columns(const ListedElements& block, std::size_t of_line, Pages& pages) {
  if (block.imag.size() > 0) {
    for (std::size_t k = 0; k < block.id.size(); ++k) {
      std::string text = fmt::format("{:>24}", block.id[k]);
      for (Eigen::Index c = 0; c < block.real.cols(); ++c) text += "          " + show_pair(block, k, c);
      pages.add_row(text);
    }
    return;
  }
  for (std::size_t k = 0; k < block.id.size(); k += of_line) {
    std::string text;
    for (std::size_t i = k; i < std::min(k + of_line, block.id.size()); ++i) {
      text += fmt::format("{:>14}", block.id[i]);
      for (Eigen::Index c = 0; c < block.real.cols(); ++c)
        text += "   " + show_real(block.real(static_cast<Eigen::Index>(i), c));
    }
    pages.add_row(text);
  }
}

void add_rows(const ListedElements& block, const std::string& gap, Pages& pages) {
  for (std::size_t k = 0; k < block.id.size(); ++k) {
    std::string text = fmt::format("{:>14}   ", block.id[k]);
    text += show_row(block.real, k, gap);
    if (block.imag.size() > 0) text += fmt::format("\n{:17}", "") + show_row(block.imag, k, gap);
    pages.add_row(text, block.imag.size() > 0 ? 2 : 1);
  }
}

void add_beams(const ListedElements& block, Pages& pages) {
  const Eigen::Index half = block.real.cols() / 2;
  for (std::size_t k = 0; k < block.id.size(); ++k) {
    std::string text = fmt::format("0 {:>8}", block.id[k]);
    for (int end = 0; end < 2; ++end) {
      text += fmt::format("\n{:11}{:>8}   {:.3f}  ", "", block.ends[k][static_cast<std::size_t>(end)], double(end));
      for (const auto* part : {&block.real, &block.imag}) {
        if (part->size() == 0) continue;
        if (part == &block.imag) text += fmt::format("\n{:29}", "");
        for (Eigen::Index c = 0; c < half; ++c)
          text += " " + show_real((*part)(static_cast<Eigen::Index>(k), end * half + c));
      }
    }
    pages.add_row(text, block.imag.size() > 0 ? 5 : 3);
  }
}

}  // namespace

std::string space_out(const std::string& word) {
  std::string text;
  for (const char c : word) text += (text.empty() ? "" : " ") + std::string(1, c);
  return text;
}

std::string show_pair(const ListedElements& block, std::size_t k, Eigen::Index column) {
  const auto row = static_cast<Eigen::Index>(k);
  return show_real(block.real(row, column)) + " / " + show_real(block.imag(row, column));
}

void begin_table(const ListedStep& step, const ListedElements& block, const std::string& title,
                 const std::vector<std::string>& columns, Pages& pages) {
  auto headings = make_step_lines(step);
  const bool is_complex = block.imag.size() > 0;
  headings.push_back(centre(is_complex ? "C O M P L E X   " + title : title));
  if (is_complex) headings.push_back(centre(block.is_phase ? "(MAGNITUDE/PHASE)" : "(REAL/IMAGINARY)"));
  headings.insert(headings.end(), columns.begin(), columns.end());
  pages.begin_table(headings);
}

std::vector<std::string> make_step_lines(const ListedStep& step) {
  switch (step.kind) {
    case ListedStep::Kind::Mode:
      return {fmt::format("      EIGENVALUE = {:13.6E}", step.eigenvalue), fmt::format("      MODE = {}", step.mode)};
    case ListedStep::Kind::Frequency:
      return {fmt::format("      FREQUENCY = {:13.6E}", step.at)};
    case ListedStep::Kind::Time:
      return {fmt::format("      TIME = {:13.6E}", step.at)};
    default:
      return {};
  }
}

void add_force_pages(const ListedStep& step, const ListedElements& block, Pages& pages) {
  const bool is_complex = block.imag.size() > 0;
  const auto begin = [&](const std::string& title, const std::vector<std::string>& columns) {
    begin_table(step, block, title, columns, pages);
  };
  const auto& card = block.card;
  switch (block.type) {
    case 34:
    case 117:
      begin(
          block.type == 34 ? "F O R C E S   I N   B A R   E L E M E N T S         ( C B A R )"
                           : "F O R C E S   I N   W E L D   E L E M E N T S         ( C W E L D )",
          {"0    ELEMENT         BEND-MOMENT END-A            BEND-MOMENT END-B                - SHEAR -               "
           "AXIAL",
           "       ID.         PLANE 1       PLANE 2        PLANE 1       PLANE 2        PLANE 1       PLANE 2         "
           "FORCE         TORQUE"});
      return add_rows(block, " ", pages);
    case 2:
      begin("F O R C E S   I N   B E A M   E L E M E N T S        ( C B E A M )",
            {"                    STAT DIST/   - BENDING MOMENTS -            - WEB  SHEARS -           AXIAL          "
             "TOTAL          WARPING",
             "   ELEMENT-ID  GRID   LENGTH    PLANE 1       PLANE 2        PLANE 1       PLANE 2        FORCE          "
             "TORQUE         TORQUE"});
      return add_beams(block, pages);
    case 102:
    case 126:
      begin(block.type == 102 ? "F O R C E S   I N   B U S H   E L E M E N T S        ( C B U S H )"
                              : "F O R C E S   I N   F A S T E N E R   E L E M E N T S   ( C F A S T )",
            {"                  ELEMENT-ID        FORCE-X       FORCE-Y       FORCE-Z      MOMENT-X      MOMENT-Y      "
             "MOMENT-Z"});
      return add_rows(block, " ", pages);
    case 33:
    case 74:
      begin(
          block.type == 33 ? "F O R C E S   I N   Q U A D R I L A T E R A L   E L E M E N T S   ( Q U A D 4 )"
                           : "F O R C E S   I N   T R I A N G U L A R   E L E M E N T S   ( T R I A 3 )",
          {"    ELEMENT                - MEMBRANE  FORCES -                        - BENDING  MOMENTS -              - "
           "TRANSVERSE SHEAR FORCES -",
           "      ID              FX            FY            FXY             MX            MY            MXY          "
           "   "
           "QX            QY"});
      return add_rows(block, " ", pages);
    case 1:
    case 3:
    case 10:
      if (is_complex)
        begin("F O R C E S   I N   R O D   E L E M E N T S     ( " + space_out(card) + " )",
              {"                 ELEMENT                       AXIAL                                  TORQUE",
               "                   ID.                         FORCE"});
      else
        begin("F O R C E S   I N   R O D   E L E M E N T S     ( " + space_out(card) + " )",
              {"       ELEMENT       AXIAL                                     ELEMENT       AXIAL",
               "         ID.         FORCE          TORQUE                       ID.         FORCE          TORQUE"});
      return add_columns(block, 2, pages);
    default:
      if (is_complex)
        begin("F O R C E S   I N   S C A L A R   S P R I N G S        ( " + space_out(card) + " )",
              {"                 ELEMENT                       FORCE", "                   ID."});
      else
        begin(
            "F O R C E S   I N   S C A L A R   S P R I N G S        ( " + space_out(card) + " )",
            {"      ELEMENT         FORCE            ELEMENT         FORCE            ELEMENT         FORCE            "
             "ELEMENT         FORCE",
             "        ID.                              ID.                              ID.                            "
             "  "
             "ID."});
      return add_columns(block, 4, pages);
  }
}

}  // namespace bough::listing::detail
