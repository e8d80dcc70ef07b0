#include "formats/nastran/detail/control_words.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::nastran::detail {
namespace {

constexpr std::string_view plain_commands =
    "ACCE BOUT DISP ECHO ELFO ELST ESE FORC GPFO GPST GROU HOUT LINE MAXL MEFF MPCF NOUT OLOA OUTP PAGE POST PRES SACC "
    "SDIS "
    "SET SETS "
    "SKIP SORT SPCF STRA STRE STRF SURF SVEC SVEL VECT VELO VOLU";

/// The other commands of the quick reference guides.
constexpr std::string_view known_commands =
    "A2GG ACFP ACOU ACPO ACTI ADAC ADAM ADAP ADJU AECO AERC AERO AESY AEUX ALOA ANAL APRE ASCA ASSI AUTO AUXC AUXM "
    "AUXT AVLE AXIS B2PP BCHA BCMO BCON BCRE BCSE BFRI BGRE BGSE BLDO BOLT BSEQ BSQU BUCK CAMP CCOM CLOA CMET CMSE "
    "CMSF "
    "COND COSM CRAC CSSC CYCF CYCS CZRE DACC DATA DATR DBSA DEAC DEFO DEMA DEPO DESF DESG DESM DESO DESS DESV DIVE "
    "DLOA DMTR DRSP DSAP DSPR DSYM DTEM DVEL DYNR DYRL EBDS EDE EFLO EFOR EKE ELAR ELPF ELSD ELSU ENDS ENDT ENFO ENTH "
    "EQUI ERP EXPL EXTD EXTR EXTS FATI FBOD FLSF FLST FLUX FMET FORM FREQ FRFI FRFO FRFR GCRS GELD GPKE GPRS "
    "GPSD GUST GVEC HADA HARM HDOT HTFL IC INCL INIT INPO INTE INTK IRAN JINT JOIN K2PP K42G KOUN LAMI LINK LOAD "
    "LSEQ M2PP MASS MATR MATV MAXM MAXT MAXU MCFR MEFF MFLU MODA MODC MODE MODP MODS MODT MONI MONV MPRE MTXP MXSP "
    "NCHI "
    "NLBU "
    "NLCN NLHA NLIC NLLO NLOP NLPA NLPC NLRE NLST NONL NSMS OFRE OFRQ OMOD OPRE OSTN OTIM OTME OUTR P2G PACI PAMF "
    "PANC PART PCHA PEAK PENE PFGR PFMO PFPA PLOT PLSL PREF PREL PROG RADB RAND RCPA RCRO RCSE REPC REPS RESI RESV "
    "RGYR RIGI RMAX RMET ROTO RSDA RSMA RSPE RSVC RVEL SDAM SDEN SEAL SECO SEDA SEDC SEDL SEDR SEDV SEEF SEEX SEFI "
    "SEKR "
    "SELG SELO SELR SEMG SEMP SEMR SERE SETP SEUP SHEL SKIN SMET SPCG SPLI STAT STEP STOC STRA SUBM SUBS SUPE "
    "SYMC "
    "SYMS TERM TFL THER TRIM TSTE TSTR UNGL USER VARC VATV VCCT VIBR VUGR WEAK WEIG XYCO";

constexpr std::size_t most_words = 100;  // of one note

/// Option of Bough with the results of a command; empty: none.
std::string_view find_option(std::string_view word) {
  struct Option {
    std::string_view command, option;
  };
  static constexpr std::array options{Option{"EKE", "EKE: 'modes --ese'"},
                                      Option{"EXTS", "EXTSEOUT: 'export --to extseout'"},
                                      Option{"MAXM", "MAXMIN: 'static --extremes'"}};
  for (const auto& one : options)
    if (word.substr(0, 4) == one.command) return one.option;
  return {};
}

bool is_among(std::string_view commands, std::string_view word) {
  word = word.substr(0, 4);
  while (!commands.empty()) {
    const auto end = std::min(commands.find(' '), commands.size());
    if (commands.substr(0, end) == word) return true;
    commands.remove_prefix(std::min(end + 1, commands.size()));
  }
  return false;
}

}  // namespace

bool is_plain_command(std::string_view word) {
  return word.substr(0, 2) == "XY" || word.substr(0, 4) == "PLOT" || is_among(plain_commands, word);
}

std::string find_nearest_command(std::string_view word) {
  static const std::vector<std::string> used{"SPC",     "MPC",         "LOAD", "METHOD", "STATSUB", "SUBCASE",
                                             "SUPORT1", "TEMPERATURE", "NSM",  "K2GG",   "M2GG",    "B2GG"};
  const bool is_loadset = word.substr(0, 6) == "LOADSE";
  // LOADSET is the only other command that begins with LOAD; LOADS is a typing error.
  const bool is_known = word.substr(0, 4) == "LOAD" ? is_loadset : is_among(known_commands, word);
  return is_known ? std::string{} : find_nearest(word, used);
}

void IgnoredCommands::add(const std::string& word, const records::CardLocation& at) {
  if (seen_.insert(word).second) words_.emplace_back(word, at);
}

void IgnoredCommands::report(const records::Deck& deck, Diagnostics& diagnostics) const {
  if (words_.empty()) return;
  // EXTSEOUT in a separate note, which an export of the superelement leaves out: it uses the command.
  IgnoredCommands external, others;
  for (const auto& word : words_) (word.first.substr(0, 4) == "EXTS" ? external : others).words_.push_back(word);
  if (!external.words_.empty() && !others.words_.empty()) {
    others.report(deck, diagnostics);
    external.report(deck, diagnostics);
    return;
  }
  std::string words, options, responses;
  bool has_others = words_.size() > most_words, asks_complex = false, has_rotors = false;
  const auto num_shown = std::min(words_.size(), most_words);
  for (std::size_t i = 0; i < num_shown; ++i) {
    words += (i == 0 ? "" : ", ") + words_[i].first + " (line " + std::to_string(words_[i].second.line) + ")";
    const auto option = find_option(words_[i].first);
    const auto* acts = find_unsupported_command(words_[i].first);
    if (acts)
      responses += (responses.empty() ? "" : ", ") + std::string(acts->name);
    else if (words_[i].first.substr(0, 4) == "CMET")
      asks_complex = true;
    else if (words_[i].first.substr(0, 4) == "RGYR")
      has_rotors = true;
    else if (option.empty())
      has_others = true;
    if (!option.empty() && options.find(option) == std::string::npos)
      options += (options.empty() ? "" : ", ") + std::string(option);
  }
  if (num_shown < words_.size()) words += " and " + std::to_string(words_.size() - num_shown) + " more";
  const std::string nothing = "nothing to do: they concern output or other analyses";
  std::vector<std::string> advice;
  if (!options.empty()) advice.push_back("options of the command line give results: " + options);
  if (!responses.empty()) advice.push_back(responses + " would change a response, where it is an error");
  if (asks_complex) advice.push_back("CMETHOD asks for complex modes, and modes are real here: without damping");
  if (has_rotors) advice.push_back("RGYRO spins rotors in SOL 107, 108, 110 and 111: they are at rest here");
  if (has_others || advice.empty()) advice.push_back((advice.empty() ? "" : "of the others: ") + nothing);
  std::string text;
  for (const auto& part : advice) text += (text.empty() ? "" : "; ") + part;
  diagnostics.note("deck.case-control-ignored", deck.locate(words_.front().second), "case control not used: " + words,
                   text);
}

const UnsupportedCommand* find_unsupported_command(std::string_view word) {
  using enum CommandScope;
  static constexpr std::array commands{
      UnsupportedCommand{"TFL", "TF", "transfer functions: stiffness, damping and mass of the response"},
      UnsupportedCommand{"NONLINEAR", "NOLIN1", "loads that depend on the motion"},
      UnsupportedCommand{"K42GG", "DMIG", "structural damping given as a matrix"},
      UnsupportedCommand{"RMETHOD", "ROTORD",
                         "rotors: gyroscopic terms of the response, which RGYRO selects by RSPINR"},
      UnsupportedCommand{"GUST", "GUST", "aerodynamic loads of a gust"},
      UnsupportedCommand{"MODESELECT", "MODESELECT", "the modes that take part in the response", Response, 6},
      UnsupportedCommand{"MFLUID", "MFLUID", "the mass of a fluid on the structure", Model},
      UnsupportedCommand{"MASSSET", "MASSSET", "a mass configuration", Model},
      UnsupportedCommand{"DEFORM", "DEFORM", "enforced deformations of elements", StaticLoad},
      UnsupportedCommand{"TRIM", "TRIM", "aerodynamic loads of a trimmed aircraft", StaticLoad},
      UnsupportedCommand{"BOLTLD", "BOLTFOR", "preloads of bolts", StaticLoad, 6},
      UnsupportedCommand{"CLOAD", "CLOAD", "a combination of loads of superelements", StaticLoad}};
  for (const auto& command : commands) {
    const auto name = std::string_view(command.name).substr(0, command.num_letters);
    if (word.substr(0, name.size()) == name) return &command;
  }
  return nullptr;
}

}  // namespace bough::nastran::detail
