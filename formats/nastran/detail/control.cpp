#include "formats/nastran/detail/control.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <unordered_set>
#include <utility>

#include "formats/nastran/detail/control_lines.hpp"
#include "formats/nastran/detail/control_words.hpp"
#include "formats/nastran/detail/dynamic_control.hpp"
#include "formats/nastran/detail/known_params.hpp"
#include "formats/nastran/detail/matrix_selection.hpp"
#include "formats/nastran/detail/post_control.hpp"
#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

using records::Subcase;

/// A command whose value is the id of a set, and nothing else.
struct PlainCommand {
  const char* word;
  int Subcase::*set;
};
constexpr PlainCommand kPlainCommands[] = {
    {"SPC", &Subcase::spc}, {"MPC", &Subcase::mpc}, {"LOAD", &Subcase::load}, {"NSM", &Subcase::nsm}};

const PlainCommand* find_plain(std::string_view word) {
  const auto* found = std::find_if(std::begin(kPlainCommands), std::end(kPlainCommands),
                                   [&](const auto& command) { return word == command.word; });
  return found == std::end(kPlainCommands) ? nullptr : found;
}

class CaseControl {
 public:
  CaseControl(const Source& source, records::Deck& deck, Diagnostics& diagnostics, const ControlOptions& options)
      : source_(source), deck_(deck), diagnostics_(diagnostics), dynamics_(options.dynamics), options_(options) {
    for (const auto& name : options.ignore_cards) asked_to_ignore_.insert(make_upper(trim(name)));
  }

  void read(std::size_t first, std::size_t last, bool with_executive) {
    for (std::size_t i = first; i < last; ++i) {
      at_ = source_.lines[i].at;
      std::string joined;
      auto command = split_command(source_.lines[i].text);
      if (command.word.empty()) report_wordless(source_.lines[i].text);
      // A list such as SET goes on while lines end with a comma; a title may end with one.
      if (!is_title(command.word) && source_.lines[i].text.back() == ',') {
        joined = source_.lines[i].text;
        while (i + 1 < last && joined.back() == ',') joined += source_.lines[++i].text;
        command = split_command(joined);
      }
      read_command(command, with_executive);
    }
    finish();
  }

 private:
  static bool is_title(std::string_view word) {
    return is_command(word, "TITLE", 4) || is_command(word, "SUBTITLE", 4) || is_command(word, "LABEL", 4);
  }

  Subcase& current() {
    if (in_combination_) return combinations().back().control;
    return in_subcase_ ? deck_.subcases.back() : above_;
  }
  records::DynamicSelection& current_selection() {
    if (in_combination_) return combinations().back().selection;
    return in_subcase_ ? dynamics_->selections[deck_.subcases.back().id] : selection_above_;
  }

  void read_command(const Command& c, bool with_executive) {
    if (c.word.empty() || is_switched_off(c)) return;
    if (is_command(c.word, "OUTPUT", 4)) {
      in_plot_section_ = !c.options.empty();
      in_post_section_ = c.options.starts_with("POST");
      return;
    }
    if (is_command(c.word, "SUBCASE", 4) || c.word == "SYM") {  // SYM: a subcase of a part with a symmetry
      begin_subcase(c);
      return;
    }
    const bool is_stress_request = is_command(c.word, "GPSTRESS", 4) || is_command(c.word, "STRFIELD", 4);
    if (in_post_section_ && options_.post && !is_stress_request)
      read_post_command({c.word, c.options, c.value}, at_, deck_.locate(at_), *options_.post,
                        *options_.post_diagnostics);
    if (in_plot_section_ && !(in_post_section_ && is_stress_request)) return report_misplaced(c.word);
    if (c.word == "SUBCOM" || c.word == "SYMCOM" || c.word == "REPCASE") {
      // Combinations of results: what follows belongs to them, not to the subcase before.
      if (options_.combinations) return begin_combination(c);
      skipping_ = true;
      if (options_.notes_combinations) note(c.word);
      return;
    }
    if (skipping_) return;
    if (in_combination_ && (c.word == "SUBSEQ" || c.word == "SYMSEQ")) return read_sequence(c);
    if (is_command(c.word, "TITLE", 4))
      current().title = c.value;
    else if (is_command(c.word, "SUBTITLE", 4))
      current().subtitle = c.value;
    else if (is_command(c.word, "LABEL", 4))
      current().label = c.value;
    else if (const auto* plain = find_plain(c.word))
      read_set(c, plain->word, current().*plain->set);
    else if (is_command(c.word, "TEMPERATURE", 4))
      read_temperature(c);
    else if (is_command(c.word, "METHOD", 4)) {
      const auto kind = read_option(c, {"STRUCTURE", "FLUID", "BOTH", "COUPLED"});
      if (kind && *kind != "FLUID") read_set(c, "METHOD", current().method);
    } else if (is_command(c.word, "STATSUB", 4)) {
      read_statsub(c);
    } else if (is_command(c.word, "SUPORT1", 4))
      read_set(c, "SUPORT1", current().suport1);
    else if (c.word == "K2GG")
      read_matrices(c, "K2GG", current().k2gg);
    else if (c.word == "M2GG")
      read_matrices(c, "M2GG", current().m2gg);
    else if (c.word == "B2GG")
      read_matrices(c, "B2GG", current().b2gg);
    else if (c.word == "P2G")
      read_load_columns(c);
    else if (is_command(c.word, "AUTOSPC", 4))
      read_autospc(c);
    else if (is_command(c.word, "EXTSEOUT", 6))
      read_external_output(c);
    else if (c.word == "SUPER" && !options_.superelements.empty())
      read_superelement(c);
    else if (c.word == "SET")
      read_named_set(c);
    else if (c.word == "PARAM")
      read_param(c);
    else if (is_command(c.word, "ANALYSIS", 4) && make_upper(c.value).starts_with("HEAT"))
      refuse({"ANALYSIS", "HEAT", "heat transfer, whose unknowns are temperatures"});
    else if (with_executive && is_command(c.word, "SOL", 3))
      deck_.sol = make_upper(c.value.substr(0, c.value.find_first_of(" ,\t")));
    else
      read_dynamic(c);
  }

  void read_dynamic(const Command& c) {
    if (!is_response()) keep_response_matrices(c);
    if ((is_response() || options_.is_complex) && read_direct_input(c)) return;
    if (options_.is_complex && is_command(c.word, "CMETHOD", 4))
      return read_set(c, "CMETHOD", current_selection().cmethod);
    if ((is_response() || options_.is_complex) && c.word == "MODSEL")
      return read_set(c, "MODSEL", current_selection().modsel);
    if (options_.is_complex && c.word == "TFL") return read_set(c, "TFL", current_selection().tfl);
    if ((is_response() || options_.is_complex) && read_rotor_selection(c)) return;
    if (const auto* acts = find_unsupported_command(c.word)) {
      if (acts->scope == CommandScope::StaticLoad) return read_unread_load(c, *acts);
      if (acts->scope == CommandScope::Model || is_response() || is_modal_complex(*acts)) return refuse(*acts);
      return note(c.word);
    }
    const bool is_random = is_command(c.word, "RANDOM", 4) || is_command(c.word, "RCROSS", 4);
    if (is_random && !is_response() && !options_.is_whole) return note(c.word);
    if (is_command(c.word, "RANDOM", 4) &&
        (asked_to_ignore_.count("RANDOM") > 0 || asked_to_ignore_.count("RANDPS") > 0))
      return diagnostics_.warning("deck.unsupported-command", deck_.locate(at_), "RANDOM selects the random response",
                                  "ignored as asked");
    const auto read = dynamics_
                          ? read_dynamic_command({c.word, c.options, c.value, at_}, current(), current_selection())
                          : DynamicCommand::Other;
    if (read == DynamicCommand::BadValue) return bad_value(c);
    if (read == DynamicCommand::Read && options_.request_options && !c.options.empty())
      (*options_.request_options)[{at_.file, at_.line}] = c.options;
    if (read == DynamicCommand::Other && is_response() && c.word == "IC")
      return refuse({"IC", "TIC", "a start other than by TIC cards"});
    if (read == DynamicCommand::Other && !is_plain_command(c.word)) report_unused(c.word);
  }

  void keep_response_matrices(const Command& c) {
    MatrixList names;
    if (std::none_of(direct_inputs.begin(), direct_inputs.end(), [&](const auto& d) { return c.word == d.name; }))
      return;
    if (!read_matrix_names(c.value, names)) return;
    for (const auto& [factor, name] : names) deck_.response_matrices.insert(name);
  }

  /// K2PP, M2PP, B2PP.
  bool read_direct_input(const Command& c) {
    for (const auto& input : direct_inputs) {
      if (c.word != input.name) continue;
      read_matrices(c, input.name, current_selection().*input.list);
      return true;
    }
    return false;
  }

  /// RGYRO = n or NO; RMETHOD = n of complex modes.
  bool read_rotor_selection(const Command& c) {
    const bool is_rgyro = is_command(c.word, "RGYRO", 4);
    if (!is_rgyro && !(options_.is_complex && is_command(c.word, "RMETHOD", 4))) return false;
    const char* name = is_rgyro ? "RGYRO" : "RMETHOD";
    auto& set = is_rgyro ? current_selection().rgyro : current_selection().rmethod;
    if (asked_to_ignore_.count(name) > 0)
      diagnostics_.warning("deck.unsupported-command", deck_.locate(at_),
                           std::string(name) + " selects rotors: gyroscopic terms", "ignored as asked");
    else if (make_upper(c.value) == "NO")
      set = 0;
    else
      read_set(c, name, set);
    return true;
  }

  bool is_response() const { return dynamics_ && options_.is_response; }

  /// Returns true for a selection of modes in complex modes by the modal method.
  bool is_modal_complex(const UnsupportedCommand& command) const {
    static const std::set<std::string> modal{"110", "29", "SEMCEIG", "MCEIG"};
    return options_.is_complex && !options_.is_whole && modal.count(deck_.sol) > 0 &&
           std::string_view(command.name).starts_with("MOD");
  }

  /// SKIPON, SKIPOFF, SKIP ON, SKIP OFF: the commands between them are not part of the case control.
  bool is_switched_off(const Command& c) {
    const bool is_switch = c.word == "SKIPON" || c.word == "SKIPOFF" || c.word == "SKIP";
    const auto value = c.word == "SKIP" ? make_upper(c.value) : c.word.substr(std::min<std::size_t>(4, c.word.size()));
    if (is_switch && (value == "ON" || value == "OFF")) {
      is_off_ = value == "ON";
      return true;
    }
    return is_off_;
  }

  void report_wordless(std::string_view text) {
    diagnostics_.warning("deck.unknown-case-control", deck_.locate(at_),
                         "'" + std::string(trim(text)) + "' begins with no command; it is not used",
                         "remove the line, or end the line before it with a comma to continue it");
  }

  /// Commands that select the model, its loads or its solution in a section of plots, where Nastran has none of them.
  void report_misplaced(const std::string& word) {
    static const std::set<std::string, std::less<>> selects{
        "SPC",  "MPC",   "LOAD",    "METHOD", "METH",     "CMETHOD", "TEMPERATURE", "TEMP",    "DLOAD",  "FREQUENCY",
        "FREQ", "TSTEP", "NSM",     "IC",     "SDAMPING", "SDAM",    "STATSUB",     "SUPORT1", "PARAM",  "K2GG",
        "M2GG", "B2GG",  "LOADSET", "K2PP",   "M2PP",     "B2PP",    "TFL",         "RANDOM",  "AUTOSPC"};
    if (selects.count(word) == 0) return;
    diagnostics_.error("deck.case-control-value", deck_.locate(at_),
                       word + " is in the section of plots that OUTPUT begins, where it selects nothing",
                       "move it before OUTPUT");
  }

  /// Reports a command that changes the results and is not supported.
  void refuse(const UnsupportedCommand& command) {
    const std::string what = std::string(command.name) + " is not supported: it selects " + command.what;
    if (asked_to_ignore_.count(command.name) > 0 || asked_to_ignore_.count(command.card) > 0)
      diagnostics_.warning("deck.unsupported-command", deck_.locate(at_), what, "ignored as asked");
    else
      diagnostics_.error("deck.unsupported-command", deck_.locate(at_), what,
                         std::string("take it out, or --ignore ") + command.name + " to compute without it");
  }

  void report_unused(const std::string& word) {
    const auto nearest = find_nearest_command(word);
    if (nearest.empty()) return note(word);
    diagnostics_.warning("deck.unknown-case-control", deck_.locate(at_),
                         word + " is no command of the case control that Nastran knows; it is not used",
                         "did you mean " + nearest);
  }

  /// The subcase whose load a buckling subcase scales; in modes of any kind, and as (PRELOAD), the one that preloads
  /// the structure.
  void read_statsub(const Command& c) {
    static const std::set<std::string> without{"",        "101", "1", "24",      "SESTATIC", "SESTATICS",
                                               "STATICS", "105", "5", "SEBUCKL", "BUCKLING"};
    const auto kind = read_option(c, {"BUCKLING", "PRELOAD"});
    if (!kind) return;
    const bool is_named = *kind == "PRELOAD";
    if (!is_named) read_set(c, "STATSUB", current().statsub);
    if (!is_named && without.count(deck_.sol) > 0) return;
    read_set(c, "PRELOAD", current().preload);
    current().preload_at = at_;
  }

  /// The one of `names` that the word in brackets, which may be cut short, stands for; empty without brackets. Nothing,
  /// and an error, where it is none of them: a slip would choose another meaning of the command.
  std::optional<std::string> read_option(const Command& c, const std::vector<std::string>& names) {
    if (c.options.empty()) return std::string();
    for (const auto& name : names)
      if (is_command(c.options, name, 1)) return name;
    std::string all;
    for (const auto& name : names) all += (all.empty() ? "" : ", ") + name;
    const auto nearest = find_nearest(c.options, names);
    diagnostics_.error("deck.case-control-value", deck_.locate(at_),
                       c.word + "(" + c.options + "): expected one of " + all,
                       nearest.empty() ? "write one of them, or leave the brackets out" : "did you mean " + nearest);
    return {};
  }

  std::vector<records::CaseCombination>& combinations() { return *options_.combinations; }
  void fail_combination(const std::string& what, const std::string& advice) {
    options_.combination_diagnostics->error("deck.combination", deck_.locate(at_), what, advice);
  }

  /// SUBCOM n, SYMCOM n, REPCASE n: the commands that follow belong to them.
  void begin_combination(const Command& c) {
    end_combination();
    in_plot_section_ = in_post_section_ = skipping_ = false;
    const auto id = parse_int(c.value.substr(0, c.value.find_first_of(" ,\t")));
    records::CaseCombination combination;
    combination.control = above_;
    combination.selection = selection_above_;
    combination.control.id = id.value_or(0);
    combination.command = c.word;
    combination.at = at_;
    if (!id || *id <= 0 || !subcase_ids_.insert(*id).second)
      fail_combination(c.word + " is '" + std::string(c.value) + "', expected a number that no subcase has",
                       "number the subcases differently");
    if (c.word == "REPCASE") {
      if (real_ids_.empty())
        fail_combination("REPCASE has no subcase before it", "write it after the subcase that it repeats");
      else
        combination.terms = {{1.0, real_ids_.back()}};
    } else if (c.word == "SYMCOM") {
      for (const int of : sym_ids_) combination.terms.emplace_back(1.0, of);
      is_symcom_over_ = true;  // the next SYM begins another structure
    }
    combinations().push_back(std::move(combination));
    in_combination_ = true;
  }

  /// Factors of the subcases (SYM of SYMCOM) before, the last one of the last.
  void read_sequence(const Command& c) {
    auto& combination = combinations().back();
    const auto& of = combination.command == "SYMCOM" ? sym_ids_ : real_ids_;
    std::vector<double> factors;
    for (std::string_view rest = c.value; !trim(rest).empty();) {
      const auto comma = std::min(rest.find(','), rest.size());
      const auto factor = parse_real(trim(rest.substr(0, comma)));
      if (!factor)
        return fail_combination(c.word + " has '" + std::string(rest) + "', expected numbers", "write 1.0, -1.0");
      factors.push_back(*factor);
      rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    if (factors.empty() || factors.size() > of.size())
      return fail_combination(c.word + " has " + std::to_string(factors.size()) + " factors, " +
                                  std::to_string(of.size()) + " subcases precede it",
                              "give a factor for each of the last subcases");
    combination.terms.clear();
    for (std::size_t i = 0; i < factors.size(); ++i)
      combination.terms.emplace_back(factors[i], of[of.size() - factors.size() + i]);
  }

  void end_combination() {
    if (in_combination_ && combinations().back().terms.empty() && options_.combination_diagnostics->num_errors() == 0) {
      const auto here = std::exchange(at_, combinations().back().at);
      fail_combination(combinations().back().command + " has no factors", combinations().back().command == "SYMCOM"
                                                                              ? "write it behind SYM subcases"
                                                                              : "write SUBSEQ = 1.0, 1.0");
      at_ = here;
    }
    in_combination_ = false;
  }

  void begin_subcase(const Command& c) {
    end_combination();
    in_plot_section_ = in_post_section_ = skipping_ = false;
    const auto id = parse_int(c.value.substr(0, c.value.find_first_of(" ,\t")));
    if (!id || *id <= 0) {
      bad_value(c);
      return;
    }
    if (!subcase_ids_.insert(*id).second)
      diagnostics_.error("deck.case-control-value", deck_.locate(at_),
                         "subcase " + std::to_string(*id) + " is defined twice", "number the subcases differently");
    deck_.subcases.push_back(above_);
    deck_.subcases.back().id = *id;
    in_subcase_ = true;
    real_ids_.push_back(*id);
    if (c.word == "SYM") {
      if (is_symcom_over_) sym_ids_.clear();
      is_symcom_over_ = false;
      sym_ids_.push_back(*id);
    }
    if (dynamics_) dynamics_->selections[*id] = selection_above_;
    load_matrices_[*id] = load_matrices_above_;
  }

  void read_set(const Command& c, const char* name, int& set) {
    const auto id = parse_int(c.value);
    current().commands[name] = at_;
    if (id && *id >= 0)
      set = *id;
    else
      bad_value(c);
  }

  /// (LOAD) or nothing, which is (BOTH): a load. (INITIAL): where materials without TREF expand from. (MATERIAL) is for
  /// materials that change with it.
  void read_temperature(const Command& c) {
    const auto kind = read_option(c, {"BOTH", "LOAD", "INITIAL", "MATERIAL"});
    if (!kind) return;
    if (kind->empty() || *kind == "LOAD" || *kind == "BOTH") read_set(c, "TEMPERATURE", current().temperature);
    if (*kind == "INITIAL") read_set(c, "TEMPERATURE(INITIAL)", current().initial_temperature);
    if (*kind == "LOAD" || *kind == "INITIAL") return;
    int material = current().temperature;  // materials depend on the temperature where MATT1 and its kin are
    if (*kind == "MATERIAL") read_set(c, "TEMPERATURE(MATERIAL)", material);
    current().commands["TEMPERATURE(MATERIAL)"] = at_;
    current().material_temperature = material;
    if (material == 0) current().commands.erase("TEMPERATURE(MATERIAL)");
  }

  /// Loads that are not read: a static solution of the case is refused, unless asked otherwise. Subcase::deform is the
  /// set of such a command, `commands` says of which.
  void read_unread_load(const Command& c, const UnsupportedCommand& command) {
    const bool is_ignored = asked_to_ignore_.count(command.name) > 0 || asked_to_ignore_.count(command.card) > 0;
    if (!is_ignored) read_set(c, command.name, current().deform);
    diagnostics_.warning("deck.unused-load", deck_.locate(at_),
                         std::string(command.name) + " selects a load that is not read: " + command.what,
                         is_ignored ? "ignored as asked" : "give it by other cards, or leave it out");
  }

  /// P2G: as K2GG, of each subcase.
  void read_load_columns(const Command& c) {
    if (is_response()) return refuse({"P2G", "DMIG", "static loads given as a matrix"});
    MatrixList names;
    read_matrices(c, "P2G", names);
    (in_subcase_ ? load_matrices_[current().id] : load_matrices_above_) = std::move(names);
  }

  /// AUTOSPC(EPS=r, ...) = YES, NO; YES without a value. The command stands above PARAM,AUTOSPC.
  void read_autospc(const Command& c) {
    const auto value = c.value.empty() ? std::string("YES") : make_upper(c.value);
    if (value != "YES" && value != "NO") return bad_value(c, "YES or NO");
    deck_.autospc_command = {"AUTOSPC", value, at_};
    const auto options = make_upper(c.options);
    const auto eps = options.find("EPS=");
    if (eps != std::string::npos && (eps == 0 || options[eps - 1] == ',' || options[eps - 1] == ' '))
      deck_.params.push_back({"EPZERO", options.substr(eps + 4, options.find(',', eps) - eps - 4), at_});
  }

  /// Names of DMIG with or without factors: "K1, K2", "1.25*K1, 0.82*K2", or the id of a SET of such a list.
  void read_matrices(const Command& c, const char* name, MatrixList& matrices) {
    matrices.clear();
    current().commands[name] = at_;
    if (const auto set = parse_int(c.value); set && *set > 0) {
      matrices.emplace_back(1.0, std::string(c.value));  // replaced when all sets are known
      return;
    }
    if (!read_matrix_names(c.value, matrices))
      bad_value(c, "the name of a DMIG, or FACTOR*NAME, and more between commas");
  }

  /// Names of matrices; ids and numbers of output requests.
  void read_named_set(const Command& c) {
    const auto equals = c.value.find('=');
    const auto id = parse_int(trim(c.value.substr(0, equals)));
    if (id && equals != std::string_view::npos)
      if (auto set = read_case_set(c.value.substr(equals + 1))) {
        case_sets_[*id] = *set;
        if (dynamics_) current_selection().sets[*id] = std::move(*set);
      }
    MatrixList names;
    if (id && equals != std::string_view::npos && read_matrix_names(trim(c.value.substr(equals + 1)), names))
      sets_[std::to_string(*id)] = std::move(names);
  }

  void read_param(const Command& c) {
    // PARAM,NAME,VALUE; blanks, tabs and an equals sign separate too.
    constexpr std::string_view separators = ", \t=";
    auto rest = c.value;
    if (!rest.empty() && rest.front() == ',') rest = trim(rest.substr(1));
    const auto end = rest.find_first_of(separators);
    const auto name = rest.substr(0, end);
    if (end == std::string_view::npos || name.empty()) return bad_value(c, "a name and a value");
    rest = trim(rest.substr(end));
    if (rest.front() == ',' || rest.front() == '=') rest = trim(rest.substr(1));
    records::Param param{make_upper(name), make_upper(rest.substr(0, rest.find_first_of(separators))), at_};
    if (in_subcase_) {
      const auto first = subcase_params_.emplace(param.name, param.value).first;
      if (first->second != param.value && is_used_param(param.name, is_response()))
        diagnostics_.warning("deck.subcase-param", deck_.locate(at_),
                             "PARAM," + param.name + " is " + param.value + " in subcase " +
                                 std::to_string(current().id) + " and " + first->second +
                                 " in one before; this last value holds in all subcases",
                             "solve the subcases with another value in another deck");
    }
    deck_.params.push_back(std::move(param));
  }

  /// EXTSEOUT(ASMBULK,EXTBULK,EXTID=n,MATOP4=unit)
  void read_external_output(const Command& c) {
    const auto find_value = [&](const std::string& key) {
      const auto at = c.options.find(key + "=");
      if (at == std::string::npos) return 0;
      const auto value = std::string_view(c.options).substr(at + key.size() + 1);
      return parse_int(trim(value.substr(0, value.find(',')))).value_or(0);
    };
    deck_.super.output = {find_value("EXTID"), find_value("MATOP4"), at_};
    note("EXTSEOUT");
  }

  /// Subcases of SUPER = n are of the component alone, which is reduced already. A SET n names several.
  void read_superelement(const Command& c) {
    const auto id = parse_int(c.value.substr(0, c.value.find_first_of(" ,\t")));
    if (!in_subcase_ || !id) return;
    const auto set = case_sets_.find(*id);
    if (set != case_sets_.end() && set->second.contains(0)) return;  // the residual structure
    std::set<int> members;
    for (const int one : options_.superelements)
      if (set == case_sets_.end() ? one == *id : set->second.contains(one)) members.insert(one);
    if (!members.empty()) component_cases_[current().id] = {std::move(members), at_};
  }

  /// Hands SPC, MPC and METHOD of the subcases of each superelement to its section.
  void keep_component_cases() {
    if (!options_.component_cases) return;
    for (const auto& subcase : deck_.subcases) {
      const auto found = component_cases_.find(subcase.id);
      if (found == component_cases_.end()) continue;
      Subcase own;
      own.id = subcase.id;
      own.spc = subcase.spc;
      own.mpc = subcase.mpc;
      own.method = subcase.method;
      own.commands = subcase.commands;
      for (const int id : found->second.members) (*options_.component_cases)[id].push_back(own);
    }
  }

  /// Loads that subcases of superelements alone select, and no subcase of the model.
  void report_component_loads() {
    for (const auto& [name, set] : {std::pair{"LOAD", &Subcase::load}, std::pair{"TEMPERATURE", &Subcase::temperature}})
      for (const auto& subcase : deck_.subcases) {
        const auto found = component_cases_.find(subcase.id);
        if (found == component_cases_.end() || subcase.*set == 0) continue;
        const bool is_selected =
            std::any_of(deck_.subcases.begin(), deck_.subcases.end(), [&, &set = set](const auto& other) {
              return component_cases_.count(other.id) == 0 && other.*set == subcase.*set;
            });
        if (!is_selected)
          diagnostics_.warning("deck.superelement-case", deck_.locate(found->second.at),
                               std::string(name) + " = " + std::to_string(subcase.*set) + " of subcase " +
                                   std::to_string(subcase.id) +
                                   " of superelements alone is selected by no subcase of the model: it is not applied",
                               std::string("write ") + name + " in a subcase of the model, for all superelements");
      }
  }

  void drop_component_cases() {
    if (component_cases_.empty() || component_cases_.size() == deck_.subcases.size()) return;
    report_component_loads();
    std::string ids;
    for (const auto& [id, component_case] : component_cases_) {
      ids += (ids.empty() ? "" : ", ") + std::to_string(id);
      std::erase_if(deck_.subcases, [&, &n = id](const auto& subcase) { return subcase.id == n; });
      load_matrices_.erase(id);
      if (dynamics_) dynamics_->selections.erase(id);
    }
    diagnostics_.note("deck.superelement-case", deck_.locate(component_cases_.begin()->second.at),
                      "subcases of superelements alone are not solved: " + ids,
                      "SPC, MPC and METHOD in them are used, output requests are not");
  }

  void bad_value(const Command& c, const char* expected = "the number of a set") {
    diagnostics_.error("deck.case-control-value", deck_.locate(at_),
                       c.word + " selects '" + std::string(c.value) + "', expected " + expected,
                       "write " + c.word +
                           (c.word == "PARAM"                                     ? ", NAME, VALUE"
                            : std::string_view(expected) == "the number of a set" ? " = n"
                                                                                  : " = NAME"));
  }

  void note(const std::string& word) { ignored_.add(word, at_); }

  void finish() {
    end_combination();
    if (deck_.subcases.empty()) deck_.subcases.push_back(above_);
    keep_component_cases();
    drop_component_cases();
    if (!in_subcase_) load_matrices_[0] = load_matrices_above_;
    if (dynamics_ && !in_subcase_) dynamics_->selections[0] = selection_above_;
    choose_matrices(deck_, sets_, at_, diagnostics_);
    if (options_.load_columns)
      *options_.load_columns = choose_load_columns(deck_, load_matrices_, sets_, at_, diagnostics_);
    if (is_response() || options_.is_complex)
      add_direct_input(*dynamics_, sets_, at_, diagnostics_, !options_.is_complex);
    ignored_.report(deck_, diagnostics_);
  }

  const Source& source_;
  records::Deck& deck_;
  Diagnostics& diagnostics_;
  records::DynamicDeck* dynamics_;
  ControlOptions options_;
  Subcase above_;
  records::DynamicSelection selection_above_;
  bool in_subcase_ = false, in_plot_section_ = false, in_post_section_ = false, skipping_ = false,
       in_combination_ = false;
  std::vector<int> real_ids_, sym_ids_;
  bool is_symcom_over_ = false;
  records::CardLocation at_;
  IgnoredCommands ignored_;
  std::unordered_set<int> subcase_ids_;
  std::unordered_set<std::string> asked_to_ignore_;
  NamedSets sets_;
  MatrixList load_matrices_above_;           ///< P2G
  std::map<int, MatrixList> load_matrices_;  ///< by subcase
  struct ComponentCase {
    std::set<int> members;  ///< superelements
    records::CardLocation at;
  };
  std::map<int, ComponentCase> component_cases_;  ///< by subcase
  std::map<int, records::CaseSet> case_sets_;     ///< SET of numbers
  std::map<std::string, std::string> subcase_params_;
  bool is_off_ = false;  ///< after SKIPON
};

}  // namespace

std::size_t read_control(const Source& source, records::Deck& deck, Diagnostics& diagnostics,
                         const ControlOptions& options) {
  const auto [cend, begin_bulk] = find_sections(source);
  auto begin = begin_bulk;
  constexpr auto none = Sections::none;
  if (begin == none && cend == none) {
    deck.subcases.emplace_back();
    return 0;
  }
  if (begin == none) {
    diagnostics.error("deck.no-begin-bulk", deck.locate(source.lines[cend].at), "CEND is not followed by BEGIN BULK",
                      "write BEGIN BULK before the bulk data");
    begin = source.lines.size();
    read_executive(source, cend, deck, diagnostics);
    CaseControl(source, deck, diagnostics, options).read(cend + 1, begin, false);
    return begin;
  }
  if (cend != none) read_executive(source, cend, deck, diagnostics);
  CaseControl(source, deck, diagnostics, options).read(cend == none ? 0 : cend + 1, begin, cend == none);
  return begin + 1;
}

}  // namespace bough::nastran::detail
