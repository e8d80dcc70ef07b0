#include "formats/records/deck.hpp"

namespace bough::records {

const Param* Deck::find_param(const std::string& name) const {
  if (autospc_command && name == "AUTOSPC") return &*autospc_command;
  for (auto p = params.rbegin(); p != params.rend(); ++p)
    if (p->name == name) return &*p;
  return nullptr;
}

CardLocation Subcase::find_command(const std::string& command) const {
  const auto found = commands.find(command);
  return found == commands.end() ? CardLocation{} : found->second;
}

bool Deck::is_refused(int id, const std::vector<std::string>& cards) const {
  for (const auto& card : cards)
    if (const auto ids = refused.find(card); ids != refused.end() && ids->second.count(id) > 0) return true;
  return false;
}

SourceLocation Deck::locate(const CardLocation& at) const {
  const bool known = at.file >= 0 && at.file < static_cast<int>(files.size());
  return {known ? files[at.file] : std::string{}, at.line, 0};
}

}  // namespace bough::records
