#include "formats/nastran/detail/reading.hpp"

#include <algorithm>
#include <set>

#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

bool is_same_field(std::string_view a, std::string_view b) {
  if (a == b || is_word(a, make_upper(b))) return true;
  const auto x = parse_real(a), y = parse_real(b);
  return x && y && *x == *y;
}

}  // namespace

const IdTable::Entry* IdTable::insert(const Entry& entry) {
  if (ascending_.empty() || entry.id > ascending_.back().id) {
    if (!others_.empty())
      if (const auto other = others_.find(entry.id); other != others_.end()) return &other->second;
    ascending_.push_back(entry);
    return nullptr;
  }
  const auto found = std::lower_bound(ascending_.begin(), ascending_.end(), entry.id,
                                      [](const Entry& e, int id) { return e.id < id; });
  if (found != ascending_.end() && found->id == entry.id) return &*found;
  const auto [other, is_new] = others_.emplace(entry.id, entry);
  return is_new ? nullptr : &other->second;
}

bool Reading::claim(IdSpace space, int id, Card& card_, int first_field, int num_fields) {
  return claim_in(ids[static_cast<std::size_t>(space)], id, card_, first_field, num_fields);
}

bool Reading::claim(const std::string& space, int id, Card& card_, int first_field, int num_fields) {
  return claim_in(named_ids_[space], id, card_, first_field, num_fields);
}

bool Reading::claim_rigid(int id, Card& card_, int first_field, int num_fields) {
  const bool is_old = card_.get_name().starts_with("CR");
  auto& table = is_old ? old_rigid_ids_[card_.get_name()] : ids[static_cast<std::size_t>(IdSpace::Rigid)];
  return claim_in(table, id, card_, first_field, num_fields);
}

bool Reading::claim_in(IdTable& table, int id, Card& card_, int first_field, int num_fields) {
  if (!card_.is_ok()) {
    deck.refused[card_.get_name()].insert(id);
    return false;
  }
  const auto* earlier = table.insert({id, card, first_field, num_fields});
  if (earlier == nullptr) return true;
  bool is_same = earlier->card >= 0;
  std::string where;
  if (earlier->card >= 0) {
    CardText text;
    reread(earlier->card, text);
    const auto at = deck.locate(text.lines.front().at);
    where = ", first at " + at.file + ":" + std::to_string(at.line);
    const Card before(text, deck.files, diagnostics);
    is_same = before.get_name() == card_.get_name();
    const int size = std::max(before.get_size(), card_.get_size());
    for (int i = 0; is_same && i < std::min(num_fields, size); ++i)
      is_same = is_same_field(before.get(earlier->first_field + i), card_.get(first_field + i));
  }
  if (is_same)
    card_.warn("deck.repeated-card", first_field,
               "id " + std::to_string(id) + " is given again with the same content" + where,
               "the first one is used; remove one of them");
  else
    card_.fail("deck.duplicate-id", first_field, "id " + std::to_string(id) + " is used twice" + where,
               "give one of them another id");
  return false;
}

void finish_rigid_ids(Reading& r) {
  auto& deck = r.deck;
  int highest = 0;
  const auto visit_all = [&](const auto& visit) {
    const auto visit_each = [&](auto& records) {
      for (auto& record : records) visit(record.id);
    };
    visit_each(deck.rbe2);
    visit_each(deck.rbe1);
    visit_each(deck.rbe3);
    visit_each(deck.rbar);
    visit_each(deck.rrod);
    visit_each(deck.special.rspline);
  };
  visit_all([&](int id) { highest = std::max(highest, id); });
  std::set<int> used;
  visit_all([&](int& id) {
    if (!used.insert(id).second) id = ++highest;
  });
}

bool is_default_card(std::string_view name) { return name == "GRDSET" || name == "BAROR" || name == "BEAMOR"; }

}  // namespace bough::nastran::detail
