#pragma once
/// \\file Copies of the files of a deck, byte-identical except for some changed lines.
#include <map>
#include <string>
#include <vector>

#include "formats/nastran/detail/lines.hpp"
#include "formats/nastran/field_editor.hpp"

namespace bough::nastran::detail {

struct LineChange {
  std::string text;   ///< instead of the line, without its comment
  std::string added;  ///< lines after it
};

/// The main file under `name`, and every file that changes or includes one that does under a name made of it; INCLUDE
/// statements name these, or the others by their full paths. `changes`: by line of the source.
std::vector<EditedFile> write_changed_files(const Source& source, const std::string& name,
                                            const std::map<int, LineChange>& changes);

}  // namespace bough::nastran::detail
