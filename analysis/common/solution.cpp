#include "analysis/common/solution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace bough::analysis {

namespace {

struct OtherSolution {
  const char* name;
  bool has_nonlinear_statics;
  bool has_complex_modes = false;
};

/// Solutions whose answer is not that of the linear cards, by number and by name of the MSC and NX sequences; 4 and 13
/// are the differential stiffness of COSMIC, 6 its piecewise linear statics.
const OtherSolution* find_other_solution(const std::string& sol) {
  static const std::map<std::string, OtherSolution> all{{"4", {"statics with differential stiffness", true}},
                                                        {"6", {"piecewise linear statics", true}},
                                                        {"13", {"modes with differential stiffness", false}},
                                                        {"66", {"nonlinear statics", true}},
                                                        {"64", {"nonlinear statics", true}},
                                                        {"99", {"nonlinear transient response", true}},
                                                        {"106", {"nonlinear statics", true}},
                                                        {"NLSTATIC", {"nonlinear statics", true}},
                                                        {"129", {"nonlinear transient response", true}},
                                                        {"NLTRAN", {"nonlinear transient response", true}},
                                                        {"144", {"static aeroelasticity", false}},
                                                        {"SAESTAT", {"static aeroelasticity", false}},
                                                        {"AESTAT", {"static aeroelasticity", false}},
                                                        {"145", {"flutter", false}},
                                                        {"SEFLUTTR", {"flutter", false}},
                                                        {"FLUTTR", {"flutter", false}},
                                                        {"146", {"aeroelastic response", false}},
                                                        {"SEAERO", {"aeroelastic response", false}},
                                                        {"AERO", {"aeroelastic response", false}},
                                                        {"28", {"complex eigenvalues", false, true}},
                                                        {"29", {"complex eigenvalues", false, true}},
                                                        {"107", {"complex eigenvalues", false, true}},
                                                        {"SEDCEIG", {"complex eigenvalues", false, true}},
                                                        {"DCEIG", {"complex eigenvalues", false, true}},
                                                        {"110", {"complex eigenvalues by modes", false, true}},
                                                        {"SEMCEIG", {"complex eigenvalues by modes", false, true}},
                                                        {"MCEIG", {"complex eigenvalues by modes", false, true}},
                                                        {"153", {"static heat transfer with structure", true}},
                                                        {"NLSCSH", {"static heat transfer with structure", true}},
                                                        {"159", {"transient heat transfer with structure", true}},
                                                        {"NLTCSH", {"transient heat transfer with structure", true}},
                                                        {"200", {"design optimization", false}},
                                                        {"DESOPT", {"design optimization", false}},
                                                        {"400", {"nonlinear analysis", true}},
                                                        {"NONLIN", {"nonlinear analysis", true}},
                                                        {"401", {"multistep nonlinear analysis", true}},
                                                        {"402", {"multistep nonlinear kinematics", true}},
                                                        {"414", {"multistep nonlinear analysis", true}},
                                                        {"600", {"nonlinear analysis", true}},
                                                        {"601", {"nonlinear analysis", true}},
                                                        {"700", {"explicit nonlinear analysis", true}},
                                                        {"701", {"explicit nonlinear analysis", true}}};
  const auto found = all.find(sol);
  return found == all.end() ? nullptr : &found->second;
}

bool has_large_displacements(const records::Deck& deck) {
  const auto* found = deck.find_param("LGDISP");
  return found && (found->value == "1" || found->value == "2");
}

}  // namespace

void note_solution(const records::Deck& deck, Diagnostics& diagnostics) {
  const auto* other = find_other_solution(deck.sol);
  if (other && other->has_nonlinear_statics && has_large_displacements(deck))
    diagnostics.note("cli.other-solution", deck.locate({0, 0}),
                     fmt::format("SOL {} is {}, with PARAM,LGDISP", deck.sol, other->name),
                     "bough static solves it with large displacements and elastic materials, other commands linearly");
  else if (other)
    diagnostics.note("cli.other-solution", deck.locate({0, 0}), fmt::format("SOL {} is {}", deck.sol, other->name),
                     other->has_complex_modes ? "bough modes gives them; with --ignore CMETHOD the real ones"
                                              : "this is the linear solution of the unchanged cards");
}

namespace {

/// Names of the cards of the deck that make its elements nonlinear, those that are passed over among them.
std::string list_nonlinear_cards(const records::Deck& deck) {
  static const std::set<std::string> names{"MATS1",   "MATEP",    "MATHE",   "MATHP",   "CREEP",
                                           "CGAP",    "BCONTACT", "BCTABLE", "BCTSET",  "BLSEG",
                                           "BOUTPUT", "MATVE",    "MATVP",   "PLSOLID", "PLPLANE"};
  std::string text;
  for (const auto& card : deck.unused)
    if (names.count(card.name) > 0 && card.name != "CGAP") text += (text.empty() ? "" : ", ") + card.name;
  if (!deck.special.cgap.empty()) text += text.empty() ? "CGAP" : ", CGAP";
  return text;
}

}  // namespace

bool is_nonlinear_sequence(const records::Deck& deck) {
  const auto* other = find_other_solution(deck.sol);
  return other && other->has_nonlinear_statics;
}

bool choose_static_solution(const records::Deck& deck, bool is_linear, bool is_nonlinear, Diagnostics& diagnostics) {
  const bool is_sequence = is_nonlinear_sequence(deck);
  if (is_linear && is_nonlinear)
    throw InputError("cli.nonlinear-static", {}, "found both --linear and --nonlinear", "give one of them");
  const bool is_chosen = is_nonlinear || (is_sequence && !is_linear && has_large_displacements(deck));
  if (is_chosen) {
    if (const auto cards = list_nonlinear_cards(deck); !cards.empty())
      throw InputError("cli.nonlinear-static", deck.locate({0, 0}),
                       cards + " describe nonlinear materials or contact, found a solution of elastic materials",
                       "take these cards away, or give --linear");
    return true;
  }
  if (is_sequence && !is_linear)
    throw InputError("cli.nonlinear-static", deck.locate({0, 0}),
                     fmt::format("SOL {} is {}, found neither PARAM,LGDISP,1 nor --linear", deck.sol,
                                 find_other_solution(deck.sol)->name),
                     "bough static --nonlinear solves with large displacements and elastic materials, --linear the "
                     "cards as they stand");
  note_solution(deck, diagnostics);
  return false;
}

namespace {

/// Nonlinear transient response, of structures (129) and of structures with heat (159).
bool is_nonlinear_transient(const std::string& sol) {
  static const std::set<std::string> all{"99", "129", "NLTRAN", "159", "NLTCSH"};
  return all.count(sol) > 0;
}

}  // namespace

void check_nonlinear_transient(const records::Deck& deck, std::size_t num_subcases, Diagnostics& diagnostics) {
  if (!is_nonlinear_transient(deck.sol)) return;
  auto names = list_nonlinear_cards(deck);
  if (has_large_displacements(deck)) names += names.empty() ? "PARAM,LGDISP" : ", PARAM,LGDISP";
  if (!names.empty())
    diagnostics.error("cli.nonlinear-transient", deck.locate({0, 0}),
                      fmt::format("SOL {} is {}, found {}, which the linear response does not follow", deck.sol,
                                  find_other_solution(deck.sol)->name, names),
                      "take these cards away, or give transient --linear");
  if (num_subcases > 1)
    diagnostics.error("cli.nonlinear-transient", deck.locate({0, 0}),
                      fmt::format("each subcase of SOL {} starts where the one before ended, found {} subcases",
                                  deck.sol, num_subcases),
                      "give --subcase n for one that starts from rest, or transient --linear for all from rest");
}

const ResponseSolution* find_response_solution(const std::string& sol) {
  static const ResponseSolution direct_frequency{false, true}, modal_frequency{false, false};
  static const ResponseSolution direct_transient{true, true}, modal_transient{true, false};
  static const std::map<std::string, const ResponseSolution*> all{
      {"8", &direct_frequency},      {"26", &direct_frequency},      {"108", &direct_frequency},
      {"DFREQ", &direct_frequency},  {"SEDFREQ", &direct_frequency}, {"DIRECT", &direct_frequency},
      {"9", &direct_transient},      {"27", &direct_transient},      {"109", &direct_transient},
      {"DTRAN", &direct_transient},  {"SEDTRAN", &direct_transient}, {"11", &modal_frequency},
      {"30", &modal_frequency},      {"111", &modal_frequency},      {"MFREQ", &modal_frequency},
      {"SEMFREQ", &modal_frequency}, {"12", &modal_transient},       {"31", &modal_transient},
      {"112", &modal_transient},     {"MTRAN", &modal_transient},    {"SEMTRAN", &modal_transient}};
  const auto found = all.find(sol);
  if (found == all.end() && is_nonlinear_transient(sol)) return &direct_transient;
  return found == all.end() ? nullptr : found->second;
}

bool asks_complex_modes(const records::Deck& deck, const std::vector<std::string>& ignored) {
  const auto* other = find_other_solution(deck.sol);
  return other && other->has_complex_modes && std::none_of(ignored.begin(), ignored.end(), [](const std::string& name) {
           return name == "CMETHOD" || name == "cmethod" || name == "EIGC";
         });
}

bool has_modal_complex_modes(const std::string& sol) {
  static const std::array modal{"110", "29", "SEMCEIG", "MCEIG"};
  return std::find(modal.begin(), modal.end(), sol) != modal.end();
}

}  // namespace bough::analysis
