#pragma once
/// \file State shared by the card parsers while a deck is read, and the table of parsers.
#include <functional>
#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "formats/nastran/detail/card.hpp"
#include "formats/nastran/detail/card_facts.hpp"

namespace bough::nastran::detail {

/// Ids that must differ from each other.
enum class IdSpace {
  Grid,
  CoordSystem,
  Material,
  BarProperty,
  BeamProperty,
  RodProperty,
  TubeProperty,
  ElasProperty,
  BushProperty,
  MassProperty,
  Bush1dProperty,
  DampProperty,
  ViscProperty,
  ShellProperty,
  ShearProperty,
  SolidProperty,
  Beam,
  Rod,
  Conrod,
  Tube,
  Spring,
  Bush,
  Bush1d,
  Damper,
  Visc,
  Plotel,
  ScalarMass,
  ConcentratedMass,
  Shell,
  Solid,
  Rigid,
  SpcAdd,
  MpcAdd,
  Load,
  EigenMethod,
  General,
  Gap,
  GapProperty,
  Bend,
  BendProperty,
  OldSolidProperty,
  Count
};

/// Location of the card that first used an id; fast for ids in ascending order, the usual order of decks.
class IdTable {
 public:
  struct Entry {
    int id = 0;
    int card = -1;  ///< index of the card, or -1 for a card made by replication
    int first_field = 0, num_fields = 0;
  };
  /// Adds an entry; if the id is there already returns that one instead.
  const Entry* insert(const Entry& entry);

 private:
  std::vector<Entry> ascending_;
  std::unordered_map<int, Entry> others_;
};

/// SPC1 with THRU: expanded once all grids are known.
struct SpcRange {
  int sid = 0;
  unsigned c = 0;
  IdRange range;
  records::CardLocation at;
};

/// ASET1, OMIT1 with THRU, likewise.
struct SetRange {
  std::vector<records::GridComponents>* terms = nullptr;
  unsigned c = 0;
  IdRange range;
  records::CardLocation at;
};
/// State of a DMIG, whose cards come in any order.
struct DmigState {
  std::size_t index = 0;  ///< in deck.direct_matrices
  bool has_header = false, is_polar = false;
};

/// GRDSET, BAROR, BEAMOR: blank fields of later cards.
struct GridDefaults {
  int cp = 0, cd = 0;
  unsigned ps = 0;
};
struct BeamDefaults {
  int pid = 0;
  int g0 = 0;
  std::optional<Eigen::Vector3d> v;
  std::string offt = "GGG";
};

/// Elements of NASTRAN-95 that are read as those of today. Each old property card has a separate range of ids, so that
/// PSHELL and PSOLID get theirs when all cards are known.
struct OldElements {
  struct Use {
    std::size_t index = 0;  ///< in deck.shells or deck.solids
    std::string property;   ///< "PQUAD2", "PIHEX"; empty: the element names a material
  };
  std::map<std::pair<std::string, int>, records::Pshell> shell_properties;  ///< by card and id
  std::map<std::pair<std::string, int>, std::vector<double>> corner_t;      ///< where it varies over a triangle
  std::map<int, records::Psolid> solid_properties;                          ///< PIHEX
  std::vector<Use> shells, solids;
  std::map<std::pair<std::string, std::string>, int> counts;  ///< (old card, card of today)
  records::CardLocation first;

  /// Counts a card of NASTRAN-95 that is read as the card `today`.
  void count(Card& card, const char* today) {
    if (counts.empty()) first = card.get_location();
    ++counts[{card.get_name(), today}];
  }
};

struct Reading {
  /// Starts with an empty state; both arguments must outlive it.
  Reading(records::Deck& deck_read, Diagnostics& diagnostics_of_deck)
      : deck(deck_read), diagnostics(diagnostics_of_deck) {}

  records::Deck& deck;
  Diagnostics& diagnostics;
  /// Makes the text of an earlier card again, to compare duplicates.
  std::function<void(int card, CardText& text)> reread;
  int card = -1;  ///< index of the card being parsed
  std::vector<IdTable> ids = std::vector<IdTable>(static_cast<std::size_t>(IdSpace::Count));
  GridDefaults grid_defaults;
  BeamDefaults bar_defaults, beam_defaults;
  std::vector<SpcRange> spc_ranges;
  std::vector<SetRange> set_ranges;
  std::map<std::string, DmigState> direct_matrices;  ///< by name
  OldElements old_elements;
  std::set<std::string> unread_tables;          ///< DTI, by name
  std::set<int> fluid_grids, fluid_properties;  ///< GRID with CD = -1, PSOLID with FCTN = PFLUID
  records::CardLocation first_fluid;

  /// True if `id` is new in its space. A second card with the same content adds deck.repeated-card, with another
  /// content deck.duplicate-id. The content is num_fields fields from first_field on (all of them by default).
  bool claim(IdSpace space, int id, Card& card_, int first_field = 0, int num_fields = 1 << 20);
  /// Likewise in the space of that name, for cards that no IdSpace has.
  bool claim(const std::string& space, int id, Card& card_, int first_field = 0, int num_fields = 1 << 20);
  /// Claims an id of a rigid element: those of NASTRAN-95 (CRIGD1, CRBAR, ...) share ids with the other names.
  bool claim_rigid(int id, Card& card_, int first_field = 0, int num_fields = 1 << 20);

 private:
  bool claim_in(IdTable& table, int id, Card& card_, int first_field, int num_fields);
  std::map<std::string, IdTable> old_rigid_ids_;  ///< by card name
  std::map<std::string, IdTable> named_ids_;
};

/// Separate ids for rigid elements of NASTRAN-95 that share theirs with an element of another name.
void finish_rigid_ids(Reading& r);

using CardParser = void (*)(Card&, Reading&);
struct CardSink;
using CardWriter = void (*)(const records::Deck&, CardSink&);

/// A row of the table of cards: what formats knows of the card.
struct CardRow : CardFacts {
  CardRow() = default;
  /// \param field_dimensions  CardFacts::dimensions; nullptr: the row has `convert`.
  /// \param field_names  CardFacts::names.
  CardRow(CardParser parser, const char* field_dimensions, const char* field_names = nullptr) : parse(parser) {
    dimensions = field_dimensions;
    names = field_names;
  }

  CardParser parse = nullptr;
  CardWriter write = nullptr;  ///< writes all cards that have this function
  int write_order = 0;         ///< place in a deck that is written: from 1, in the order of write_by
  /// Card that this one is written as, with its `write` for want of another: its fields, or the element of today.
  const char* written_as = nullptr;
};

/// Name -> row of every card that models are read from.
using ParserTable = std::unordered_map<std::string_view, CardRow>;
/// Returns the table of cards, made at the first call.
const ParserTable& get_card_parsers();
/// Sets the writer of these cards, which writes them after all that were set before.
void write_by(ParserTable& table, CardWriter write, std::initializer_list<const char*> cards);
/// Sets the writers of cards with one each, in this order.
void write_by(ParserTable& table, std::initializer_list<std::pair<const char*, CardWriter>> cards);
/// Cards that the reader turns into others, which are written in their place.
void write_as(ParserTable& table, const char* card, std::initializer_list<const char*> others);
/// The three that give defaults are parsed before all others.
bool is_default_card(std::string_view upper_case_name);

}  // namespace bough::nastran::detail
