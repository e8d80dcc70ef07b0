#include "fe/model/sets.hpp"

#include <algorithm>

#include "formats/records/selection.hpp"

namespace bough::fe {
namespace {

std::string describe_duplicate(const std::string& what, int id) {
  return what + "ADD " + std::to_string(id) + " has the id of " + what + " cards, which are left out";
}

}  // namespace

records::Subcase select_subcase(const records::Deck& deck, int id, Diagnostics& diagnostics) {
  const auto& all = deck.subcases;
  const auto found = std::find_if(all.begin(), all.end(), [id](const auto& s) { return id ? s.id == id : s.id > 0; });
  if (found != all.end()) return *found;
  if (id == 0) return all.empty() ? records::Subcase{} : all.front();
  std::string known;
  for (const auto& s : all)
    if (s.id > 0) known += (known.empty() ? "" : " ") + std::to_string(s.id);
  diagnostics.error("fe.unknown-subcase", deck.locate({}),
                    "subcase " + std::to_string(id) + " is not in the deck, expected one of: " +
                        (known.empty() ? "none, the deck has no SUBCASE" : known),
                    "correct the subcase id");
  return {};
}

std::vector<int> expand_set(int sid, const std::vector<records::SetUnion>& unions, const std::vector<int>& plain,
                            const std::string& what, const records::Deck& deck, Diagnostics& diagnostics) {
  struct Entry {
    int id;
    records::CardLocation at;  ///< who names it
    std::size_t depth;         ///< of that one, in `path`
  };
  std::vector<int> result, seen, path;
  std::vector<Entry> open{{sid, records::find_selection(deck, what, sid), 0}};
  while (!open.empty()) {
    const auto [id, at, depth] = open.back();
    open.pop_back();
    path.resize(depth);
    if (std::find(path.begin(), path.end(), id) != path.end()) {
      diagnostics.warning("fe.circular-set", deck.locate(at), what + " set " + std::to_string(id) + " contains itself",
                          "correct the set ids of this card");
      continue;
    }
    if (std::find(seen.begin(), seen.end(), id) != seen.end()) continue;
    seen.push_back(id);
    path.push_back(id);
    const bool is_plain = std::binary_search(plain.begin(), plain.end(), id);
    const records::SetUnion* first = nullptr;
    for (const auto& u : unions) {
      if (u.sid != id) continue;
      if (!first) first = &u;
      for (const int member : u.sets) open.push_back({member, u.at, path.size()});
    }
    if (is_plain && !first) result.push_back(id);
    const bool exists = is_plain || first;
    // Only the union is used (Quick Reference Guide, SPCADD).
    if (is_plain && first)
      diagnostics.warning("fe.duplicate-set", deck.locate(first->at), describe_duplicate(what, id),
                          "give these cards another id and name it, or remove them");
    // Nastran runs such a deck: the selection is often left over when the cards are gone.
    if (!exists)
      diagnostics.warning("fe.missing-set", deck.locate(at),
                          what + " set " + std::to_string(id) + " is selected but has no cards; it adds nothing",
                          "correct the set id or remove it");
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace bough::fe
