#include "formats/nastran/detail/control_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "formats/nastran/detail/card_text.hpp"
#include "formats/nastran/detail/matrix_selection.hpp"

namespace bough::nastran::detail {
namespace {

using records::CaseSet;
using records::DynamicSelection;
using records::Subcase;

/// "a, b, c" on lines of at most 72 columns; a line that ends with a comma continues.
std::string join_lines(const std::string& head, const std::vector<std::string>& items) {
  constexpr std::size_t kColumns = 72;
  std::string text = head;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string item = items[i] + (i + 1 < items.size() ? "," : "");
    if (i > 0 && text.size() - begin + item.size() + 1 > kColumns) {
      text += "\n  ";
      begin = text.size() - 2;
    } else if (i > 0) {
      text += " ";
    }
    text += item;
  }
  return text + "\n";
}

std::vector<std::string> list_matrices(const std::vector<std::pair<double, std::string>>& matrices) {
  std::vector<std::string> items;
  for (const auto& [factor, name] : matrices)
    items.push_back((factor == 1 ? "1." : format_exact_real(factor)) + "*" + name);
  return items;
}

/// An integer as such: ids of points and elements; else a frequency.
std::string format_member(double value) {
  constexpr double kMaxId = 1e9;
  return value == std::floor(value) && std::abs(value) < kMaxId ? std::to_string(static_cast<int>(value))
                                                                : format_exact_real(value);
}

std::string write_set(int id, const CaseSet& set) {
  std::vector<std::string> items;
  if (set.is_all) items.emplace_back("ALL");
  bool in_except = false;
  for (const auto& range : set.ranges) {
    const auto text = format_member(range.first) +
                      (range.last > range.first ? " THRU " + std::to_string(static_cast<int>(range.last)) : "");
    if (range.is_excluded && !in_except && !items.empty())
      items.back() += " EXCEPT " + text;
    else
      items.push_back(text);
    in_except = range.is_excluded;
  }
  return join_lines("SET " + std::to_string(id) + " = ", items);
}

bool are_equal(const CaseSet& a, const CaseSet& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.first == y.first && x.last == y.last && x.is_excluded == y.is_excluded;
  };
  return a.is_all == b.is_all && std::equal(a.ranges.begin(), a.ranges.end(), b.ranges.begin(), b.ranges.end(), same);
}

void add_command(const char* word, const std::string& value, std::string& out) {
  if (!value.empty()) out += std::string(word) + " = " + value + "\n";
}
void add_command(const char* word, int set, std::string& out) {
  if (set != 0) add_command(word, std::to_string(set), out);
}
void add_command(const char* word, const std::vector<std::pair<double, std::string>>& matrices, std::string& out) {
  if (!matrices.empty()) out += join_lines(std::string(word) + " = ", list_matrices(matrices));
}

void write_titles(const Subcase& subcase, std::string& out) {
  add_command("TITLE", subcase.title, out);
  add_command("SUBTITLE", subcase.subtitle, out);
  add_command("LABEL", subcase.label, out);
}

void write_sets(const Subcase& subcase, std::string& out) {
  const std::pair<const char*, int> sets[] = {{"SPC", subcase.spc},
                                              {"MPC", subcase.mpc},
                                              {"LOAD", subcase.load},
                                              {"TEMPERATURE(LOAD)", subcase.temperature},
                                              {"TEMPERATURE(INITIAL)", subcase.initial_temperature},
                                              {"TEMPERATURE(MATERIAL)", subcase.material_temperature},
                                              {"METHOD", subcase.method},
                                              {"STATSUB", subcase.statsub},
                                              {"STATSUB(PRELOAD)", subcase.preload},
                                              {"SUPORT1", subcase.suport1},
                                              {"NSM", subcase.nsm}};
  for (const auto& [word, set] : sets) add_command(word, set, out);
  add_command("K2GG", subcase.k2gg, out);
  add_command("M2GG", subcase.m2gg, out);
  add_command("B2GG", subcase.b2gg, out);
}

void write_dynamic_selection(const DynamicSelection& selection, std::string& out) {
  add_command("DLOAD", selection.dload, out);
  add_command("LOADSET", selection.loadset, out);
  add_command("FREQUENCY", selection.frequency, out);
  add_command(selection.tstep < 0 ? "TSTEPNL" : "TSTEP", std::abs(selection.tstep), out);
  add_command("IC", selection.ic, out);
  add_command("SDAMPING", selection.sdamping, out);
  add_command("CMETHOD", selection.cmethod, out);
  add_command("TFL", selection.tfl, out);
  add_command("OFREQ", selection.ofreq, out);
  add_command("RANDOM", selection.random, out);
  add_command("RCROSS", selection.rcross, out);
  add_command("RGYRO", selection.rgyro, out);
  add_command("RMETHOD", selection.rmethod, out);
  add_command("MODSEL", selection.modsel, out);
  for (const auto& input : direct_inputs) add_command(input.name, selection.*input.list, out);
  if (selection.resvec) add_command("RESVEC", *selection.resvec ? "YES" : "NO", out);
  if (selection.effective_mass_grid)
    add_command(("MEFFMASS(GRID=" + std::to_string(*selection.effective_mass_grid) + ")").c_str(), "YES", out);
}

/// The sets that all subcases and combinations have with the same members.
std::map<int, CaseSet> find_common_sets(const WholeDeck& deck) {
  std::vector<const DynamicSelection*> all;
  for (const auto& subcase : deck.subcases)
    if (const auto found = deck.selections.find(subcase.id); found != deck.selections.end())
      all.push_back(&found->second);
  for (const auto& combination : deck.combinations) all.push_back(&combination.selection);
  std::map<int, CaseSet> common;
  if (all.size() < 2) return common;
  for (const auto& [id, set] : all.front()->sets) {
    const bool is_common = std::all_of(all.begin(), all.end(), [&, &id = id, &set = set](const auto* selection) {
      const auto found = selection->sets.find(id);
      return found != selection->sets.end() && are_equal(found->second, set);
    });
    if (is_common) common[id] = set;
  }
  return common;
}

std::string write_stress_field(const records::StressField& field) {
  std::vector<std::string> items;
  if (field.set > 0) items.push_back("SET " + std::to_string(field.set));
  if (field.system == records::StressField::System::Element) items.emplace_back("SYSTEM ELEMENT");
  if (field.system == records::StressField::System::Cord) items.push_back("SYSTEM CORD " + std::to_string(field.cid));
  if (field.is_volume) {
    if (field.has_principal != field.has_direct) items.emplace_back(field.has_direct ? "DIRECT" : "PRINCIPAL");
    return join_lines("VOLUME " + std::to_string(field.id) + " ", items);
  }
  std::string fibres;
  for (const auto& fibre : field.fibres) fibres += " " + fibre;
  items.push_back("FIBRE" + fibres);
  items.push_back("AXIS X" + std::to_string(field.axis));
  items.push_back(std::string("NORMAL ") + (field.is_reversed ? "M" : "") + field.normal);
  items.emplace_back(field.is_geometric ? "GEOMETRIC" : "TOPOLOGICAL");
  items.push_back("TOLERANCE " + format_exact_real(field.tolerance));
  items.emplace_back(field.has_break ? "BRANCH BREAK" : "BRANCH NOBREAK");
  return join_lines("SURFACE " + std::to_string(field.id) + " ", items);
}

class ControlWriter {
 public:
  ControlWriter(const records::Deck& deck, const WholeDeck* dynamics, std::string& out)
      : deck_(deck), dynamics_(dynamics), out_(out) {
    if (dynamics_ == nullptr) return;
    common_ = find_common_sets(*dynamics_);
    for (const auto& combination : dynamics_->combinations)
      if (combination.command == "SYMCOM")
        for (const auto& [factor, id] : combination.terms) symmetric_.insert(id);
    for (const auto& [id, selection] : dynamics_->selections)
      for (const auto& [set, members] : selection.sets) case_sets_.insert(set);
  }

  void write() {
    for (const auto& [id, set] : common_) out_ += write_set(id, set);
    find_components();
    for (const auto& subcase : deck_.subcases) {
      begin(subcase.id);
      write_titles(subcase, out_);
      write_sets(subcase, out_);
      if (dynamics_ == nullptr) continue;
      if (const auto found = dynamics_->selections.find(subcase.id); found != dynamics_->selections.end()) {
        write_own_sets(found->second);
        write_dynamic_selection(found->second, out_);
        write_requests(found->second);
      }
      before_.push_back(subcase.id);
      write_combinations(subcase.id);
    }
    for (const auto& [id, component] : components_) {
      if (written_.count(id) > 0) continue;
      begin(id);
      write_sets(component.control, out_);
    }
    if (dynamics_ != nullptr) write_post();
  }

 private:
  /// Sets that are not common.
  void write_own_sets(const DynamicSelection& selection) {
    for (const auto& [id, set] : selection.sets)
      if (common_.count(id) == 0) out_ += write_set(id, set);
  }

  void write_post() {
    const auto& post = dynamics_->post;
    if (post.post_sets.empty() && post.stress_fields.empty()) return;
    out_ += "OUTPUT(POST)\n";
    for (const auto& [id, set] : post.post_sets) out_ += write_set(id, set);
    for (const auto& field : post.stress_fields) out_ += write_stress_field(field);
  }

  void write_requests(const DynamicSelection& selection) {
    for (const auto& [command, request] : selection.outputs) {
      const auto options = dynamics_->request_options.find({request.at.file, request.at.line});
      const auto name = command + (options == dynamics_->request_options.end() ? "" : "(" + options->second + ")");
      const auto value = request.is_all ? "ALL" : request.is_none ? "NONE" : std::to_string(request.set);
      add_command(name.c_str(), value, out_);
    }
  }

  struct Component {
    Subcase control;
    std::set<int> members;  ///< superelements
  };

  /// Subcases of superelements: SPC, MPC and METHOD of the sections.
  void find_components() {
    for (const auto& section : deck_.super.sections)
      for (const auto& subcase : section.deck->subcases) {
        if (subcase.id == 0) continue;
        components_[subcase.id].control = subcase;
        components_[subcase.id].members.insert(section.id);
      }
  }

  void begin(int id) {
    if (id == 0) return;
    written_.insert(id);
    const auto component = components_.find(id);
    if (component != components_.end()) {
      const auto& members = component->second.members;
      int selected = *members.begin();
      out_ += "SUBCASE " + std::to_string(id) + "\n";
      // A number that is the id of a SET selects its members.
      if (members.size() > 1 || case_sets_.count(selected) > 0) {
        CaseSet set;
        for (const int one : members) set.ranges.push_back({static_cast<double>(one), static_cast<double>(one), false});
        selected = find_free_set();
        out_ += write_set(selected, set);
      }
      add_command("SUPER", selected, out_);
      return;
    }
    out_ += (symmetric_.count(id) > 0 ? "SYM " : "SUBCASE ") + std::to_string(id) + "\n";
  }

  /// An id that is no set and no superelement.
  int find_free_set() {
    const auto is_superelement = [&](int id) {
      return std::any_of(deck_.super.sections.begin(), deck_.super.sections.end(),
                         [id](const auto& section) { return section.id == id; });
    };
    int id = 1;
    while (case_sets_.count(id) > 0 || is_superelement(id)) ++id;
    case_sets_.insert(id);
    return id;
  }

  /// Combinations whose last subcase is this one.
  void write_combinations(int last) {
    for (const auto& combination : dynamics_->combinations) {
      if (combination.terms.empty() || combination.terms.back().second != last) continue;
      out_ += combination.command + " " + std::to_string(combination.control.id) + "\n";
      write_titles(combination.control, out_);
      if (combination.command != "REPCASE") write_factors(combination);
      write_own_sets(combination.selection);
      write_requests(combination.selection);
    }
  }

  /// Factors of the subcases from the first term on; of SYMCOM, those that are symmetric.
  void write_factors(const records::CaseCombination& combination) {
    const bool is_symmetric = combination.command == "SYMCOM";
    std::vector<std::string> factors;
    for (const int id : before_) {
      if (is_symmetric && symmetric_.count(id) == 0) continue;
      const auto term = std::find_if(combination.terms.begin(), combination.terms.end(),
                                     [id](const auto& one) { return one.second == id; });
      if (term != combination.terms.end())
        factors.push_back(format_exact_real(term->first));
      else if (!factors.empty())
        factors.emplace_back("0.");
    }
    out_ += join_lines(is_symmetric ? "SYMSEQ = " : "SUBSEQ = ", factors);
  }

  const records::Deck& deck_;
  const WholeDeck* dynamics_;
  std::string& out_;
  std::map<int, CaseSet> common_;
  std::set<int> case_sets_, symmetric_, written_;
  std::vector<int> before_;  ///< subcases so far
  std::map<int, Component> components_;
};

}  // namespace

void write_control(const records::Deck& deck, const WholeDeck* dynamics, std::string& out) {
  for (const auto& [cell, value] : deck.system_cells) out += "NASTRAN " + cell + "=" + value + "\n";
  for (const auto& [unit, file] : deck.super.input4)
    out += "ASSIGN INPUTT4='" + file.path + "',\n  UNIT=" + std::to_string(unit) + "\n";
  if (!deck.sol.empty()) out += "SOL " + deck.sol + "\n";
  out += "CEND\n";
  if (const auto& output = deck.super.output)
    out += "EXTSEOUT(ASMBULK,EXTBULK,EXTID=" + std::to_string(output->id) + ",MATOP4=" + std::to_string(output->unit) +
           ")\n";
  if (deck.autospc_command) add_command("AUTOSPC", deck.autospc_command->value, out);
  ControlWriter(deck, dynamics, out).write();
  out += "BEGIN BULK\n";
}

}  // namespace bough::nastran::detail
