#pragma once
/// \file A template of the .FLX file: which blocks, in which order of indices, columns and words (docs/formats/flx.md).
#include <string>
#include <vector>

#include "formats/flx/number_format.hpp"

namespace bough::flx {

/// Text with {fields}, cut into pieces: a plain piece, or the name of a field with its format.
struct TextTemplate {
  struct Piece {
    std::string plain, field;
    std::optional<NumberFormat> format;
  };
  std::vector<Piece> pieces;
};

enum class NodeSet { Output, Special, All };

/// One line of a layout.
struct Statement {
  enum class Kind { Text, Block, For, When } kind = Kind::Text;
  int line = 0;
  std::string name;        ///< of the block, the index of a loop, or what the file must have
  TextTemplate text;       ///< of a text; the label of a block
  TextTemplate continued;  ///< label of the further lines of a record
  bool has_continued = false, has_heading = false;
  TextTemplate heading;       ///< line before the block, where the block has values
  std::string order, record;  ///< letters of the indices; record: the last one that starts a new line
  bool has_record = false;
  std::vector<std::pair<char, int>> fixed;  ///< index, value (1-based)
  int per_line = 0;                         ///< 0: no limit
  char triangle = 0;                        ///< 'u', 'l' or 0: of a matrix j, k
  NodeSet nodes = NodeSet::All;
  std::string separator;
  NumberFormat number, integer;
  std::vector<Statement> body;  ///< of a loop or a condition
};

struct Layout {
  std::string file;
  std::vector<Statement> statements;
  int digits = 9;
};

/// Throws InputError with all of "flx.layout-syntax", "flx.layout-name", each with its line.
Layout parse_layout(const std::string& text, const std::string& file);
/// Throws "flx.cannot-read" besides.
Layout read_layout(const std::string& path);

/// Bough's own, version 1.1, that read_flx reads; 2 to 17 significant digits.
Layout make_native_layout(int digits);

/// A block that a layout may name, and its indices: i nodes, j k modes, a b axes, d the six gains, l the twelve
/// inertial loads, e the locators.
struct BlockInfo {
  std::string name, indices;
};
/// Returns all blocks that a layout may name.
const std::vector<BlockInfo>& get_blocks();

}  // namespace bough::flx
