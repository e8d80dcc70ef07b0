#pragma once
/// \file Sections of superelements (BEGIN SUPER) and the files of their matrices (ASSIGN INPUTT4).
#include <map>
#include <vector>

#include "formats/nastran/detail/lines.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::nastran::detail {

/// Bulk data of the model, and of each superelement that has a section.
struct BulkSections {
  struct Section {
    int id = 0;
    records::CardLocation at;
    Source source;  ///< points into the text of the deck's Source
  };
  /// Returns true if the deck has sections of superelements.
  bool has_sections() const { return !sections.empty(); }
  Source main;  ///< all lines before the first section
  std::vector<Section> sections;
};

/// Cuts the lines at each BEGIN SUPER = n, BEGIN SUPER n and BEGIN BULK SUPER = n. Without such a line the result is
/// empty.
BulkSections split_bulk(const Source& source);

/// Subcases of superelements alone, by superelement: SPC, MPC and METHOD.
using ComponentCases = std::map<int, std::vector<records::Subcase>>;

/// Reads each section as a separate deck into deck.super.sections. Its subcases are those of `cases`, else one without
/// an id.
void read_sections(const BulkSections& bulk, const ComponentCases& cases, const ReadOptions& options,
                   records::Deck& deck, Diagnostics& diagnostics);

/// ASSIGN INPUTT4 of the file management section, by unit.
void read_assigned_files(const Source& source, records::Deck& deck);

}  // namespace bough::nastran::detail
