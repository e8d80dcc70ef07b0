#include "formats/records/deck.hpp"

namespace bough::records {

const Param* Deck::find_param(const std::string& name) const {
  for (auto p = params.rbegin(); p != params.rend(); ++p)
    if (p->name == name) return &*p;
  return nullptr;
}

SourceLocation Deck::locate(const CardLocation& at) const {
  const bool known = at.file >= 0 && at.file < static_cast<int>(files.size());
  return {known ? files[at.file] : std::string{}, at.line, 0};
}

}  // namespace bough::records
