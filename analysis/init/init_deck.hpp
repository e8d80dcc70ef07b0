#pragma once
/// \file `bough init DECK`: a body file and a system file for a deck, to begin from.
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/deck.hpp"

namespace bough::analysis {

struct DeckStart {
  std::string path, name;  ///< of the deck, as the files will name it; of the body
  int hinge_grid = 0;      ///< carries a revolute hinge to ground; 0: none
};
struct StartFile {
  std::string name, text;
};

/// NAME.toml and NAME-run.toml. Constraints of the deck hold the body frame (frame = "fixed"); without any, or with a
/// hinge, whose motion clamped modes would nearly span, the modes are free-free and the frame is their mean axes.
/// Throws InputError("cli.unknown-interface") when the hinge's grid is not in the deck.
std::vector<StartFile> make_start_files(const records::Deck& deck, const DeckStart& start);

/// make_start_files() of a deck file; the files will be in `folder` (empty: the present one) and name it from there.
/// \throws InputError of demand_deck and of reading; "fe.no-grids" where the deck has none.
std::vector<StartFile> make_start_files(const std::string& deck, const std::string& folder, int hinge_grid,
                                        Diagnostics& diagnostics);

}  // namespace bough::analysis
