#include "formats/nastran/detail/field_names.hpp"

#include <map>
#include <sstream>

namespace bough::nastran::detail {
namespace {

using Names = std::map<std::string, std::vector<std::string>, std::less<>>;

constexpr const char* coord1 = "CID G1 G2 G3";
constexpr const char* coord2 = "CID RID A1 A2 A3 B1 B2 B3 C1 C2 C3";
constexpr const char* shape = "PID MID GROUP TYPE - - - - DIM1 DIM2 DIM3 DIM4 DIM5 DIM6 DIM7 DIM8 DIM9 DIM10";
constexpr const char* beam = "EID PID GA GB X1 X2 X3 OFFT PA PB W1A W2A W3A W1B W2B W3B";
constexpr const char* quad = "EID PID G1 G2 G3 G4 THETA ZOFFS - TFLAG T1 T2 T3 T4";
constexpr const char* triangle = "EID PID G1 G2 G3 THETA ZOFFS - - TFLAG T1 T2 T3";
constexpr const char* two_points = "EID PID G1 C1 G2 C2";

constexpr const char* cards[][2] = {
    {"GRID", "ID CP X1 X2 X3 CD PS SEID"},
    {"CORD1R", coord1},
    {"CORD1C", coord1},
    {"CORD1S", coord1},
    {"CORD2R", coord2},
    {"CORD2C", coord2},
    {"CORD2S", coord2},
    {"MAT1", "MID E G NU RHO A TREF GE ST SC SS MCSID"},
    {"MAT2", "MID G11 G12 G13 G22 G23 G33 RHO A1 A2 A3 TREF GE ST SC SS MCSID"},
    {"MAT8", "MID E1 E2 NU12 G12 G1Z G2Z RHO A1 A2 TREF XT XC YT YC S GE F12 STRN"},
    {"PBAR", "PID MID A I1 I2 J NSM - C1 C2 D1 D2 E1 E2 F1 F2 K1 K2 I12"},
    {"PBARL", shape},
    {"PBEAML", shape},
    {"PBEAM", "PID MID A I1 I2 I12 J NSM C1 C2 D1 D2 E1 E2 F1 F2"},
    {"PROD", "PID MID A J C NSM"},
    {"PTUBE", "PID MID OD T NSM OD2"},
    {"PELAS", "PID K GE S"},
    {"PMASS", "PID M"},
    {"PDAMP", "PID B"},
    {"PVISC", "PID CE CR"},
    {"PSHELL", "PID MID1 T MID2 12I/T**3 MID3 TS/T NSM Z1 Z2 MID4"},
    {"PSHEAR", "PID MID T NSM F1 F2"},
    {"PSOLID", "PID MID CORDM IN STRESS ISOP FCTN"},
    {"PCOMP",
     "PID Z0 NSM SB FT TREF GE LAM MID1 T1 THETA1 SOUT1 MID2 T2 THETA2 SOUT2 MID3 T3 THETA3 SOUT3 MID4 T4 THETA4 SOUT4 "
     "MID5 T5 THETA5 SOUT5 MID6 T6 THETA6 SOUT6 MID7 T7 THETA7 SOUT7 MID8 T8 THETA8 SOUT8"},
    {"CBAR", beam},
    {"CBEAM", beam},
    {"CROD", "EID PID G1 G2"},
    {"CTUBE", "EID PID G1 G2"},
    {"CONROD", "EID G1 G2 MID A J C NSM"},
    {"CONM2", "EID G CID M X1 X2 X3 - I11 I21 I22 I31 I32 I33"},
    {"CELAS1", two_points},
    {"CELAS2", "EID K G1 C1 G2 C2 GE S"},
    {"CMASS1", two_points},
    {"CMASS2", "EID M G1 C1 G2 C2"},
    {"CDAMP1", two_points},
    {"CDAMP2", "EID B G1 C1 G2 C2"},
    {"CQUAD4", quad},
    {"CQUADR", quad},
    {"CTRIA3", triangle},
    {"CTRIAR", triangle},
    {"EIGRL", "SID V1 V2 ND MSGLVL MAXSET SHFSCL NORM"},
    {"EIGR", "SID METHOD F1 F2 NE ND - - NORM G C"},
    {"FORCE", "SID G CID F N1 N2 N3"},
    {"MOMENT", "SID G CID M N1 N2 N3"},
    {"GRAV", "SID CID A N1 N2 N3 MB"},
    {"RFORCE", "SID G CID A R1 R2 R3 METHOD RACC"},
    {"PLOAD1", "SID EID TYPE SCALE X1 P1 X2 P2"},
    {"PLOAD2", "SID P"},
    {"PLOAD4", "SID EID P1 P2 P3 P4"},
    {"LOAD", "SID S S1 L1 S2 L2 S3 L3"},
    {"SPC", "SID G1 C1 D1 G2 C2 D2"},
    {"SPCD", "SID G1 C1 D1 G2 C2 D2"},
    {"PARAM", "N V1 V2"},
};

Names make_names() {
  Names names;
  for (const auto& card : cards) {
    std::istringstream words(card[1]);
    for (std::string word; words >> word;) names[card[0]].push_back(word);
  }
  return names;
}

}  // namespace

const std::vector<std::string>& get_field_names(std::string_view card) {
  static const Names names = make_names();
  static const std::vector<std::string> none;
  const auto found = names.find(card);
  return found == names.end() ? none : found->second;
}

int get_entry_size(std::string_view card) {
  if (card == "PELAS" || card == "PVISC" || card == "CORD1R" || card == "CORD1C" || card == "CORD1S") return 4;
  return card == "PMASS" || card == "PDAMP" ? 2 : 0;
}

}  // namespace bough::nastran::detail
