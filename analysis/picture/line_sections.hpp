#pragma once
/// \file Cross sections of bars, beams, rods and tubes where the elements have them: for the picture of a deck.
#include <functional>
#include <string>
#include <vector>

#include "fe/cards/beam_placement.hpp"
#include "fe/sections/section_library.hpp"
#include "formats/records/deck.hpp"

namespace bough::analysis {

/// Section of a property card, or of CONRODs with one area (id 0).
struct LineSection {
  struct Station {
    double x_over_L = 0;
    std::vector<fe::SectionFace> faces;  ///< [L] (y, z) in element axes, from the line between the ends of the element
  };
  std::string card;  ///< "PBARL"
  int id = 0;
  std::string text;               ///< "I 0.3 0.2 0.2 0.01 0.02 0.02", "rectangle 0.2 x 0.1"
  bool is_equivalent = false;     ///< a plain shape with some of the properties of the section: `text` names them
  std::vector<Station> stations;  ///< two or more, from 0 to 1, with equal numbers of faces and corners
};

/// An element with a section; vectors in basic.
struct LinePlacement {
  int element = 0;          ///< id
  std::size_t section = 0;  ///< index of the sections
  Eigen::Vector3d a, b;     ///< [L] ends with their offsets
  Eigen::Vector3d y, z;     ///< element axes
};

/// A released end of a bar or beam.
struct PinnedEnd {
  int element = 0;
  unsigned components = 0;  ///< mask, element axes
  Eigen::Vector3d place;    ///< [L] a tenth of the length inside the element
};

struct LineSections {
  std::vector<LineSection> sections;
  std::vector<LinePlacement> lines;
  std::vector<PinnedEnd> pins;
  int num_without = 0;  ///< elements whose property or placement gives none; `check` reports errors of both
};

/// `find_end` returns position and displacement axes of a grid, nullptr if there is none.
LineSections make_line_sections(const records::Deck& deck, const std::function<const fe::BeamEnd*(int)>& find_end);

}  // namespace bough::analysis
