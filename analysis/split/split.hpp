#pragma once
/// \file `bough split DECK`: a deck cut into several bodies with a system file that joins them.
#include <string>
#include <vector>

#include "analysis/common/events.hpp"
#include "analysis/common/model_choice.hpp"
#include "analysis/init/init_deck.hpp"
#include "formats/records/flex_body.hpp"

namespace bough::analysis {

/// Where to cut; exactly one of num_parts, planes, elements and grids.
struct SplitChoice {
  int num_parts = 0;                  ///< parts of equal length
  std::string along = "path";         ///< their direction: "path" (over the elements), "long", "x", "y", "z"
  std::vector<std::string> planes;    ///< "x=2.5" or "nx,ny,nz=d", each: n·r = d in basic
  std::vector<std::string> elements;  ///< a part each: ids, ranges, property:P, card:NAME, separated by commas
  std::vector<int> grids;             ///< cut at these
  /// Joint of cuts along several grids: "rigid" (RBE2 to a new grid), "average" (RBE3) or "grids" (a constraint at
  /// each).
  std::string interface = "rigid";
};

struct SplitRequest {
  std::string deck;       ///< file
  std::string deck_path;  ///< of the deck in comments of the files; empty: `deck`
  std::string name;       ///< of the parts: NAME-1, NAME-2, ...; empty: the file's name without extension
  ModelChoice model;
  SplitChoice choice;
  bool is_checked = true;  ///< reduces the parts and compares the modes of all of them with those of the deck
  int num_compared = 10;   ///< elastic modes
};

struct SplitPart {
  std::string name;
  std::string parent;  ///< name, or "ground"
  int node = 0;        ///< grid at which the parent carries the part; 0: constrained as in the deck, or by grids
  int num_joined = 0;  ///< grids at which constraints join the part to others
  int num_elements = 0, num_grids = 0;
  double mass = 0;
  records::FlexBody body;  ///< reduced, with is_checked
};

/// Deflection under one static load, of the deck and of the assembled parts.
struct ComparedDeflection {
  std::string load;       ///< "weight along x", "force along x at grid 5", "LOAD 7"
  double deflection = 0;  ///< [L] largest displacement of a grid of the deck
  double error = 0;       ///< of the parts: largest difference, over the largest deflection of loads of its kind
};

struct ComparedFrequency {
  double whole_hz = 0, parts_hz = 0;
  /// Relative error of the frequency of the parts.
  double error() const { return parts_hz / whole_hz - 1; }
};

struct SplitAnswer {
  std::vector<StartFile> files;  ///< a deck and a body file for each part, then the system file
  std::vector<SplitPart> parts;
  double mass = 0;                              ///< of the deck
  std::vector<ComparedFrequency> frequencies;   ///< with is_checked
  std::vector<ComparedDeflection> deflections;  ///< with is_checked
};

/// Largest relative error of an assembled frequency or deflection that is not warned of.
constexpr double kMaxSplitError = 1e-4;

/// Reads a deck and cuts it.
///
/// Every element, mass, load, constraint and rigid element goes to one part; cuts at one grid join two parts there,
/// cuts along several grids by a new grid to which these are rigidly connected, or grid by grid. Bodies have
/// Craig-Bampton bases with their cuts as interface. The part that the deck holds is the first body, the others are
/// joined by fixed hinges, or by constraints where they close a loop or where the deck holds them.
///
/// \throws InputError "cli.bad-option", "cli.bad-range" of the choices; split.* with all errors of one step; what
/// reading, fe and stiffening throw. \note Warns split.inaccurate if an assembled frequency, else split.deflection if
/// a static deflection is off by more than kMaxSplitError.
SplitAnswer split_deck(const SplitRequest& request, Events& events);

}  // namespace bough::analysis
