#include "formats/nastran/detail/dynamic_control.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

using records::DynamicSelection;

struct Selection {
  std::string_view letters;  ///< the first four, which Nastran reads
  const char* name;
  int DynamicSelection::*set;
};
constexpr std::array selections{
    Selection{"DLOA", "DLOAD", &DynamicSelection::dload},  Selection{"FREQ", "FREQUENCY", &DynamicSelection::frequency},
    Selection{"TSTE", "TSTEP", &DynamicSelection::tstep},  Selection{"SDAM", "SDAMPING", &DynamicSelection::sdamping},
    Selection{"OFRE", "OFREQ", &DynamicSelection::ofreq},  Selection{"RAND", "RANDOM", &DynamicSelection::random},
    Selection{"RCRO", "RCROSS", &DynamicSelection::rcross}};

struct Request {
  std::string_view letters;
  const char* name;
};
constexpr std::array requests{
    Request{"DISP", "DISPLACEMENT"}, Request{"VECT", "DISPLACEMENT"}, Request{"PRES", "DISPLACEMENT"},
    Request{"VELO", "VELOCITY"},     Request{"ACCE", "ACCELERATION"}, Request{"SPCF", "SPCFORCES"},
    Request{"FORC", "FORCE"},        Request{"ELFO", "FORCE"},        Request{"OLOA", "OLOAD"},
    Request{"MPCF", "MPCFORCES"},    Request{"STRE", "STRESS"},       Request{"ELST", "STRESS"},
    Request{"STRA", "STRAIN"},       Request{"ESE", "ESE"},           Request{"GPFO", "GPFORCE"},
    Request{"GPST", "GPSTRESS"},     Request{"STRF", "STRFIELD"}};

bool has_option(std::string_view options, std::string_view option) {
  while (!options.empty()) {
    const auto word = trim(options.substr(0, options.find(',')));
    if (word == option) return true;
    options.remove_prefix(std::min(options.find(','), options.size() - 1) + 1);
  }
  return false;
}

DynamicCommand read_selection(const CommandText& c, const char* name, int& set, records::Subcase& subcase) {
  if (make_upper(c.value) == "ALL") {  // OFREQ = ALL
    set = 0;
    return DynamicCommand::Read;
  }
  const auto id = parse_int(c.value);
  if (!id || *id < 0) return DynamicCommand::BadValue;
  set = *id;
  subcase.commands[name] = c.at;
  return DynamicCommand::Read;
}

DynamicCommand read_request(const CommandText& c, const char* name, DynamicSelection& selected) {
  records::OutputRequest request;
  const auto value = make_upper(c.value);
  const auto id = parse_int(c.value);
  request.is_all = value == "ALL" || id == -1;
  request.is_none = value == "NONE";
  if (!request.is_all && !request.is_none) {
    if (!id || *id < 1) return DynamicCommand::Other;
    request.set = *id;
  }
  request.is_phase = has_option(c.options, "PHASE");
  request.is_punched = has_option(c.options, "PUNCH");
  request.is_fibre = has_option(c.options, "FIBER");
  request.is_printed = has_option(c.options, "PRINT") || (!request.is_punched && !has_option(c.options, "PLOT"));
  request.at = c.at;
  selected.outputs[name] = request;
  return DynamicCommand::Read;
}

/// MEFFMASS(GRID = 12, SUMMARY, ...) = YES, NO or a set.
DynamicCommand read_effective_mass(const CommandText& c, DynamicSelection& selected) {
  selected.effective_mass_grid.reset();
  if (make_upper(c.value) == "NO" || make_upper(c.value) == "NONE") return DynamicCommand::Read;
  int grid = 0;
  if (const auto at = c.options.find("GRID"); at != std::string::npos) {
    const auto rest = std::string_view(c.options).substr(at + 4);
    const auto equals = rest.find('=');
    const auto id = equals == std::string_view::npos
                        ? std::nullopt
                        : parse_int(trim(rest.substr(equals + 1, rest.find(',') - equals - 1)));
    if (!id || *id < 0) return DynamicCommand::BadValue;
    grid = *id;
  }
  selected.effective_mass_grid = grid;
  return DynamicCommand::Read;
}

}  // namespace

DynamicCommand read_dynamic_command(const CommandText& c, records::Subcase& subcase, DynamicSelection& selected) {
  const auto letters = std::string_view(c.word).substr(0, 4);
  for (const auto& s : selections)
    if (letters == s.letters && (letters != "SDAM" || c.options.empty() || c.options.starts_with("STR"))) {
      const auto read = read_selection(c, s.name, selected.*s.set, subcase);
      // Steps of TSTEPNL have negative ids (parse_tstepnl).
      if (read == DynamicCommand::Read && c.word == "TSTEPNL") selected.tstep = -selected.tstep;
      return read;
    }
  if (c.word == "LOADSET") return read_selection(c, "LOADSET", selected.loadset, subcase);
  if (c.word == "IC" && (c.options.empty() || c.options == "PHYSICAL"))
    return read_selection(c, "IC", selected.ic, subcase);
  if (letters == "RESV") {
    const auto value = make_upper(c.value);
    selected.resvec = value != "NO" && value != "COMPONENT";
    return DynamicCommand::Read;
  }
  if (letters == "MEFF") return read_effective_mass(c, selected);
  for (const auto& r : requests)
    if (letters == r.letters) return read_request(c, r.name, selected);
  return DynamicCommand::Other;
}

std::optional<records::CaseSet> read_case_set(std::string_view text) {
  std::string plain(text);
  std::replace(plain.begin(), plain.end(), ',', ' ');
  std::vector<std::string> words;
  for (auto rest = trim(plain); !rest.empty();) {
    const auto word = rest.substr(0, rest.find_first_of(" \t"));
    words.push_back(make_upper(word));
    rest = trim(rest.substr(word.size()));
  }
  records::CaseSet set;
  if (words.empty()) return std::nullopt;
  double thru_end = 0;  // of the range that EXCEPT takes from
  bool in_except = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "ALL") {
      set.is_all = true;
    } else if (words[i] == "EXCEPT") {
      if (set.ranges.empty()) return std::nullopt;
      in_except = true;
      thru_end = set.ranges.back().last;
    } else if (words[i] == "THRU") {
      const auto last = i + 1 < words.size() ? parse_int(words[i + 1]) : std::nullopt;
      if (!last || set.ranges.empty() || *last < set.ranges.back().first) return std::nullopt;
      set.ranges.back().last = *last;
      ++i;
    } else {
      const auto value = parse_real(words[i]);
      if (!value) return std::nullopt;
      if (in_except && *value > thru_end) in_except = false;
      set.ranges.push_back({*value, *value, in_except});
    }
  }
  return set;
}

}  // namespace bough::nastran::detail
