#include "formats/nastran/detail/builder.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <tuple>
#include <unordered_set>

#include "formats/nastran/detail/design.hpp"
#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/detail/known_cards.hpp"
#include "formats/nastran/detail/leftovers.hpp"
#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/replication.hpp"
#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

/// Beyond this many lines that are no cards the file is not a deck.
constexpr int max_unreadable = 20;
constexpr int kMaxWrongCopies = 1000;  // what is wrong in these is wrong in millions
constexpr int max_repeats = 1'000'000;
/// Unknown names for which the nearest known one is looked for.
constexpr int max_proposals = 20;
/// Limit for all repeat lines of a deck together.
constexpr long max_all_repeats = 2'000'000;

/// Treatment of one card name, and its number of cards.
struct NameEntry {
  CardParser parser = nullptr;      ///< nullptr: counted only
  DynamicParser dynamic = nullptr;  ///< of responses, in place of it
  int count = 0;
  records::CardLocation first;
};

bool is_card_name(std::string_view name) {
  if (name.empty() || name.size() > 8 || !std::isalpha(static_cast<unsigned char>(name.front()))) return false;
  return std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c); });
}

class Builder {
 public:
  Builder(const Source& source, std::size_t first_line, const ReadOptions& options, records::Deck& deck,
          Diagnostics& diagnostics, records::DynamicDeck* dynamics)
      : source_(source),
        deck_(deck),
        dynamics_(dynamics),
        is_response_(dynamics && options.is_response),
        is_complex_(dynamics && options.is_complex),
        diagnostics_(diagnostics),
        images_(make_card_images(source, first_line, diagnostics)),
        reading_(deck, diagnostics) {
    for (const auto& name : options.ignore_cards) ignored_.insert(make_upper(trim(name)));
    design_.set_values(options.design_values);
    reading_.reread = [this](int card, CardText& text) {
      join(card, text);
      design_.apply(text);
    };
  }

  void read() {
    const int num_cards = static_cast<int>(images_.cards.size());
    for (int card = 0; card < num_cards && !begins_section(card); ++card) read_ahead(card);
    const bool is_design = deck_.sol == "200" || deck_.sol == "DESOPT";
    design_.finish(is_design, deck_.sol, deck_, diagnostics_);
    if (dynamics_) dynamics_->dynamics.design_variables = design_.list_variables();
    for (int card = 0; card < num_cards && !stopped_; ++card) read_card(card);
    if (num_unreadable_ > max_unreadable)
      diagnostics_.error("deck.unreadable-line", {deck_.files.front(), 0, 0},
                         "and " + std::to_string(num_unreadable_ - max_unreadable) + " more lines that are no cards",
                         "check that the file is a Nastran deck");
    expand_ranges(reading_);
    finish_direct_matrices(reading_);
    finish_fluid(reading_);
    finish_old_elements(reading_);
    finish_rigid_ids(reading_);
    design_.report(deck_, diagnostics_);
    leftovers_.report(diagnostics_);
    report_names();
  }

 private:
  const Line& line(int i) const { return source_.lines[static_cast<std::size_t>(i)]; }
  const CardImage& image(int card) const {
    return images_.images[static_cast<std::size_t>(images_.cards[static_cast<std::size_t>(card)])];
  }

  /// Lines of a card with more fields than they have; nullptr: none.
  struct Excess {
    const Line* data = nullptr;    ///< after a continuation mark
    const Line* number = nullptr;  ///< alone in field 10, and no line continues it
  };

  /// The text of a card.
  Excess join(int card, CardText& text) {
    text.clear();
    Excess excess;
    const Line* numbered = nullptr;  // its tag is a number
    std::string_view number;
    const CardImage* part = &image(card);
    while (true) {
      for (int i = part->first_line; i < part->first_line + part->num_lines; ++i) {
        if (numbered != nullptr && !is_continued_by(number, line(i).text)) excess.number = numbered;
        split_line(line(i).text, split_);
        if (text.lines.empty()) {
          text.name.assign(split_.name);
          for (char& c : text.name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        }
        // Large lines come in pairs; an odd one is followed by blanks.
        if (!split_.is_large) pad(text);
        text.lines.push_back({static_cast<int>(text.fields.size()), line(i).at, line(i).text});
        text.fields.insert(text.fields.end(), split_.data.begin(), split_.data.end());
        if (split_.num_excess > 0) excess.data = &line(i);
        numbered = split_.has_number_tag ? &line(i) : nullptr;
        number = split_.tag;
      }
      if (part->next < 0) break;
      part = &images_.images[static_cast<std::size_t>(part->next)];
    }
    pad(text);
    if (numbered != nullptr) excess.number = numbered;
    return excess;
  }

  static void pad(CardText& text) { text.fields.resize((text.fields.size() + 7) / 8 * 8); }

  /// A separate section (BEGIN SUPER): its cards are not part of this model.
  bool begins_section(int card) const {
    const auto text = trim(line(image(card).first_line).text);
    if (text.size() < 5 || !is_word(find_first_word(text), "BEGIN")) return false;
    const auto section = find_first_word(text.substr(5));
    return !section.empty() && (!is_word(section, "BULK") || !trim(trim(text.substr(5)).substr(4)).empty());
  }

  /// Reads cards on which all others depend: defaults (GRDSET, BAROR, BEAMOR) and design variables.
  void read_ahead(int card) {
    const auto first = get_first_field(line(image(card).first_line).text);
    if (first.size() < 5 || std::string_view("GgBbDd").find(first.front()) == std::string_view::npos) return;
    auto name = make_upper(first);
    if (name.back() == '*') name = trim(std::string_view(name).substr(0, name.size() - 1));
    if (ignored_.count(name) > 0) return;
    if (Design::is_design(name) || Design::is_of_equations(name)) {
      join(card, text_);
      design_.add(text_, deck_.files, diagnostics_);
    }
    if (!is_default_card(name)) return;
    join(card, text_);
    Card parsed(text_, deck_.files, diagnostics_);
    if (const auto [earlier, is_new] = defaults_seen_.emplace(name, card); !is_new) {
      join(earlier->second, relative_);
      const auto where = at_text(relative_.lines.front().at);
      if (relative_.fields == text_.fields)
        parsed.warn("deck.repeated-card", 0, "the card is given again with the same content, first at " + where,
                    "remove one of them");
      else
        parsed.fail("deck.duplicate-id", 0, "the card is given twice, first at " + where, "keep one of them");
      return;
    }
    get_card_parsers().at(name).parse(parsed, reading_);
    leftovers_.add(parsed);
  }

  std::string at_text(const records::CardLocation& at) const {
    const auto where = deck_.locate(at);
    return where.file + ":" + std::to_string(where.line);
  }

  void read_card(int card) {
    const Excess excess = join(card, text_);
    if (skip_statement()) return;
    const bool is_relative = Replicator::is_relative(text_);
    if (excess.data != nullptr && (is_relative || is_read(text_.name)))
      diagnostics_.error("deck.too-many-fields", deck_.locate(excess.data->at),
                         text_.name + ": the free-field line has data after a continuation mark",
                         "continue on another line that begins with a comma");
    else if (excess.number != nullptr && (is_relative || is_read(text_.name)))
      diagnostics_.warning("deck.too-many-fields", deck_.locate(excess.number->at),
                           text_.name +
                               ": the number in field 10 of the free-field line is not read: Nastran takes it "
                               "for a continuation mark",
                           "continue on another line that begins with a comma if it is data");
    reading_.card = card;
    if (!is_relative) {
      last_is_plain_ = true;
      last_card_ = card;
      dispatch();
      return;
    }
    if (last_is_plain_) {
      join(last_card_, relative_);
      replicator_.remember(relative_);
      replicator_.clear_increments();
      last_is_plain_ = false;
    }
    reading_.card = -1;
    if (const auto repeats = Replicator::find_repeats(text_)) {
      if (*repeats < 1 || *repeats > max_repeats)
        fail_replication("the repeat count is " + std::to_string(*repeats) + ", expected 1 to 1000000");
      if (*repeats > max_repeats) return;
      num_repeats_ += *repeats;
      if (num_repeats_ > max_all_repeats) {
        fail_replication("the repeat lines of the deck make more than 2000000 cards");
        stopped_ = true;
        return;
      }
      const int before = diagnostics_.num_errors();
      for (int i = 0; i < *repeats; ++i) {
        if (!finish_relative(replicator_.make_copy(text_))) return;
        if (diagnostics_.num_errors() - before < kMaxWrongCopies) continue;
        if (i + 1 < *repeats)
          fail_replication(std::to_string(kMaxWrongCopies) + " errors of its copies; the other " +
                           std::to_string(*repeats - i - 1) + " are not read");
        return;
      }
      return;
    }
    finish_relative(replicator_.resolve(text_));
  }

  bool reads_rotors() const { return is_complex_ || is_response_; }

  bool is_read(const std::string& name) const {
    return ignored_.count(name) == 0 &&
           (get_card_parsers().count(name) > 0 || (dynamics_ && get_dynamic_parsers().count(name) > 0) ||
            (is_complex_ && get_complex_parsers().count(name) > 0) ||
            (reads_rotors() && get_rotor_parsers().count(name) > 0));
  }

  /// Lines that are no cards and change nothing here: a deletion, which belongs to a restart, and a second BEGIN BULK.
  bool skip_statement() {
    const auto where = [&] { return deck_.locate(text_.lines.front().at); };
    if (!text_.name.empty() && text_.name.front() == '/') {
      diagnostics_.warning("deck.delete-line", where(),
                           "'" + text_.name + "' deletes cards of an earlier run: not done",
                           "a deck is read unchanged; remove the cards that should not be used");
      return true;
    }
    if (text_.name.substr(0, 5) != "BEGIN") return false;
    const auto statement = trim(text_.lines.front().text);
    const auto section = make_upper(trim(statement.substr(5)));
    if (find_first_word(statement).size() != 5 || (section != "" && section != "BULK")) return false;
    diagnostics_.warning("deck.second-begin", where(), "a second BEGIN BULK: what follows is read as part of the first",
                         "remove it if the deck is one");
    return true;
  }

  bool finish_relative(const std::string& wrong) {
    if (!wrong.empty()) {
      fail_replication(wrong);
      return false;
    }
    for (std::size_t i = 1; i < text_.lines.size(); ++i) text_.lines[i].first_field = static_cast<int>(8 * i);
    pad(text_);
    replicator_.remember(text_);
    dispatch();
    return true;
  }

  void fail_replication(const std::string& wrong) {
    diagnostics_.error("deck.bad-replication", deck_.locate(text_.lines.front().at), wrong,
                       "see the rules of replication, or write the card out");
  }

  void dispatch() {
    NameEntry* entry = last_entry_;
    if (entry == nullptr || text_.name != last_name_) {
      if (!is_card_name(text_.name)) {
        refuse_line();
        return;
      }
      entry = &find_entry();
      last_entry_ = entry;
      last_name_ = text_.name;
    }
    if (entry->count++ == 0) entry->first = text_.lines.front().at;
    if (entry->parser == nullptr && entry->dynamic == nullptr) keep_unread_load();
    if (entry->parser == nullptr) keep_base();
    if (dynamics_ && !is_response_ && !is_complex_ && text_.name == "EPOINT") keep_extra_points();
    if ((entry->parser == nullptr && entry->dynamic == nullptr) || is_default_card(text_.name)) return;
    design_.apply(text_);
    if (entry->dynamic != nullptr && is_unselected()) return parse_unselected(*entry, "the set");
    if (is_unselected_material()) return parse_unselected(*entry, "a temperature of materials");
    Card card(text_, deck_.files, diagnostics_);
    if (entry->dynamic != nullptr)
      entry->dynamic(card, dynamics_->dynamics);
    else
      entry->parser(card, reading_);
    if (card.is_ok()) leftovers_.add(card);
    if (card.has_unkept()) keep_left_out("fields of " + text_.name + " that are not used");
  }

  /// Names what no record keeps, for a deck that is written.
  void keep_left_out(const std::string& text) {
    if (std::find(deck_.left_out.begin(), deck_.left_out.end(), text) == deck_.left_out.end())
      deck_.left_out.push_back(text);
  }

  void keep_extra_points() {
    Diagnostics ignored_diagnostics;  // the card is named as not used
    Card card(text_, deck_.files, ignored_diagnostics);
    for (const int id : read_ids(card, 0, card.get_size(), "ID")) dynamics_->dynamics.extra_points.insert(id);
  }

  /// Returns true if a subcase selects a response, complex modes or residual vectors.
  bool selects_dynamics() const {
    using records::DynamicSelection;
    static constexpr int DynamicSelection::*sets[] = {
        &DynamicSelection::dload,   &DynamicSelection::loadset, &DynamicSelection::frequency,
        &DynamicSelection::tstep,   &DynamicSelection::ic,      &DynamicSelection::sdamping,
        &DynamicSelection::cmethod, &DynamicSelection::tfl,     &DynamicSelection::random,
        &DynamicSelection::rcross,  &DynamicSelection::rgyro,   &DynamicSelection::rmethod};
    return std::any_of(dynamics_->selections.begin(), dynamics_->selections.end(), [](const auto& one) {
      return one.second.resvec.value_or(false) ||
             std::any_of(std::begin(sets), std::end(sets), [&](auto set) { return one.second.*set != 0; });
    });
  }

  /// Returns true if the card is of a set that a command selects, and no subcase does; or, of a deck that is written
  /// again, if none selects any such card.
  bool is_unselected() const {
    if (is_complex_ && !selects_dynamics()) return true;
    const auto member = find_selection_of(text_.name);
    const auto set = member && !text_.fields.empty() ? parse_int(text_.fields.front()) : std::nullopt;
    return set && std::none_of(dynamics_->selections.begin(), dynamics_->selections.end(),
                               [&](const auto& selection) { return std::abs(selection.second.*member) == *set; });
  }

  /// Returns true if the card is a table of a material, and no subcase selects a temperature of materials.
  bool is_unselected_material() const {
    if (!text_.name.starts_with("TABLEM") && !text_.name.starts_with("MATT")) return false;
    return std::all_of(deck_.subcases.begin(), deck_.subcases.end(), [](const auto& subcase) {
      return subcase.material_temperature == 0 && subcase.initial_temperature == 0;
    });
  }

  /// Nastran uses selected sets only: errors in other sets are warnings, and these sets are not read.
  /// \param what  that no subcase selects
  void parse_unselected(const NameEntry& entry, const char* what) {
    Diagnostics own;
    Card card(text_, deck_.files, own);
    if (entry.dynamic != nullptr)
      entry.dynamic(card, dynamics_->dynamics);
    else
      entry.parser(card, reading_);
    for (auto item : own.items()) {
      if (item.severity == Severity::Error) {
        item.severity = Severity::Warning;
        item.what += std::string("; no subcase selects ") + what + ", and the card is not used";
      }
      diagnostics_.add(std::move(item));
    }
    if (card.is_ok())
      leftovers_.add(card);
    else
      keep_left_out(text_.name + " with errors");
    if (card.has_unkept()) keep_left_out("fields of " + text_.name + " that are not used");
  }

  void keep_unread_load() {
    const auto command = find_selecting_command(text_.name);
    if (command.empty() || ignored_.count(text_.name) > 0 || text_.fields.empty()) return;
    const auto set = parse_int(text_.fields.front());
    if (set && unread_sets_.emplace(text_.name, *set).second)
      deck_.unread_loads.push_back({text_.name, std::string(command), *set, text_.lines.front().at});
  }

  /// Cards that extend a property or a material do nothing where that is not there.
  void keep_base() {
    const auto kind = find_base(text_.name);
    if (kind == CardBase::None || ignored_.count(text_.name) > 0 || text_.fields.empty()) return;
    const bool acts = std::any_of(text_.fields.begin() + 1, text_.fields.end(),
                                  [](const auto& field) { return !trim(field).empty(); });
    if (const auto id = parse_int(text_.fields.front()); id && acts) bases_[text_.name].push_back(*id);
  }

  /// Returns true if one of these cards extends a property or a material of the deck.
  bool has_base(const std::string& name) const {
    const auto found = bases_.find(name);
    if (found == bases_.end()) return false;
    const auto is_in = [](const auto& records, int id) {
      return std::any_of(records.begin(), records.end(), [id](const auto& r) { return r.id == id; });
    };
    return std::any_of(found->second.begin(), found->second.end(), [&](int id) {
      return is_in(deck_.mat1, id) || is_in(deck_.mat2, id) || is_in(deck_.mat8, id) || is_in(deck_.mat9, id);
    });
  }

  NameEntry& find_entry() {
    const auto [found, is_new] = names_.try_emplace(text_.name);
    if (is_new && ignored_.count(text_.name) == 0) {
      const auto& parsers = get_card_parsers();
      if (const auto parser = parsers.find(text_.name); parser != parsers.end())
        found->second.parser = parser->second.parse;
      const auto& responses = get_dynamic_parsers();
      if (const auto parser = responses.find(text_.name); dynamics_ && parser != responses.end())
        found->second.dynamic = parser->second.parse;
      const auto& of_complex_modes = get_complex_parsers();
      if (const auto parser = of_complex_modes.find(text_.name); is_complex_ && parser != of_complex_modes.end())
        found->second.dynamic = parser->second.parse;
      const auto& of_rotors = get_rotor_parsers();
      if (const auto parser = of_rotors.find(text_.name); reads_rotors() && parser != of_rotors.end())
        found->second.dynamic = parser->second.parse;
    }
    return found->second;
  }

  void refuse_line() {
    const auto where = deck_.locate(text_.lines.front().at);
    const auto first = text_.lines.front().text;
    if (is_word(find_first_word(first), "BEGIN")) {
      diagnostics_.error("deck.unsupported-section", where,
                         "'" + std::string(trim(first)) + "' begins another bulk section",
                         "superelement and other sections are not read; give the structure as one bulk data section");
      stopped_ = true;
      return;
    }
    if (++num_unreadable_ > max_unreadable) return;
    diagnostics_.error("deck.unreadable-line", where,
                       "'" + text_.name + "' is no card name, expected a letter and up to seven letters or digits",
                       text_.name.substr(0, 3) == "END"
                           ? "the end of the deck is written ENDDATA"
                           : "fixed fields are eight columns wide and begin with the name; comments begin with $");
  }

  /// Counts of all names; one message for each name that is not read, in the order of the deck.
  void report_names() {
    std::vector<const std::pair<const std::string, NameEntry>*> unread;
    for (const auto& entry : names_) {
      deck_.card_counts[entry.first] = entry.second.count;
      const bool is_read = entry.second.parser != nullptr || entry.second.dynamic != nullptr;
      const auto in_response = is_response_ ? find_response_effect(entry.first) : std::nullopt;
      const bool is_lost = (find_loss(entry.first) != nullptr && entry.second.dynamic == nullptr) ||
                           (in_response && !in_response->needs_command);
      if (!is_read || is_lost) unread.push_back(&entry);
    }
    std::sort(unread.begin(), unread.end(), [](const auto* a, const auto* b) {
      const auto &x = a->second.first, &y = b->second.first;
      return std::tie(x.file, x.line, a->first) < std::tie(y.file, y.line, b->first);
    });
    for (const auto* entry : unread) report_unread(entry->first, entry->second);
  }

  void report_unread(const std::string& name, const NameEntry& entry) {
    const auto effect = find_effect(name);
    const auto where = deck_.locate(entry.first);
    const bool is_ignored = ignored_.count(name) > 0;
    if (design_.uses(name) && !is_ignored) return;
    if (Design::is_design(name) && !is_ignored && !design_.is_empty()) {
      deck_.unused.push_back({name, records::CardEffect::None, entry.count, entry.first});
      return;  // design_ has said it
    }
    if (entry.parser == nullptr)
      deck_.unused.push_back({name, effect.value_or(records::CardEffect::None), entry.count, entry.first});
    const std::string times = entry.count == 1 ? "1 card" : std::to_string(entry.count) + " cards, the first here";
    if (!effect) {
      // A file of words that is no deck has no end of them.
      const auto nearest = ++num_unknown_ > max_proposals ? std::string{} : find_nearest_card(name);
      const std::string what = name + " is not the name of a Nastran card (" + times + ")";
      if (is_ignored)
        diagnostics_.warning("deck.ignored-card", where, what, "ignored as asked");
      else
        diagnostics_.error("deck.unknown-card", where, what,
                           (nearest.empty() ? std::string{} : "did you mean " + nearest + "; ") + "--ignore " + name +
                               " reads the deck without it");
      return;
    }
    const bool has_effect = *effect == records::CardEffect::Stiffness || *effect == records::CardEffect::Mass ||
                            *effect == records::CardEffect::Constraint;
    if (is_ignored)
      diagnostics_.warning("deck.ignored-card", where, name + " is ignored (" + times + ")",
                           ignored_loss(name, *effect));
    else if (is_response_ && find_response_effect(name) && (find_base(name) == CardBase::None || has_base(name)))
      report_response_card(name, *find_response_effect(name), times, where);
    else if (find_base(name) == CardBase::Material && has_base(name) && selects_material_temperature())
      diagnostics_.error("deck.unsupported-card", where,
                         name +
                             " is not supported and changes materials with the temperature that TEMPERATURE of the "
                             "case control selects (" +
                             times + ")",
                         "give the material at its temperature and write TEMPERATURE(LOAD), or --ignore " + name +
                             " to compute with the material as it is");
    else if (has_effect)
      diagnostics_.error("deck.unsupported-card", where,
                         name + " is not supported and carries " + get_effect_name(*effect) + " (" + times + ")",
                         "replace it, or --ignore " + name + " to compute without it");
    else
      diagnostics_.warning(
          "deck.unused-card", where,
          name + (entry.parser == nullptr ? " is not read (" : " is not used (") + times + ")",
          find_loss(name) != nullptr ? find_loss(name) : std::string("it carries ") + get_effect_name(*effect));
  }

  bool selects_material_temperature() const {
    return std::any_of(deck_.subcases.begin(), deck_.subcases.end(),
                       [](const auto& subcase) { return subcase.commands.count("TEMPERATURE(MATERIAL)") > 0; });
  }

  std::string ignored_loss(const std::string& name, records::CardEffect effect) const {
    const auto in_response = is_response_ ? find_response_effect(name) : std::nullopt;
    if (in_response && !in_response->needs_command) return std::string("in a response it ") + in_response->what;
    return std::string("it would carry ") + get_effect_name(effect);
  }

  void report_response_card(const std::string& name, const ResponseEffect& effect, const std::string& times,
                            const SourceLocation& where) {
    if (effect.needs_command)
      diagnostics_.warning("deck.unused-card", where, name + " is not read (" + times + ")",
                           std::string("it acts where ") + effect.what + " selects it, which is an error");
    else
      diagnostics_.error("deck.unsupported-card", where,
                         name + " is not supported and " + effect.what + " (" + times + ")",
                         "take it out, or --ignore " + name + effect.without);
  }

  const Source& source_;
  records::Deck& deck_;
  records::DynamicDeck* dynamics_;
  bool is_response_, is_complex_;
  Diagnostics& diagnostics_;
  CardImages images_;
  Reading reading_;
  Replicator replicator_;
  std::unordered_set<std::string> ignored_;
  std::set<std::pair<std::string, int>> unread_sets_;
  std::map<std::string, std::vector<int>> bases_;  ///< ids that cards such as MATT1 extend, by card
  std::unordered_map<std::string, NameEntry> names_;
  std::unordered_map<std::string, int> defaults_seen_;  ///< card index
  Design design_;
  Leftovers leftovers_;
  SplitLine split_;
  CardText text_, relative_;
  NameEntry* last_entry_ = nullptr;
  std::string last_name_;
  bool last_is_plain_ = false;
  int last_card_ = -1;
  int num_unreadable_ = 0;
  int num_unknown_ = 0;   ///< names that are those of no card
  long num_repeats_ = 0;  ///< cards made by repeat lines
  bool stopped_ = false;
};

}  // namespace

void read_bulk(const Source& source, std::size_t first_line, const ReadOptions& options, records::Deck& deck,
               Diagnostics& diagnostics, records::DynamicDeck* dynamics) {
  Builder(source, first_line, options, deck, diagnostics, dynamics).read();
}

}  // namespace bough::nastran::detail
