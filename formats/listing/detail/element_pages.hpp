#pragma once
/// \file Tables of element forces and stresses.
#include "formats/listing/detail/pages.hpp"
#include "formats/records/listing.hpp"

namespace bough::listing::detail {

/// Letters with blanks between: "R O D".
std::string space_out(const std::string& word);
/// Lines above the title of a table: its mode, frequency or time.
std::vector<std::string> make_step_lines(const records::ListedStep& step);

/// Real and imaginary part next to each other.
std::string show_pair(const records::ListedElements& block, std::size_t k, Eigen::Index column);
/// Title and columns of a table, complex where the block is.
void begin_table(const records::ListedStep& step, const records::ListedElements& block, const std::string& title,
                 const std::vector<std::string>& columns, Pages& pages);

/// Adds the table of element forces of a block in Nastran's columns.
void add_force_pages(const records::ListedStep& step, const records::ListedElements& block, Pages& pages);
/// Adds the table of element stresses or strains of a block in Nastran's columns.
void add_stress_pages(const records::ListedStep& step, const records::ListedElements& block, Pages& pages);

/// Adds the tables of grid point stresses of a SURFACE or VOLUME.
void add_grid_stress_pages(const records::ListedStep& step, const records::ListedGridStresses& block, Pages& pages);

}  // namespace bough::listing::detail
