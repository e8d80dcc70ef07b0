#include "formats/nastran/field_editor.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "formats/nastran/detail/card.hpp"
#include "formats/nastran/detail/card_facts.hpp"
#include "formats/nastran/detail/card_text.hpp"
#include "formats/nastran/detail/changed_files.hpp"
#include "formats/nastran/detail/control.hpp"
#include "formats/nastran/detail/field_text.hpp"
#include "formats/nastran/detail/images.hpp"
#include "formats/nastran/detail/lines.hpp"
#include "formats/nastran/detail/replication.hpp"
#include "formats/nastran/detail/text.hpp"

namespace bough::nastran {

using detail::CardText;
using detail::Line;
using detail::LineChange;

namespace {

/// A line of a card and its first data field.
struct CardLine {
  int line = 0;
  int first_field = 0;
  bool is_large = false;
  int num_fields = 0;  ///< a free-field line may hold more than eight
};

std::string join_some(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size() && i < 12; ++i) text += (i == 0 ? "" : ", ") + words[i];
  return words.size() > 12 ? text + ", ..." : text;
}

/// 0-based data field of a field number, or -1.
int find_data_field(int number) {
  const int column = number % 10;
  return number < 2 || column < 2 ? -1 : 8 * (number / 10) + column - 2;
}

}  // namespace

struct DeckEditor::Contents {
  detail::Source source;
  detail::CardImages images;

  const detail::CardImage& image(int card) const {
    return images.images[static_cast<std::size_t>(images.cards[static_cast<std::size_t>(card)])];
  }
  const Line& line(int i) const { return source.lines[static_cast<std::size_t>(i)]; }
  int num_cards() const { return static_cast<int>(images.cards.size()); }

  std::vector<CardLine> list_lines(int card, CardText& text) const {
    std::vector<CardLine> lines;
    detail::SplitLine split;
    text.clear();
    const auto pad = [&] { text.fields.resize((text.fields.size() + 7) / 8 * 8); };
    const auto* part = &image(card);
    while (true) {
      for (int i = part->first_line; i < part->first_line + part->num_lines; ++i) {
        detail::split_line(line(i).text, split);
        if (lines.empty()) text.name = detail::make_upper(split.name);
        if (!split.is_large) pad();
        lines.push_back({i, static_cast<int>(text.fields.size()), split.is_large, static_cast<int>(split.data.size())});
        text.fields.insert(text.fields.end(), split.data.begin(), split.data.end());
      }
      if (part->next < 0) break;
      part = &images.images[static_cast<std::size_t>(part->next)];
    }
    pad();
    return lines;
  }

  SourceLocation locate(int card) const {
    const auto& at = line(image(card).first_line).at;
    return {source.files[static_cast<std::size_t>(at.file)], at.line, 0};
  }

  bool is_relative(int card) const {
    CardText text;
    if (card >= num_cards()) return false;
    list_lines(card, text);
    return detail::Replicator::is_relative(text);
  }
};

std::string format_field(double value) { return detail::format_exact_real(value); }

DeckEditor::DeckEditor(const std::string& path, Diagnostics& diagnostics) : contents_(std::make_unique<Contents>()) {
  auto& c = *contents_;
  c.source = detail::read_source(path, diagnostics);
  records::Deck control;
  control.files = c.source.files;
  Diagnostics ignored;  // the command that reads the deck reports them
  const auto first = detail::read_control(c.source, control, ignored);
  c.images = detail::make_card_images(c.source, first, ignored);
}
DeckEditor::~DeckEditor() = default;
DeckEditor::DeckEditor(DeckEditor&&) noexcept = default;

const std::vector<std::string>& DeckEditor::get_files() const { return contents_->source.files; }

std::map<std::string, std::string> DeckEditor::list_matrix_kinds() const {
  std::map<std::string, std::string> kinds;
  const auto add = [&](const std::string& name, const char* kind) {
    auto& known = kinds.try_emplace(name, kind).first->second;
    if (known != kind) known = "?";
  };
  detail::LoadColumns columns;
  const auto read = [&](records::DynamicDeck& deck, bool is_response) {
    Diagnostics reported;  // by the readers of the deck
    deck.files = contents_->source.files;
    detail::read_control(contents_->source, deck, reported,
                         {.dynamics = &deck, .load_columns = &columns, .is_response = is_response});
  };
  records::DynamicDeck direct, loads;  // K2PP of the one, P2G of the other
  read(direct, true);
  read(loads, false);
  for (const auto& subcase : direct.subcases) {
    for (const auto& [factor, name] : subcase.k2gg) add(name, "K");
    for (const auto& [factor, name] : subcase.m2gg) add(name, "M");
    for (const auto& [factor, name] : subcase.b2gg) add(name, "B");
  }
  for (const auto& [subcase, list] : columns)
    for (const auto& column : list) add(column.matrix, "P");
  return kinds;
}

std::vector<DeckCard> DeckEditor::list_cards() const {
  const auto& c = *contents_;
  std::vector<DeckCard> cards;
  CardText text;
  for (int card = 0; card < c.num_cards(); ++card) {
    c.list_lines(card, text);
    DeckCard found{card, std::string(text.name), {}, c.locate(card), c.is_relative(card)};
    for (const auto& field : text.fields) found.fields.emplace_back(field);
    cards.push_back(found);
  }
  return cards;
}

std::optional<FieldPlace> DeckEditor::find(const FieldAddress& address, const SourceLocation& asked_at,
                                           Diagnostics& diagnostics) const {
  const auto& c = *contents_;
  const auto name = detail::make_upper(detail::trim(address.card));
  const auto id = detail::make_upper(detail::trim(address.id));
  const int entry_size = detail::get_entry_size(name);
  std::set<std::string> names;
  std::vector<std::string> ids;
  std::vector<FieldPlace> found;
  CardText text;
  for (int card = 0; card < c.num_cards(); ++card) {
    const auto first = detail::make_upper(detail::get_first_field(c.line(c.image(card).first_line).text));
    const auto bare = std::string(detail::trim(std::string_view(first).substr(0, first.find('*'))));
    names.insert(bare);
    if (bare != name) continue;
    c.list_lines(card, text);
    const int last = entry_size > 0 ? 8 : 1;
    for (int field = 0; field < last; field += std::max(entry_size, 1)) {
      const auto own = detail::make_upper(text.fields[static_cast<std::size_t>(field)]);
      if (own.empty() && field > 0) continue;
      ids.push_back(own);
      if (id.empty() || own == id) found.push_back({card, field});
    }
  }
  if (found.empty()) {
    const std::vector<std::string> all(names.begin(), names.end());
    const auto nearest = find_nearest(ids.empty() ? name : id, ids.empty() ? all : ids);
    diagnostics.error(
        "batch.unknown-card", asked_at,
        ids.empty() ? "the deck has no card " + name : "no " + name + " of the deck has the id " + address.id,
        (nearest.empty() ? "" : "did you mean " + nearest + "; ") + std::string("it has ") +
            join_some(ids.empty() ? all : ids));
    return std::nullopt;
  }
  const auto count = static_cast<int>(found.size());
  if (address.occurrence > count || (address.occurrence == 0 && count > 1)) {
    std::vector<std::string> places;
    for (const auto& place : found) places.push_back(std::to_string(c.locate(place.card).line));
    diagnostics.error(
        "batch.ambiguous-card", asked_at,
        std::to_string(count) + " cards " + name + (id.empty() ? "" : " have the id " + address.id) + ", in lines " +
            join_some(places),
        std::string(id.empty() ? "give id, or " : "give ") + "occurrence = 1 to " + std::to_string(count));
    return std::nullopt;
  }
  auto place = found[static_cast<std::size_t>(std::max(address.occurrence, 1) - 1)];
  if (address.field.empty()) {
    place.field = find_data_field(address.number);
    if (place.field < 0) {
      diagnostics.error("batch.unknown-field", asked_at,
                        "field " + std::to_string(address.number) + " is no data field",
                        "the manuals count 2 to 9 in the first line of a card, 12 to 19 in its second, and so on");
      return std::nullopt;
    }
  } else {
    const auto& known = detail::get_field_names(name);
    const auto requested = detail::make_upper(detail::trim(address.field));
    const auto at = std::find(known.begin(), known.end(), requested);
    if (at == known.end() || requested == "-") {
      const auto nearest = find_nearest(requested, known);
      diagnostics.error("batch.unknown-field", asked_at, name + " has no field " + address.field,
                        known.empty() ? "fields of this card have no names here; give its number, as field = 3"
                                      : (nearest.empty() ? "" : "did you mean " + nearest + "; ") +
                                            std::string("its fields are ") + join_some(known));
      return std::nullopt;
    }
    place.field += static_cast<int>(at - known.begin());
  }
  if (c.is_relative(place.card) || c.is_relative(place.card + 1)) {
    const auto where = c.locate(place.card);
    diagnostics.error(
        "batch.replicated-card", asked_at,
        name + " at " + where.file + ":" + std::to_string(where.line) + " is written or copied by replication",
        "write the deck out with bough export --to bdf first");
    return std::nullopt;
  }
  return place;
}

std::string DeckEditor::get_text(const FieldPlace& place) const {
  CardText text;
  contents_->list_lines(place.card, text);
  const auto field = static_cast<std::size_t>(place.field);
  return field < text.fields.size() ? std::string(text.fields[field]) : std::string();
}

std::vector<EditedFile> DeckEditor::write(const std::string& name, const std::vector<FieldEdit>& edits) const {
  const auto& c = *contents_;
  std::map<int, LineChange> changes;  // by line of the source
  CardText card_text;
  for (const auto& edit : edits) {
    const auto lines = c.list_lines(edit.place.card, card_text);
    auto at = std::find_if(lines.rbegin(), lines.rend(),
                           [&](const CardLine& l) { return l.first_field <= edit.place.field; });
    int field = edit.place.field - at->first_field;
    const bool is_large = at->is_large;
    const auto& line = c.line(at->line);
    auto [change, is_new] = changes.try_emplace(at->line, LineChange{std::string(line.text), {}});
    const auto fail = [&] {
      const auto where = c.locate(edit.place.card);
      throw InputError("batch.field-width", {where.file, line.at.line, 0},
                       "the value " + edit.text + " does not fit the field of " + card_text.name + " '" +
                           std::string(line.text) + "'",
                       "write the card in free field");
    };
    if (field < std::max(at->num_fields, is_large ? 4 : 8)) {
      const auto changed = detail::set_line_field(change->second.text, field, edit.text);
      if (changed.empty()) fail();
      change->second.text = changed;
      continue;
    }
    // The card ends before this field. The lines that are added are free-field ones; a large pair is made full first.
    if (!change->second.added.empty()) fail();
    auto mark = detail::make_continuation_mark(line.text, false);
    if (is_large && at->first_field % 8 == 0) {
      mark = detail::make_continuation_mark(line.text, true);
      if (field < 8) {
        change->second.added = mark + std::string(static_cast<std::size_t>(field - 3), ',') + edit.text + "\n";
        continue;
      }
      change->second.added = mark + ",\n";
      mark = "+";
    }
    field -= is_large && at->first_field % 8 != 0 ? 4 : 8;
    for (; field >= 8; field -= 8, mark = "+") change->second.added += mark + ",\n";
    change->second.added += mark + std::string(static_cast<std::size_t>(field + 1), ',') + edit.text + "\n";
  }

  return detail::write_changed_files(c.source, name, changes);
}

}  // namespace bough::nastran
