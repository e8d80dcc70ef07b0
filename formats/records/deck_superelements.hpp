#pragma once
/// \file Superelements of a deck: their cards and sections, and the joined record that fe makes an element of.
#include <bit>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "formats/records/card_location.hpp"

namespace bough::records {

struct Deck;

/// SEBULK: a superelement that has a section (BEGIN SUPER).
struct Sebulk {
  int id = 0;
  std::string type;      ///< "PRIMARY", "EXTOP4", "EXTERNAL", ...
  int reference = 0;     ///< RSEID of REPEAT and MIRROR
  bool is_auto = true;   ///< METHOD: coincident grids are joined; MANUAL: SECONCT alone joins
  double tolerance = 0;  ///< of coincident grids
  int unit = 0;          ///< of ASSIGN INPUTT4, which has its matrices
  CardLocation at;
};

/// SECONCT: points of superelement `a` and the points of `b` to which they are joined. SEBNDRY: points of `a` with 0,
/// the grids that the automatic search looks at.
struct Seconct {
  int a = 0, b = 0;
  double tolerance = 0;
  std::vector<std::pair<int, int>> points;
  CardLocation at;
};

/// SELOAD: load set `set` of the residual structure takes load `load` of an external superelement with it.
struct Seload {
  int set = 0, superelement = 0, load = 0;
  CardLocation at;
};

/// Exterior point of a superelement; components of a grid as a mask, 0: a scalar point.
struct ExteriorPoint {
  int id = 0;
  unsigned c = 0;
};

/// DTI TUG1, TEF1, TES1, TQG1: the rows of a recovery matrix, item after item.
struct RecoveryItem {
  int type = 0;  ///< 1 grid, 2 scalar point; of forces and stresses Nastran's number of the element type
  int id = 0;
  int num_rows = 0, first_row = 0;  ///< 0-based
};
struct RecoveryRows {
  std::string name;  ///< "TUG1"
  std::vector<RecoveryItem> items;
  CardLocation at;
};

/// BEGIN SUPER = id and what follows, as a deck. The id may be given by several sections.
struct DeckSection {
  int id = 0;
  std::shared_ptr<const Deck> deck;
  CardLocation at;
};

/// ASSIGN INPUTT4 = 'file', UNIT = n
struct AssignedFile {
  std::string path;  ///< as written
  CardLocation at;
};

/// EXTSEOUT of the case control: the deck is to be written as an external superelement.
struct ExternalOutput {
  int id = 0;    ///< EXTID
  int unit = 0;  ///< MATOP4
  CardLocation at;
};

/// The superelement cards of a deck, and of a section its own.
struct SuperelementCards {
  std::vector<Sebulk> sebulk;
  std::vector<Seconct> seconct;
  std::vector<Seload> seload;
  std::vector<DeckSection> sections;
  std::map<int, AssignedFile> input4;  ///< by unit
  std::vector<ExteriorPoint> extrn;    ///< of a section: the rows of its matrices
  CardLocation extrn_at;
  std::vector<RecoveryRows> rows;   ///< of a section
  std::map<int, int> load_columns;  ///< of a section: 1-based column of PX, by load (DTI SELOAD)
  std::optional<ExternalOutput> output;
  bool is_joined = false;  ///< Deck::superelements is made of these

  /// Returns true if the deck has no superelement.
  bool empty() const { return sebulk.empty() && seconct.empty() && sections.empty(); }
};

/// A recovery matrix of a superelement: rows x exterior dofs. MUG1O, ... after MUG1, ...: values of each column of P
/// with the exterior dofs held, rows x loads.
struct RecoveryTable {
  std::string name;  ///< "MUG1", "MEF1", "MES1", "MQG1"; "MUG1O", ...
  std::vector<RecoveryItem> items;
  Eigen::MatrixXd rows;
};

/// A superelement as its matrices on its exterior dofs: point after point, in the displacement axes of its section.
struct Superelement {
  int id = 0;
  CardLocation at;
  std::shared_ptr<const Deck> section;  ///< grids and coordinate systems of the exterior points
  std::string file;                     ///< of the matrices; empty: those of the section
  std::vector<ExteriorPoint> points;
  std::map<int, int> joined;    ///< point of the deck, by exterior point
  bool joins_places = false;    ///< exterior points that `joined` lacks join the coincident point of the deck
  double tolerance = 0;         ///< of coincident points
  bool checks_places = false;   ///< joined points are to be at one place
  Eigen::MatrixXd K, M, B, K4;  ///< empty: zero
  /// Geometric stiffness of a unit motion of each exterior dof, num_dofs() matrices, then of the stress of each load
  /// with the exterior dofs held, by column of P; empty: not known.
  std::vector<Eigen::MatrixXd> K_G;
  Eigen::MatrixXd P;                ///< loads on the exterior dofs, a column each
  std::map<int, int> load_columns;  ///< 0-based column of P, by load
  std::vector<RecoveryTable> recovery;

  /// Number of exterior dofs: 1 for a scalar point, else the components of each point.
  Eigen::Index num_dofs() const {
    Eigen::Index sum = 0;
    for (const auto& point : points) sum += point.c == 0 ? 1 : std::popcount(point.c);
    return sum;
  }
};

}  // namespace bough::records
