#include "formats/listing/complex_f06.hpp"

#include <fmt/format.h>

#include <cmath>

#include "formats/listing/detail/pages.hpp"

namespace bough::listing {

namespace {

using detail::centre;
using detail::Pages;
using detail::show_real;

void add_summary(const ListedComplexModes& modes, Pages& pages) {
  pages.begin_table(
      {centre("C O M P L E X   E I G E N V A L U E   S U M M A R Y"),
       "0                ROOT     EXTRACTION                  EIGENVALUE                     FREQUENCY    "
       "          DAMPING",
       "                  NO.        ORDER             (REAL)           (IMAG)                (CYCLES)    "
       "        COEFFICIENT"});
  for (Eigen::Index j = 0; j < modes.eigenvalue.size(); ++j)
    pages.add_row(fmt::format("{:>23}  {:>10}         {}  {}         {}         {}", j + 1, j + 1,
                              show_real(modes.eigenvalue(j).real()), show_real(modes.eigenvalue(j).imag()),
                              show_real(modes.eigenvalue(j).imag() / (2 * M_PI)), show_real(modes.damping(j))));
}

/// Real parts above imaginary ones, or magnitudes above phases; only the first number of a scalar point counts.
void add_shape(std::complex<double> eigenvalue, std::size_t mode, const records::ListedVector& shape, Pages& pages) {
  pages.begin_table({fmt::format("      COMPLEX EIGENVALUE = {:13.6E}, {:13.6E}", eigenvalue.real(), eigenvalue.imag()),
                     centre(fmt::format("C O M P L E X   E I G E N V E C T O R   N O . {:10}", mode)),
                     centre(shape.is_phase ? "(MAGNITUDE/PHASE)" : "(REAL/IMAGINARY)"), " ",
                     "      POINT ID.   TYPE          T1             T2             T3             R1             R2   "
                     "          R3"});
  for (std::size_t k = 0; k < shape.id.size(); ++k) {
    const bool is_scalar = shape.is_scalar[k];
    const auto show = [&](const Eigen::MatrixXd& values) {
      std::string text;
      for (int c = 0; c < (is_scalar ? 1 : 6); ++c)
        text += (c == 0 ? "" : "  ") + show_real(values(static_cast<Eigen::Index>(k), c));
      return text;
    };
    pages.add_row(fmt::format("{:14} {:>6}     {}\n{:26}{}", shape.id[k], is_scalar ? "S" : "G", show(shape.real), "",
                              show(shape.imag)),
                  2);
  }
}

}  // namespace

std::string make_complex_f06(const std::vector<ListedComplexModes>& subcases) {
  Pages pages;
  for (const auto& modes : subcases) {
    pages.set_titles(modes.title, modes.subtitle, modes.label, modes.subcase);
    add_summary(modes, pages);
    for (std::size_t j = 0; j < modes.shapes.size(); ++j)
      add_shape(modes.eigenvalue(static_cast<Eigen::Index>(j)), j + 1, modes.shapes[j], pages);
  }
  return pages.finish();
}

}  // namespace bough::listing
