#include "formats/listing/f06.hpp"

#include <fmt/format.h>

#include <cmath>

#include "formats/listing/detail/element_pages.hpp"
#include "formats/listing/detail/pages.hpp"

namespace bough::listing {
namespace {

using detail::centre;
using detail::Pages;
using detail::show_real;
using records::ListedKind;
using records::ListedStep;

std::string show_rows(const Eigen::MatrixXd& matrix, const std::string& indent) {
  std::string text;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    text += indent + "*";
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) text += fmt::format(" {:13.6E}", matrix(i, j));
    text += " *\n";
  }
  return text;
}

void add_weight(const records::ListedWeight& w, Pages& pages) {
  pages.begin_table({centre("O U T P U T   F R O M   G R I D   P O I N T   W E I G H T   G E N E R A T O R"),
                     fmt::format("0{:>53}REFERENCE POINT = {:8}", "", w.grid)});
  const std::string wide(22, ' '), narrow(43, ' ');
  std::string text = std::string(64, ' ') + "M O\n" + show_rows(w.MO, wide);
  text += std::string(65, ' ') + "S\n" + show_rows(w.S, narrow);
  text += std::string(31, ' ') + "DIRECTION\n" + std::string(26, ' ') +
          "MASS AXIS SYSTEM (S)     MASS              X-C.G.        Y-C.G.        Z-C.G.\n";
  for (int i = 0; i < 3; ++i)
    text += fmt::format("{:>34}{}{:12}{:13.6E}     {:13.6E} {:13.6E} {:13.6E}\n", "", "XYZ"[i], "", w.mass(i),
                        w.cg(i, 0), w.cg(i, 1), w.cg(i, 2));
  text += std::string(64, ' ') + "I(S)\n" + show_rows(w.I_S, narrow);
  text += std::string(64, ' ') + "I(Q)\n";
  for (int i = 0; i < 3; ++i) {
    text += narrow + "*";
    for (int j = 0; j < 3; ++j) text += i == j ? fmt::format(" {:13.6E}", w.I_Q(i)) : std::string(14, ' ');
    text += " *\n";
  }
  text += std::string(65, ' ') + "Q\n" + show_rows(w.Q, narrow);
  pages.add_row(text);
}

void add_roots(const records::ListedRoots& r, Pages& pages) {
  pages.set_titles(r.title, r.subtitle, r.label, r.subcase);
  pages.begin_table(
      {centre("R E A L   E I G E N V A L U E S"),
       "   MODE    EXTRACTION      EIGENVALUE            RADIANS             CYCLES            GENERALIZED         "
       "GENERALIZED",
       "    NO.       ORDER                                                                       MASS              "
       "STIFFNESS"});
  for (Eigen::Index j = 0; j < r.eigenvalue.size(); ++j) {
    const double omega = std::sqrt(std::abs(r.eigenvalue(j)));
    pages.add_row(fmt::format(" {:8}  {:8}       {}       {}       {}       {}       {}", j + 1, j + 1,
                              show_real(r.eigenvalue(j)), show_real(omega), show_real(omega / (2 * M_PI)),
                              show_real(r.mass(j)), show_real(r.stiffness(j))));
  }
  if (r.num_residual > 0) pages.add_row(fmt::format("\n     THE LAST {} ARE RESIDUAL VECTORS", r.num_residual), 2);
}

/// FRACTION and SUM of three directions a table.
void add_effective_mass(const records::ListedEffectiveMass& e, Pages& pages) {
  const std::string about = e.grid > 0 ? fmt::format("ABOUT GRID {}", e.grid) : "ABOUT THE ORIGIN";
  for (const int first : {0, 3}) {
    const char letter = first == 0 ? 'T' : 'R';
    pages.begin_table(
        {centre("MODAL EFFECTIVE MASS FRACTION"),
         centre(fmt::format("(FOR {} DEGREES OF FREEDOM)", first == 0 ? "TRANSLATIONAL" : "ROTATIONAL")), centre(about),
         fmt::format(
             " MODE     FREQUENCY                    {0}1                                  {0}2                  "
             "                {0}3",
             letter),
         "  NO.                      FRACTION         SUM             FRACTION         SUM             FRACTION        "
         " SUM"});
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (Eigen::Index j = 0; j < e.mass.rows(); ++j) {
      std::string row = fmt::format(" {:5}    {}", j + 1, show_real(e.cycles(j)));
      for (int c = 0; c < 3; ++c) {
        const double share = e.whole(first + c) > 0 ? e.mass(j, first + c) / e.whole(first + c) : 0;
        sum(c) += share;
        row += fmt::format("    {}  {}", show_real(share), show_real(sum(c)));
      }
      pages.add_row(row);
    }
  }
  const auto table = [&](const std::string& heading, const Eigen::MatrixXd& values) {
    pages.begin_table(
        {centre(heading), centre(about),
         " MODE     FREQUENCY         T1             T2             T3             R1             R2       "
         "      R3",
         "  NO."});
    for (Eigen::Index j = 0; j < values.rows(); ++j) {
      std::string row = fmt::format(" {:5}    {}", j + 1, show_real(e.cycles(j)));
      for (int c = 0; c < 6; ++c) row += "  " + show_real(values(j, c));
      pages.add_row(row);
    }
  };
  table("MODAL PARTICIPATION FACTORS", e.participation);
  table("MODAL EFFECTIVE MASS", e.mass);
}

const char* name(ListedKind kind, bool is_complex) {
  switch (kind) {
    case ListedKind::Displacement:
      return is_complex ? "C O M P L E X   D I S P L A C E M E N T   V E C T O R"
                        : "D I S P L A C E M E N T   V E C T O R";
    case ListedKind::Velocity:
      return is_complex ? "C O M P L E X   V E L O C I T Y   V E C T O R" : "V E L O C I T Y    V E C T O R";
    case ListedKind::Acceleration:
      return is_complex ? "C O M P L E X   A C C E L E R A T I O N   V E C T O R"
                        : "A C C E L E R A T I O N    V E C T O R";
    case ListedKind::Load:
      return is_complex ? "C O M P L E X   L O A D   V E C T O R" : "L O A D   V E C T O R";
    case ListedKind::SpcForce:
      return is_complex ? "C O M P L E X   F O R C E S   O F   S I N G L E   P O I N T   C O N S T R A I N T"
                        : "F O R C E S   O F   S I N G L E - P O I N T   C O N S T R A I N T";
    case ListedKind::MpcForce:
      return is_complex ? "C O M P L E X   F O R C E S   O F   M U L T I P O I N T   C O N S T R A I N T"
                        : "F O R C E S   O F   M U L T I P O I N T   C O N S T R A I N T";
    default:
      return "R E A L   E I G E N V E C T O R   N O .";
  }
}

constexpr const char* kColumns =
    "      POINT ID.   TYPE          T1             T2             T3             R1             R2             R3";

/// Only the first number of a scalar point counts.
std::string show_values(const Eigen::MatrixXd& values, Eigen::Index row, bool is_scalar) {
  std::string text;
  for (int c = 0; c < (is_scalar ? 1 : 6); ++c) text += (c == 0 ? "" : "  ") + show_real(values(row, c));
  return text;
}

void add_vector(const ListedStep& step, const records::ListedVector& v, Pages& pages) {
  const bool is_complex = v.imag.size() > 0;
  std::vector<std::string> headings;
  if (step.kind == ListedStep::Kind::Mode) {
    headings.push_back(fmt::format("      EIGENVALUE = {:13.6E}", step.eigenvalue));
    const std::string of = v.kind == ListedKind::Eigenvector
                               ? fmt::format("{} {:10}", name(v.kind, false), step.mode)
                               : fmt::format("{}      MODE {:6}", name(v.kind, false), step.mode);
    headings.push_back(fmt::format("          CYCLES = {:13.6E}         {}", step.cycles, of));
  } else {
    if (step.kind == ListedStep::Kind::Frequency)
      headings.push_back(fmt::format("      FREQUENCY = {:13.6E}", step.at));
    if (step.kind == ListedStep::Kind::Time) headings.push_back(fmt::format("      TIME = {:13.6E}", step.at));
    headings.push_back(centre(name(v.kind, is_complex)));
    if (is_complex) headings.push_back(centre(v.is_phase ? "(MAGNITUDE/PHASE)" : "(REAL/IMAGINARY)"));
  }
  headings.emplace_back(" ");
  headings.emplace_back(kColumns);
  const bool omits_zeros =
      v.kind == ListedKind::Load || v.kind == ListedKind::SpcForce || v.kind == ListedKind::MpcForce;
  bool is_open = false;
  for (std::size_t k = 0; k < v.id.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    if (omits_zeros && v.real.row(row).isZero(0) && (!is_complex || v.imag.row(row).isZero(0))) continue;
    if (!is_open) pages.begin_table(headings);
    is_open = true;
    std::string text = fmt::format("{:14} {:>6}     {}", v.id[k], v.is_scalar[k] ? "S" : "G",
                                   show_values(v.real, row, v.is_scalar[k]));
    if (is_complex) text += fmt::format("\n{:26}{}", "", show_values(v.imag, row, v.is_scalar[k]));
    pages.add_row(text, is_complex ? 2 : 1);
  }
}

/// QUAD4 of CQUAD4.
std::string name_element(const std::string& card) {
  return card.starts_with("C") && card != "CONROD" ? card.substr(1) : card;
}

void add_energies(const ListedStep& step, const records::ListedEnergies& block, Pages& pages) {
  auto headings = detail::make_step_lines(step);
  const std::string name = name_element(block.card), gap(20, ' ');
  headings.insert(
      headings.end(),
      {centre("E L E M E N T   S T R A I N   E N E R G I E S"), " ",
       fmt::format("{:16}ELEMENT-TYPE = {:<19}* TOTAL ENERGY OF ALL ELEMENTS IN PROBLEM = {:13.6E}", "", name,
                   block.total),
       " ", fmt::format("{:37}ELEMENT-ID{}STRAIN-ENERGY{}PERCENT OF TOTAL", "", gap.substr(8), gap.substr(8))});
  pages.begin_table(headings);
  const auto show = [&](double energy) {
    return fmt::format("{}{}{:13.4f}", show_real(energy), gap.substr(5),
                       block.total > 0 ? 100 * energy / block.total : 0.0);
  };
  for (std::size_t k = 0; k < block.id.size(); ++k)
    pages.add_row(fmt::format("{:>47}{}", block.id[k], gap.substr(8)) +
                  show(block.energy[static_cast<Eigen::Index>(k)]));
  pages.add_row(fmt::format("\n{:23}TYPE = {:<9}SUBTOTAL{}", "", name, gap.substr(8)) + show(block.energy.sum()), 2);
}

/// Grid by grid, loads and constraints first, then elements, then the sum.
void add_grid_forces(const ListedStep& step, Pages& pages) {
  auto headings = detail::make_step_lines(step);
  headings.insert(headings.end(), {centre("G R I D   P O I N T   F O R C E   B A L A N C E"), " ",
                                   "   POINT-ID    ELEMENT-ID     SOURCE             T1             T2             T3"
                                   "             R1             R2             R3"});
  pages.begin_table(headings);
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  const auto add = [&](int grid, int element, const std::string& source, const Eigen::Matrix<double, 6, 1>& force) {
    std::string row =
        fmt::format(" {:>10}    {:>10}     {:<10}", grid, element > 0 ? std::to_string(element) : "", source);
    for (int c = 0; c < 6; ++c) row += "  " + show_real(force[c]);
    pages.add_row(row);
  };
  for (std::size_t k = 0; k < step.grid_forces.size(); ++k) {
    const auto& f = step.grid_forces[k];
    add(f.grid, f.element, name_element(f.source), f.force);
    sum += f.force;
    if (k + 1 < step.grid_forces.size() && step.grid_forces[k + 1].grid == f.grid) continue;
    add(f.grid, 0, "*TOTALS*", sum);
    sum.setZero();
  }
}

}  // namespace

std::string make_f06(const records::Listing& listing) {
  Pages pages;
  if (listing.weight) {
    if (!listing.steps.empty()) {
      const auto& step = listing.steps.front();
      pages.set_titles(step.title, step.subtitle, step.label, 0);
    }
    add_weight(*listing.weight, pages);
  }
  for (const auto& roots : listing.roots) {
    add_roots(roots, pages);
    for (const auto& mass : listing.effective_mass)
      if (mass.subcase == roots.subcase) add_effective_mass(mass, pages);
  }
  for (const auto& step : listing.steps) {
    pages.set_titles(step.title, step.subtitle, step.label, step.subcase);
    for (const auto& vector : step.vectors)
      if (vector.is_printed) add_vector(step, vector, pages);
    for (const auto& block : step.forces)
      if (block.is_printed) detail::add_force_pages(step, block, pages);
    for (const auto& block : step.stresses)
      if (block.is_printed) detail::add_stress_pages(step, block, pages);
    for (const auto& block : step.strains)
      if (block.is_printed) detail::add_stress_pages(step, block, pages);
    for (const auto& block : step.grid_stresses)
      if (block.is_printed) detail::add_grid_stress_pages(step, block, pages);
    for (const auto& block : step.energies) add_energies(step, block, pages);
    if (!step.grid_forces.empty()) add_grid_forces(step, pages);
  }
  return pages.finish();
}

}  // namespace bough::listing
