#include "formats/nastran/detail/known_params.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>
#include <vector>

#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

/// Requirement on the value of a parameter.
struct Rule {
  std::string_view name;
  const char* expected;
  bool (*accepts)(const std::string& value);
  /// Replacement of a value that is not accepted; empty: an error.
  std::string (*mend)(const std::string& value) = [](const std::string&) { return std::string(); };
};

bool is_real(const std::string& v) { return parse_real(v).has_value(); }
bool is_integer(const std::string& v) { return parse_int(v).has_value(); }
bool is_answer(const std::string& v) { return v == "YES" || v == "Y" || v == "NO" || v == "N"; }
bool is_method(const std::string& v) { return v == "ABS" || v == "TOTAL" || v == "REL"; }
/// A whole number written as a real one.
std::string round_real(const std::string& v) {
  const auto value = parse_real(v);
  return value && std::abs(*value) < 1e9 && std::round(*value) == *value ? std::to_string(std::lround(*value)) : "";
}

/// Parameters that change results of Bough, and GRDPNT, which check prints.
const std::vector<Rule>& get_rules() {
  static const std::vector<Rule> rules{
      {"AUTOSPC", "YES or NO", [](const std::string& v) { return is_answer(v) || v == "1"; },
       [](const std::string&) { return std::string("YES"); }},
      {"CB1", "a number", is_real},
      {"CB2", "a number", is_real},
      {"CK1", "a number", is_real},
      {"CK2", "a number", is_real},
      {"CK3", "a number", is_real},
      {"CP1", "a number", is_real},
      {"CP2", "a number", is_real},
      {"CM1", "a number", is_real},
      {"CM2", "a number", is_real},
      {"CMSALOAD", "YES or NO", is_answer},
      {"COUPMASS", "an integer", is_integer,
       [](const std::string& v) {
         if (const auto value = parse_real(v)) return std::string(*value > 0 ? "1" : "-1");
         return std::string(v == "YES" ? "1" : v == "NO" ? "-1" : "");
       }},
      {"EPZERO", "a number, 0 or above", [](const std::string& v) { return parse_real(v).value_or(-1) >= 0; }},
      {"FOLLOWK", "YES or NO", is_answer},
      {"G", "a number", is_real},
      {"GRDPNT", "an integer", is_integer, round_real},
      {"LGDISP", "-1, 0, 1 or 2", [](const std::string& v) { return v == "-1" || v == "0" || v == "1" || v == "2"; }},
      {"INREL", "0, -1 or -2", [](const std::string& v) { return v == "0" || v == "-1" || v == "-2"; },
       [](const std::string& v) {
         const auto whole = round_real(v);
         return whole == "0" || whole == "-1" || whole == "-2" ? whole : std::string();
       }},
      {"K6ROT", "a number, 0 or above", [](const std::string& v) { return parse_real(v).value_or(-1) >= 0; }},
      {"SNORM", "a number", is_real},
      {"WTMASS", "a number above 0", [](const std::string& v) { return parse_real(v).value_or(0) > 0; }}};
  return rules;
}

/// Further parameters used by responses.
const std::vector<Rule>& get_response_rules() {
  static const std::vector<Rule> rules{
      {"ALPHA1", "a number", is_real},
      {"ALPHA2", "a number", is_real},
      {"DFREQ", "a number", is_real},
      {"ENFMETH", "ABS, TOTAL or REL", is_method},
      {"ENFMOTN", "ABS, TOTAL or REL", is_method},
      {"HFREQ", "a number", is_real},
      {"KDAMP", "1 or -1", is_integer},
      {"LFREQ", "a number", is_real},
      {"LMODES", "an integer", is_integer},
      {"RESVEC", "YES or NO", is_answer},
      {"RMSINT", "LINEAR or LOGLOG", [](const std::string& v) { return v == "LINEAR" || v == "LOGLOG"; }},
      {"W3", "a number", is_real},
      {"WR3", "a number", is_real},
      {"WR4", "a number", is_real},
      {"W4", "a number", is_real}};
  return rules;
}

/// The others of the quick reference guides (MSC, NX, COSMIC, Autodesk).
constexpr std::string_view known_params =
    "ACEXTMTD ACEXTSET ACOUT ACOWEAK ACSYM ADJFRQ ADJMETH ADMPOST ADPCON ADSTAT AERODOF AESDISC AESMAXIT AESMETH "
    "AESRNDM AESTOL AFNORM AFZERO AGGROT ALPHA1 ALPHA1FL ALPHA2 ALPHA2FL ALTRED ALTSHAPE AMLS AMPCZ APPEN ARBMASP "
    "ARBMFEM ARBMNOW ARBMPS ARBMSS ARBMSTYP ARF ARS ASCII4 ASCOUP ASETOUT ASING AUNITS AUTOADJ AUTOBPD "
    "AUTOFIXRIGIDSPC AUTOGOUT AUTOMPC AUTOMSET AUTOQSET AUTOSEEL AUTOSPCR AUTOSPRT AUTOSPRTT BAILOUT BAROFFSET "
    "BEAMBEA BEIGRED BETA BIGER BIGER1 BIGER2 BLADEDEL BOLTFACT BPSMALL BSHDAMP BSHDMP BUCKLE BUSHNM BUSHSTIF CA1 CA2 "
    "CASIEMA CASPIV CB3 CDIF CDITER CDPCH CDPRT CFDIAGP CFRANDEL CHECKOUT CHKMASS CHKSTIF CK3 CK41 CK42 CLOSE CM3 "
    "CNTASET COLPHEXA COMPMATT CONFAC CONSBLK CONTACTTOL CORROPT COSUBCYC COSUBMAX COUPDAM CP1 CP2 CQC CTYPE CURV "
    "CURVPLOT CWDIAGP CWELDCB CWRANDEL CYCIO CYCSEQ DBALL DBCCONV DBCDIAG DBCLEAN DBCOVWRT DBDICT DBDN DBDRNL DBDROPT "
    "DBDRPRJ DBDRVER DBEXT DBRCV DBRNL DBUP DDRMM DEACTEL DEBUG DESPCH DESPCH1 DESPCHL DFREQ DIGITS DISOPT DLTBLK "
    "DMIGCASE DMIGNRG DMIPCH DOF123 DOPT DPEPS DPHFLG DPREONLY DRMH DSNOKD DSZERO DV3PASS ECMETH EFWGT ELEMGEOMCHECK "
    "ELEMITER ELITASPC ENFMETH ENFMOTN EPPRT EPSBIG EPSHT EPSILONT EPSMALC EPSMALM EPSMALU ERPC ERPREFDB ERPRHO "
    "ERPRLF ERROR ESLFSAV ESLLCOMP ESLMOVE ESLMPC1 ESLNRUN ESLOPTEX ESLPRT ESLPRT1 ESLRCF ESLUNIT1 ESLUNIT2 EST "
    "EULBND EULBULKL EXCFAC EXTBEMI EXTBEMO EXTDR EXTDROUT EXTDRUNT EXTOUT EXTRCV EXTSEOUT EXTUNIT F56 FACTDIAG "
    "FACTOR FBATOLR FBLEND FIXEDB FKSYMFAC FLEXINCR FLUIDMP FLUIDNE FLUIDSE FMULTI FRADB FREQDEP FRIC FRQDEPO "
    "FRRD1SEL FRRU FRUMIN FTL FULLSEDR FUNITS FZERO GDAMPF GE GEOMPLT GEOMU GFL GPECT GPWG GRDEQ GRDPNT GUSTAERO "
    "GYROAVG HEATCMD HEATSTAT HFREQ HFREQFL HTOCITS HTOCPRT HTOCTOL IFP IFP5 IFTM IMPHGC INEMETH INP4FMT INRELM INRLM "
    "INTRFACE INTSUB IPAD IRES ITAPE ITFPRNT ITOITCNT ITOOPITR ITOPALG ITOPCONV ITOPITRS ITOPOPT ITORMAS ITOSIMP "
    "ITOSIMP1 ITOSIMP2 ITRFMT ITSEPS ITSERR ITSMAX IUNIT KDAMP KDAMPFL KDIAG KEPRT KGGCPCH KGGLPCH LAMA LAMLIM LANGLE "
    "LFREQ LFREQFL LGSTRN LMDYN LMFACT LMODES LMODESFL LMSTAT LOADFACS LOADGENX LOADINC LOADU LOOPID LSTRN "
    "MACH MALIAS01 MALIAS02 MALIAS03 MASSDENS MATNL MATRIXTYPE MAUTOSPC MAXIREVV MAXLINES MAXLP MAXRATIO MAXRPM MDOF "
    "MECHFIL MECHFIX MECHPRT MESH MESHG METHCMRS METHFL METHT MICRO MODACC MODEL MODETRAK MPCX MPCZERO MPTUNIT "
    "MRALIAS NASPRT NBRUPT NDAMP NDAMPM NEWMARK NEWSET NINTPTS NLAYERS NLDISP NLHTLS NLHTTOL NLHTWK NLMAX NLMIN "
    "NLPACK NLPCIITN NLSTATIC NLTOL NMLOOP NMNLFRQ NOCOMP NOCOMPS NODCMP NOELOF NOELOP NOGPF NOMSGSTR NONCUP NONUP "
    "NOPRT NOSORT1 NQMAX NQSET NSGRDS4 NT NUMOUT NUMOUT1 NUMOUT2 OCMP OCORD OELMOPT OELMSET OG OGEM OGEOM OGPS "
    "OGRDOPT OGRDSET OIBULK OLDSEQ OMACHPR OMAXR OMID OMIDS OMSGLVL OP2FMT OP4FMT OPCHSET OPGEOM OPGTKG OPPHIB "
    "OPPHIPA OPPHIPB OPTEXIT OPTIM OPTION OSETELE OSETGRD OSWELM OSWPPT OUGCORD OUGSPLIT OUMU OUNIT1 OUNIT2 OUNIT2M "
    "OUTOPT OUTSMAP P2DITER P3DITER PACINFID PANELMP PARTNUM PATPLUS PATVER PBRPROP PCHRESP PDRMSG PEDGEP PENFN "
    "PERCENT PEXTS4 PH2OUT PHPSPT PKNSKPR PKRSP PLTMSG PNCHDB POST POSTADF POSTEXT POSTNAS POSTU PREFDB PREGEOM "
    "PRESEQ PRGPST PROUT PRPA PRPHIVZ PRPJ PRTBGPDT PRTCSTM PRTEQXIN PRTGPDT PRTGPL PRTGPTT PRTMAXIM PRTMGG PRTPG "
    "PRTRESLT PSENPCH PVALINIT Q QLHOUL QLMNTH QSETREM RADMOD RANREAL RBEALLOC RBMODES RBSETPRT RCONTACT RESFLEX "
    "RESLTOPT RESPATH RESTART RESVALT RESVEC RESVECA RESVECO RESVINER RESVOCV RESVPGF RESVRAT RESVSE RESVSI RESVSLI "
    "RESVSO RFORCE RGBEAMA RGBEAME RGLCRIT RGSPRGK RIGIDLINK RKSCHEME RMS RMSINT RMXCRT RMXPANEL RMXTRAN ROHYDRO "
    "ROMULTI ROTAD2 ROTCMRF ROTCOUP ROTCSV ROTGPF ROTMRF ROTSYNC ROTSYNCD RPM RSCON RSOPT RSPECTRA RSPLICOR RSPRINT "
    "RSTTEMP S1 S1A S1AG S1AM S1G S1M SAVEOFP SBOLTZ SCRSPEC SDAMPUP SDRPOPT SEAU SECOMB SEMAP SEMAPOPT SEMAPPRT "
    "SENSUOO SEOP2CV SEP1XOVR SEPIXOVR SEQOUT SERST SESDAMP SESEF SHIFT1 SHLDAMP SHLDMP SIGMA SIGMA1 SIGNB SINGOP "
    "SINGPLT SKINOUT SKPAMP SKPLOAD SKPMTRX SLOOPID SMALLQ SMP SNORMPRT SOFTEXIT SOL600 SOLADJC SOLID SOLUTIONERROR "
    "SOLVER SPARSEDM SPARSEDR SPARSEPH SPCGEN SPCSTR SPDRRAT SPINLN2 SPRBK SRCCOMPS SRCOMPS START STEPFCT STEPFCTL "
    "STIME STRESS STRUCTMP SUBCASID SUBCID SUBID SUBSKP SUPAERO SUPDOF SUPER SUPKEPS SVUNIT2 SWPANGLE SYNCDAMP TABID "
    "TABS TDAMP TDMIN TEMPMATE TESTNEG TESTSE TFORTIME THERMAL THRESH TINY TOLRSC TORSIN TSTATIC UACCEL UNITSYS "
    "UPDTBSH UPFAC UPWARD USETPRT USETSEL USETSTR1 USETSTR2 USETSTR3 USETSTR4 VARPHI VELCUT VMOPT VREF VUBEAM "
    "VUELJUMP VUENEXT VUEXIST VUGJUMP VUGNEXT VUHEXA VUPENTA VUQUAD4 VUTETRA VUTRIA3 W3 W3FL W4 W4FL WMODAL WR3 WR4 "
    "WRBEAMB WRN WVLQ XFACX XFACY XFLAG XUPFAC XYUNIT ZROCMAS ZROVEC";

/// Unknown names for which the nearest known one is looked for.
constexpr int max_proposals_of_params = 20;

/// First letters of the parameters of SOL 600 and SOL 700, hundreds of them.
constexpr std::array<std::string_view, 3> known_prefixes{"MAR", "MR", "DY"};

/// Parameters that end in a number: G1, FCTC3, ZUZRI10.
constexpr std::string_view numbered_params =
    "FCTC FCTM FCTZ G MALIAS PITIME PMAX USER ZUZRC ZUZRI ZUZRL ZUZRR ZUZCC ZUZCI ZUZCR INT REAL CMPLX CHAR";

std::vector<std::string> split(std::string_view names) {
  std::vector<std::string> words;
  while (!names.empty()) {
    const auto end = std::min(names.find(' '), names.size());
    if (end > 0) words.emplace_back(names.substr(0, end));
    names.remove_prefix(std::min(end + 1, names.size()));
  }
  return words;
}

struct Names {
  std::vector<std::string> used, all;
  std::unordered_set<std::string> known, stems;
  Names() {
    for (const auto& rule : get_rules())
      if (rule.name != "GRDPNT" && rule.name != "CK3") used.emplace_back(rule.name);
    all = used;
    const auto others = split(known_params), numbered = split(numbered_params);
    all.insert(all.end(), others.begin(), others.end());
    known.insert(all.begin(), all.end());
    stems.insert(numbered.begin(), numbered.end());
  }
};

bool is_known(const Names& names, const std::string& name) {
  for (const auto prefix : known_prefixes)
    if (name.starts_with(prefix)) return true;
  const auto last = name.find_last_not_of("0123456789");
  return names.known.count(name) > 0 ||
         (last != std::string::npos && last + 1 < name.size() && names.stems.count(name.substr(0, last + 1)) > 0);
}

/// Reports values of a wrong kind as fe.bad-param; the message contains the value that is used, or the card is dropped.
void check_values(records::Deck& deck, Diagnostics& diagnostics, bool of_responses) {
  auto rules = get_rules();
  if (of_responses) rules.insert(rules.end(), get_response_rules().begin(), get_response_rules().end());
  std::vector<records::Param> good;
  for (auto& param : deck.params) {
    const auto rule = std::find_if(rules.begin(), rules.end(), [&](const Rule& r) { return r.name == param.name; });
    if (rule != rules.end() && !rule->accepts(param.value)) {
      const auto mended = rule->mend(param.value);
      const std::string what = "PARAM," + param.name + " is " +
                               (param.value.empty() ? std::string("blank") : '"' + param.value + '"') + ", expected " +
                               rule->expected;
      if (mended.empty()) {
        diagnostics.error("fe.bad-param", deck.locate(param.at), what, "correct the value");
        continue;
      }
      diagnostics.warning("fe.bad-param", deck.locate(param.at), what + "; it is taken as " + mended,
                          "correct the value");
      param.value = mended;
    }
    good.push_back(std::move(param));
  }
  deck.params = std::move(good);
}

/// A parameter some values of which change the answer and are not supported.
struct ActingParam {
  std::string_view name;
  bool of_responses;
  bool (*acts)(const std::string& value);
  const char* what;
};
constexpr auto is_not_one = [](const std::string& v) { return parse_real(v).value_or(1) != 1; };
constexpr auto is_yes = [](const std::string& v) { return v == "YES" || v == "Y"; };
constexpr auto is_different = [](const std::string& v) { return v == "DIFF"; };
constexpr std::array acting_params{
    ActingParam{"HEATSTAT", false, is_yes, "computes temperatures by heat transfer, which are not computed here"},
    ActingParam{"CK3", false, is_not_one, "scales a part of the stiffness"},
    ActingParam{"CK41", true, is_not_one, "scales the structural damping"},
    ActingParam{"SHLDAMP", true, is_different, "damps shells by each of their materials"},
    ActingParam{"SHLDMP", true, is_different, "damps shells by each of their materials"}};

/// Reports a parameter that changes the answer: deck.unsupported-param.
bool report_acting(const records::Deck& deck, const records::Param& param, bool of_responses,
                   const std::vector<std::string>& ignored, Diagnostics& diagnostics) {
  for (const auto& acting : acting_params) {
    if (param.name != acting.name || (acting.of_responses && !of_responses) || !acting.acts(param.value)) continue;
    // Shells alone are damped differently.
    if (param.name.starts_with("SHLD") && deck.shells.empty()) continue;
    const std::string what = "PARAM," + param.name + "," + param.value + " is not supported: it " + acting.what;
    if (std::any_of(ignored.begin(), ignored.end(), [&](const auto& name) { return make_upper(name) == param.name; }))
      diagnostics.warning("deck.unsupported-param", deck.locate(param.at), what, "ignored as asked");
    else
      diagnostics.error("deck.unsupported-param", deck.locate(param.at), what,
                        "take it out, or --ignore " + param.name + " to compute without it");
    return true;
  }
  return false;
}

}  // namespace

bool is_used_param(std::string_view name, bool of_responses) {
  const auto has = [name](const std::vector<Rule>& rules) {
    return std::any_of(rules.begin(), rules.end(), [name](const Rule& rule) { return rule.name == name; });
  };
  return name != "GRDPNT" && (has(get_rules()) || (of_responses && has(get_response_rules())));
}

void report_params(records::Deck& deck, const std::vector<std::string>& ignored, Diagnostics& diagnostics,
                   bool of_responses) {
  check_values(deck, diagnostics, of_responses);
  static const Names names;
  std::string list;
  records::CardLocation first;
  std::unordered_set<std::string> seen;
  int num_unknown = 0;
  for (const auto& param : deck.params) {
    if (std::find(names.used.begin(), names.used.end(), param.name) != names.used.end()) continue;
    if (!seen.insert(param.name).second) continue;
    if (report_acting(deck, *deck.find_param(param.name), of_responses, ignored, diagnostics)) continue;
    const auto& more = get_response_rules();
    if (of_responses && std::any_of(more.begin(), more.end(), [&](const Rule& r) { return r.name == param.name; }))
      continue;
    if (!is_known(names, param.name)) {
      const bool is_looked_for = ++num_unknown <= max_proposals_of_params;
      auto nearest = is_looked_for ? find_nearest(param.name, names.used) : std::string{};
      if (is_looked_for && nearest.empty()) nearest = find_nearest(param.name, names.all);
      diagnostics.warning("deck.unknown-param", deck.locate(param.at),
                          "PARAM," + param.name + " is no parameter that Nastran knows; it is not used",
                          nearest.empty() ? "correct the name, or remove the card" : "did you mean " + nearest);
      continue;
    }
    if (list.empty()) first = param.at;
    list += (list.empty() ? "" : ", ") + param.name + " (line " + std::to_string(param.at.line) +
            (param.name == "GRDPNT" ? ", by check, --f06 and --op2 only)" : ")");
  }
  if (!list.empty())
    diagnostics.note("deck.unused-params", deck.locate(first), "PARAM not used: " + list,
                     "nothing to do: they concern output or other analyses");
}

}  // namespace bough::nastran::detail
