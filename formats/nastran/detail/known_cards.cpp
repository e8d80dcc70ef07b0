#include "formats/nastran/detail/known_cards.hpp"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <vector>

#include "formats/nastran/detail/reading.hpp"

namespace bough::nastran::detail {
namespace {

using records::CardEffect;

constexpr std::string_view stiffness_cards =
    "CAABSF CACINF3 CACINF4 CAXIF2 CAXIF3 CAXIF4 CBAR CBEAM CBEAM3 CBEAR CBELT CBEND CBUSH CBUSH1D CBUSH2D "
    "CCONEAX CDUM1 CDUM2 CDUM3 CDUM4 CDUM5 CDUM6 CDUM7 CDUM8 CDUM9 "
    "CELAS1 CELAS1D CELAS2 CELAS2D CELAS3 CELAS4 CFAST CFLUID2 CFLUID3 CFLUID4 CGAP CHACAB CHACBR CHEX8 CHEX20 "
    "CHEXA CHEXA1 CHEXA2 CHEXCZ CIFHEX CIFPENT CIFQDX CIFQUAD CIHEX1 CIHEX2 CIHEX3 CIS2D8 CONROD CPENTA "
    "CPENTCZ CPLSTN3 CPLSTN4 CPLSTN6 CPLSTN8 CPLSTS3 CPLSTS4 CPLSTS6 CPLSTS8 CPYRA CPYRAM CQDMEM CQDMEM1 CQDMEM2 "
    "CQDPLT CQUAD CQUAD1 CQUAD2 CQUAD4 CQUAD8 CQUADP CQUADR CQUADX CQUADX4 CQUADX8 CRAC2D CRAC3D CRBAR CROD CSEAM "
    "CSHEAR CSLOT3 CSLOT4 CSPOT CSUPER CSUPEXT CTETRA CTORDRG CTRAPAX CTRAPRG CTRBSC CTRIA1 CTRIA2 CTRIA3 CTRIA6 "
    "CTRIAAX CTRIAP CTRIAR CTRIARG CTRIAX CTRIAX6 CTRIM6 CTRMEM CTRPLT CTRPLT1 CTRSHL CTRAX3 CTRAX6 CTUBE CTWIST "
    "CWEDGE CWELD CWELDC DMIAX DMIG DMIGROT GENEL RINGAX RINGFL SECTAX SPOINT "
    "CBUTT CCRSFIL CFILLET COMBWLD CUSER1 CUSERIN CQUAD4K CTRIA3K "
    "CELBOW CFFREE CFHEX1 CFHEX2 CFLSTR CFTETRA CFWEDGE CPSE2 CPSE3 CPSE4 "
    "CAXISYM CBARG CGEN CHOCK3 CHOCK4 CHOCK6 CHOCK8 CINTC CSPR CWSEAM MDBULK MDDMIG MDFAST MDSEAM MDWELD";
constexpr std::string_view mass_cards =
    "CMASS1 CMASS2 CMASS3 CMASS4 CONM1 CONM2 CONM3 NSM NSM1 NSMADD NSML NSML1 MFLUID CFSMASS";
constexpr std::string_view constraint_cards =
    "ASET ASET1 BCONP BCPROP BCPROPS BCBODY1 BCGRID BCONPRG BCONPRP BCTABLE BCTADD BCTSET BCBODY BCTABL1 BCONECT BCSEG "
    "BCSURF BGSET BGADD BLSEG BSURF BSURFS "
    "BNDGRID CRIGD1 CRIGD2 CRIGD3 CRIGDR CRROD CRTRPLT CRBE1 CRBE2 CRBE3 "
    "CRSPLINE CYAX CYJOIN CYSYM GMBC GMCORD GMSPC MPC MPCADD MPCAX MPCD MPCY OMIT OMIT1 OMITAX "
    "RBAR RBAR1 RBE1 RBE2 RBE2A RBE2D RBE2F RBE2GS RBE3 RBE3D RBE3U RBJOINT RJOINT RROD RSPLINE RSSCON RTRPLT "
    "RTRPLT1 SEBULK SECONCT SEMPLN SEQSEP RELEASE GTRAN SPC SPC1 SPCADD SPCAX SPCD1 SUPORT SUPORT1 SUPAX TRANS "
    "BDYC BDYS BDYS1 CONCT CONCT1 MPCS RELES SPCS SPCS1 SPCSD "
    "BJOIN MDBNDRY MDBOLT MDCONCT MDMPC MDRBE2 MDRBE3 MDRJNT MDRROD RBAX3D RCONN SPCG";
constexpr std::string_view load_cards =
    "ACCEL ACCEL1 ACSRCE BEADS BOLT BOLTFOR BOLTFRC BOLTLD BOLTSEQ DAREA DAREAS DEFORM DELAY DELAYS DLOAD DLONGIT "
    "DPHASE DPHASES "
    "DTEMP DTEMPEX FORCE FORCE1 FORCE2 FORCEAX FORCEDST GMLOAD GRAV INITADD INITS INITSO LOAD LOADCLID LOADCNAM "
    "LOADCSUB LOADCYH LOADCYN LOADCYT LOADJOIN LOADT LSEQ MOMAX MOMENT MOMENT1 MOMENT2 MOMNTDST NOLIN1 NOLIN2 "
    "NOLIN3 NOLIN4 NOLIN5 NOLIN6 PLOAD PLOAD1 PLOAD2 PLOAD3 PLOAD4 PLOADB3 PLOADE1 PLOADFP PLOADX PLOADX1 "
    "PRESAX PRESPT QBDY1 QBDY2 QBDY3 QHBDY QVECT QVOL RADLST RFORCE RFORCE1 RFORCE2 RLOAD1 RLOAD2 RLOADEX SLOAD "
    "SLOADN1 "
    "SPCD SPCR TEMP TEMPAX TEMPB3 TEMPBC TEMPD TEMPEX TEMPF TEMPG TEMPN1 TEMPP1 TEMPP2 TEMPP3 TEMPRB TIC TICS TLOAD1 "
    "TLOAD2 TLOAD3 YLDLOAD VCEV BFIELD CEMLOOP GEMLOOP LOADC MDIPOLE PERMBDY PROLATE REMFLUX SPCFLD TEMPP4 "
    "ACLOAD ACPLNW ACPOLE1 ACPOLE2 ALOAD BOLT1 FBALOAD FBODYLD HYDSTAT INITGAS MOTION PLOADG TIC3 TMPSET TTEMP";
constexpr std::string_view damping_cards = "CDAMP1 CDAMP1D CDAMP2 CDAMP2D CDAMP3 CDAMP4 CDAMP5 CVISC";
constexpr std::string_view neutral_cards =
    // Sets of dofs for component modes and for names: see find_loss.
    "BSET BSET1 CSET CSET1 QSET QSET1 USET USET1 BNDFIX BNDFIX1 BNDFREE BNDFRE1 EPOINT RVDOF RVDOF1 SPCOFF SPCOFF1 "
    "SBSET SEBSEP SEBSET SEBSET1 SECSET SECSET1 SEELT SELOAD SEQSET SEQSET1 SESET SESUP SEUSET SEUSET1 "
    // Properties and materials: without an element they do nothing.
    "BAROR BEAMOR CREEP GRDSET MAT1 MAT2 MAT3 MAT4 MAT5 MAT8 MAT9 MAT10 MAT10C MAT11 MATCID MATCRP MATDIGI MATCZ "
    "MATDMG MATEP MATF MATF1 MATFT MATG MATHE MATHEM MATHED MATHP MATM MATORT MATPE1 MATPLCY MATPLUG MATPOLY MATPZ1 "
    "MATPZ2 MATRIG MATS1 MATS3 MATS8 MATSMA MATSORT MATSR MATT1 MATT2 MATT3 MATT4 MATT5 MATT8 MATT9 MATT11 MATTC "
    "MATTEP MATTF MATTG MATTHE MATTM MATTORT MATTUSR MATTVE MATUSR MATVE MATVP MATTC1 MFLUIDP NLMOPTS PACABS "
    "PACBAR PACINF PAERO1 PAERO2 PAERO3 PAERO4 PAERO5 PAXISYM PAXSYMH PBAR PBARL PBARN1 PBCOMP PBDISCR PBEAM PBEAM3 "
    "PBEAML PBEAMD PBELTD PBEMN1 PBEND PBMSECT PBMARB6 PBMNUM6 PBRSECT PBUSH PBUSH1D PBUSH2D PBUSHT PCOHE PCOMP PCOMPF "
    "PCOMPFQ PCOMPG PCOMPG1 PCOMPLS PCOMPS PCOMP1 PCOMP2 PCONEAX PCONV PCONVM PCONV1 PDAMP PDAMP5 PDAMPT PDUM1 PDUM2 "
    "PDUM3 PDUM4 PDUM5 PDUM6 PDUM7 PDUM8 PDUM9 PELAS PELAST PFAST PGAP PGPLSN PHBDY PIHEX PIS2D8 PLCOMP PLPLANE "
    "PLSOLID "
    "PMASS PMIC PMREBAI PMREBAR PORUMAT PPLANE PQDMEM PQDMEM1 PQDMEM2 PQDPLT PQUAD1 PQUAD2 PROD PRODN1 PSEAM PSHEAR "
    "PSHEARN PSHELL PSHELL1 PSHLN1 PSHLN2 PSLDN1 PSOLCZ PSOLID PSPOT PSSHL PTORDRG PTRAPAX PTRBSC PTRIA1 PTRIA2 "
    "PTRIAAX "
    "PTRIM6 PTRMEM PTRPLT PTRPLT1 PTRSHL PTUBE PTWIST PVISC PWELD PWSEAM SNORM "
    // Coordinates, grids, tables, output.
    "CORD1C CORD1R CORD1S CORD2C CORD2R CORD2S CORD3G CORD3R CORD3RX CSYS GRID GRIDA GRIDB GRIDF GRIDS FREEPT PLOTEL "
    "PLOTEL3 PLOTEL4 PLOTEL6 PLOTEL8 PLOTHEX PLOTPEN PLOTPYR PLOTTET POINT FEEDGE FEFACE PSET PVAL PINTC PINTS GMCURV "
    "GMSURF OUTPUT OUTRCV CBARAO DMIGOUT EGRID SET1 SET2 SET3 SET4 SEQGP TABDMP1 TABLE3D TABLED1 TABLED2 TABLED3 "
    "TABLED4 TABLED5 "
    "TABLEDR TABLEH1 TABLEHT TABLEL1 TABLEM1 TABLEM2 TABLEM3 TABLEM4 TABLES1 TABLEST TABL3D1 TABRND1 TABRNDG TABVE "
    "TABSCTL ECHOON ECHOOFF PARAM PARAMARC SWLDPRM MDLPRM NASTRAN SYSTEM ITER ACCSSPT ACMODL ACPEMCP ACTRIM "
    "ADAPT ABSNMVS ABSTRCT BCPARA BCTPARA BCTPARM BGPARM BCRPARA BEDGE BDENTRY CAMPBLL CONTROL DMNCON DMRLAW "
    "FLSTCNT ISTRSSS METADATA NLCNTL2 NLOUT NLOUTUD ROTBENT ROTCOUP ROTORD ROTSE THPAD TABLEDM TABLRPC TIM2PSD TIMNAT "
    "TIMNVH PFMODE ERPPNL PANEL MARKER PMARKER FTGCNTL FREQ6 HADACRI WETELMG "
    "ADDCNFG ADMRECVR ALIASM AMLREG BRKSQL CLOAD COORD DYPARAM HYBDAMP IPSTRAIN ISTRESS ISTRNSH MONGRP MONPNT1 MONPNT2 "
    "MONPNT3 MONCNCM MONDSP1 MONSUM MONSUM1 MONSUMT NLPARM NLPCI NLSTEP NLCNTL NLCNTLG NLDAMP NLRGAP NLRSFD NLAUTO "
    "MODTRAK MBOLT MBOLTUS MTABRV DTI DMI DMIJ DMIJI DMIK DMIREF DTABLE DTABLE2 DTIINDTA FLSYM AXIF AXIC AXSLOT "
    "FSLIST PRESSET SLBDY BDYLIST CFIELD ENTUDS UDNAME UDSESV UFPDL GLBLOCK EBDSET EBDADD ELAR ELAR2 ELARADD "
    "CYSUP GROUP PARTN CONNECT RESTART FTGDEF FTGEVNT FTGLOAD FTGPARM FTGSEQ PFTG MATFTG TABLFTG "
    // Dynamics and eigenvalue control.
    "DAMPING DAMPGBL EIGB EIGC EIGP EIGR EIGRL FREQ FREQ1 FREQ2 FREQ3 FREQ4 FREQ5 FREQV RANDPS RANDT1 RCPARM "
    "RCROSS RGYRO RSPEED RSPINR RSPINT ROTORG ROTORB ROTORSE ROTORAX ROTHYBD ROTPARM UNBALNC PBEAR TF TSTEP TSTEP1 "
    "TSTEPNL "
    "NLFREQ NLFREQ1 NLHARM TRMCPL TEMPS TSTART "
    // Aeroelasticity.
    "AECOMP AECOMPL AEDW AEFACT AEFORCE AEGRID AELINK AELIST AELISTC AEPARM AEPRESS AEQUAD4 AERO AEROS AESCALE AESTAT "
    "AESURF AESURFS AETRIA3 CAERO1 CAERO2 CAERO3 CAERO4 CAERO5 CSSCHD DIVERG FLFACT FLUTTER GUST MKAERO1 MKAERO2 "
    "SPLINE1 SPLINE2 SPLINE3 SPLINE4 SPLINE5 SPLINE6 SPLINE7 SPLINEX SPLINRB SPBLND1 SPBLND2 SPRELAX STREAML1 STREAML2 "
    "TRIM TRIM2 UXVEC AEBGRP "
    // Heat.
    "BDYOR CHBDY CHBDYE CHBDYG CHBDYP CONV CONV3 CONVM FTUBE CFTUBE PFTUBE RADBC RADBND RADCAV RADCOL RADCT RADM RADMT "
    "RADMTX RADSET VIEW VIEW3D VIEWEX "
    // Optimization.
    "BEADVAR BNDGRID DCONADD DCONSTR DCONTHK DDVAL DEQATN DESVAR DLINK DOPTPRM DRESP1 DRESP2 DRESP3 DSCONS DSCREEN "
    "DTABLE DVAR DVBSHAP DVCREL1 DVCREL2 DVGEOM DVGRID DVLREL1 DVMREL1 DVMREL2 DVPREL1 DVPREL2 DVPRELS DVPSURF DVSET "
    "DVSHAP DVTREL1 TOMVAR TOPVAR DSYM DRESP1L DRESP2L TOPBMF STPGEN "
    // Control systems, superelement bookkeeping.
    "CONSYS EXTRN EXTRUDE SEBNDRY SEDLINK SEDRSP2 SEDRSP3 SEEXCLD SELABEL SELOC SENQSET SEQGP SETREE NPSET SWITCH "
    "TEMPMAP TOPLIN VECTOR VCCT "
    // Hints and switches of MYSTRAN and NASTRAN-95: congruent elements, debug output, partitions of printed matrices.
    "ADUM1 ADUM2 ADUM3 ADUM4 ADUM5 ADUM6 ADUM7 ADUM8 ADUM9 DSFACT MAT6 MATT6 MFREQ NFTUBE PELBOW PERMEAB PLFACT PLIMIT "
    "POINTAX POPT PPSE SEQEP VARIAN CNGRNT DEBUG PARVEC PARVEC1 PUSER1 PUSERIN "
    // Explicit dynamics, contact details, modules, mesh generation, user services and more of MSC and Simcenter.
    "ABINFL ABSNMVB ABSNMVI ABSNMVR ACADAPT ACDUCT ACORDER ACPMCP1 ATBACC ATBJNT ATBSEG BARRIER BCAUTOP BCBDPRP "
    "BCBMRAD BCBOX BCBZIER BCELIPS BCHANGE BCMATL BCMOVE BCNURB2 BCNURBS BCONUDS BCPATCH BCPFLG BCRGSRF BCRIGID "
    "BCSCAP BCTRIM BFRIC BFRLC BIAS BOUTPUT BRKPROP BRKSYS BSQUEAL BWIDTH CMARKB2 CMARKN1 COHFRIC COMPUDS CONCTL "
    "CONTRLT COSMGRP COSMINP COSMOUT COSMSEL COSMSRV COUCOHF COUOPT COUP1FL COUPINT COUPLE CRAKTP CYLINDR DEACTEL "
    "DEFUSET DETSPH DYFSISW DYNRED ELEMUDS ELIST EOSDEF EOSGAM EOSIG EOSJWL EOSMG EOSNA EOSPOL EOSUDS EQUIV ETEMP "
    "EULFOR EULFOR1 EULFREG EXCLUDE FAILJC FAILMPS FAILUDS FBADLAY FBAPHAS FBODYSB FFCONTR FLOW FLOWC FLOWDEF FLOWT "
    "FLOWUDS FORCUDS FRFCOMP FRFCONN FRFFLEX FRFRELS FRFSPC1 FRFXIT FRFXIT1 FSICTRL GBAG GBAGCOU GENUDS GMBNDC "
    "GMOVR3 GMQVOL GRIDD GRIDG GRIDMOD GRIDU GUST2 HADAPTL HDF5OUT HEATLOS HGSUPPR HTRCONV HTRRAD HYDROC HYDROS "
    "IMPCASE IMPGEOM INFLCG INFLFRC INFLGAS INFLHB INFLTNK INFLTR INSECT JCONADD JCONSET LBSH3DG LEAKAGE LIST MAREA "
    "MASSSET MAT10F MAT1A MAT1F MAT2F MAT3D MAT8A MAT8F MAT9F MATBV MATCB MATDEUL MATFAB MATHEV MATOVR MATTPZ1 "
    "MATTPZ2 MATUDS MCOHE MDBCATP MDBCNCT MDBCPAR MDBCTB1 MDBKSYS MDEXCLD MDFSET MDLABEL MDLOC MDMIR1 MDMIR2 MDMOVE "
    "MDMPLN MDROT1 MDROT2 MDSSET MDTRAN MESH MESHOFF MESHON MESHOPT MESHPLT MONCARL MPOINT MTTPZ1 MTTPZ2 NHRMPRM "
    "NLADAPT NLBSH3D NXSTRAT PAABSF PBELT PBSH2DT PCOMPA PDISTB PDISTBM PELAS1 PERMGBG PEULER PEULER1 PLOTG PLOTOPT "
    "PLTSURF PMINC PORFCPL PORFGBG PORFLOW PORFLWT PORHOLE PORHYDS PORUDS PRAC2D PRAC3D PSHLPF PSPRMAT PVISC1 "
    "RANDVAR REFROT REFRTSE RELEX ROTOR SHREL SHRPOL SHRUDS SPHERE STOCHAS SURFINI TABL3D TABL3D0 TABLED6 TABLEM5 "
    "TABLUDS TCOMPG TICEL TICEUDS TICEUL1 TICREG TICVAL TIRE TODYNA TRICON UNGLUE WALL WETELME WETLOAD WETSURF "
    "PLOTE EIDL EIDL2 EIDH EIDH2 "
    "YLDHY YLDJC YLDMC YLDMSS YLDPOL YLDRPL YLDSG YLDTM YLDUDS YLDVM YLDZA";

/// A name listed twice has the first effect.
const std::unordered_map<std::string_view, CardEffect>& get_effects() {
  static const auto effects = [] {
    std::unordered_map<std::string_view, CardEffect> table;
    const auto add = [&](std::string_view names, CardEffect effect) {
      while (!names.empty()) {
        const auto end = names.find(' ');
        if (end != 0) table.emplace(names.substr(0, end), effect);
        names.remove_prefix(end == std::string_view::npos ? names.size() : end + 1);
      }
    };
    add(stiffness_cards, CardEffect::Stiffness);
    add(mass_cards, CardEffect::Mass);
    add(constraint_cards, CardEffect::Constraint);
    add(load_cards, CardEffect::Load);
    add(damping_cards, CardEffect::Damping);
    add(neutral_cards, CardEffect::None);
    return table;
  }();
  return effects;
}

}  // namespace

std::optional<CardEffect> find_effect(std::string_view name) {
  const auto found = get_effects().find(name);
  if (found == get_effects().end()) return std::nullopt;
  return found->second;
}

std::string find_nearest_card(std::string_view name) {
  const auto sort_names = [](const auto& table) {
    std::vector<std::string> names;
    for (const auto& entry : table) names.emplace_back(entry.first);
    std::sort(names.begin(), names.end());
    return names;
  };
  static const auto read = sort_names(get_card_parsers()), known = sort_names(get_effects());
  if (name.substr(0, 3) == "END") return "ENDDATA";  // no card begins so
  const auto nearest = find_nearest(name, read);
  return nearest.empty() ? find_nearest(name, known) : nearest;
}

std::string_view find_selecting_command(std::string_view name) {
  constexpr std::string_view with_load =
      " ACCEL ACCEL1 FORCEAX FORCEDST GMLOAD LOADCYH LOADCYN LOADCYT MOMAX MOMNTDST PLOAD3 PLOADB3 PLOADG PLOADX "
      "PLOADX1 PRESAX RFORCE2 SLOADN1 ";
  constexpr std::string_view with_temperature =
      " TEMPAX TEMPB3 TEMPBC TEMPEX TEMPF TEMPN1 TEMPP2 TEMPP3 TEMPP4 TEMPG TMPSET ";
  const std::string word = " " + std::string(name) + " ";
  if (with_load.find(word) != std::string_view::npos) return "LOAD";
  return with_temperature.find(word) != std::string_view::npos ? "TEMPERATURE" : std::string_view{};
}

const char* find_loss(std::string_view name) {
  if (!name.empty() && name.back() == '1') name.remove_suffix(1);
  if (name == "BSET") return "the dofs that it would hold in component modes are as free as all others";
  if (name == "CSET") return "the dofs that it would leave free in component modes are dofs like all others";
  if (name == "QSET")
    return "its points are no amplitudes of component modes; nothing is reduced, and without stiffness they are held";
  if (name == "BNDFIX") return find_loss("BSET");
  if (name == "BNDFREE" || name == "BNDFRE") return find_loss("CSET");
  if (name == "USET") return "the set that it names is unknown to all that would refer to it";
  if (name == "EPOINT") return "extra points belong to complex modes and responses: nothing here depends on them";
  if (name == "RVDOF") return "no residual vectors are added to the modes";
  if (name == "ROTORG" || name == "ROTORD" || name == "RSPINR" || name == "RSPEED" || name == "RGYRO" ||
      name == "UNBALNC")
    return "rotors spin in SOL 107, 108, 110 and 111 alone: they are left out here";
  static constexpr std::array generators{"EGRID", "GRIDD",  "GRIDG",  "GRIDMOD", "GRIDU",
                                         "MAREA", "MPOINT", "INSECT", "TRICON",  "MESHON"};
  if (std::find(generators.begin(), generators.end(), name) != generators.end())
    return "MSGMESH is not executed: the grids and elements that it generates are missing; write them out with Nastran";
  if (name == "SPCOFF") return "AUTOSPC holds its dofs too when they have no stiffness";
  if (name == "SENQSET") return "sections have the component modes of QSET1 and SPOINT in their own bulk data alone";
  if (name == "SEEXCLD") return "its grids join by their places all the same; name the others by SEBNDRY";
  if (name.substr(0, 2) == "SE" && find_effect(name) && name != "SEQGP" && name != "SET" && name != "SEBULK" &&
      name != "SECONCT" && name != "SEBNDRY" && name != "SELOAD")
    return "superelements are not formed: the whole model is solved at once";
  return nullptr;
}

CardBase find_base(std::string_view name) {
  static constexpr std::array tables{"MATT1", "MATT2", "MATT8", "MATT9", "MATT11"};
  if (std::find(tables.begin(), tables.end(), name) != tables.end()) return CardBase::Material;
  if (name == "PELAST") return CardBase::Spring;
  if (name == "PBUSHT") return CardBase::Bush;
  return name == "PDAMPT" ? CardBase::Damper : CardBase::None;
}

std::optional<ResponseEffect> find_response_effect(std::string_view name) {
  if (name == "PBUSHT" || name == "PELAST")
    return ResponseEffect{"gives stiffness and damping over frequency", false, " computes with the nominal values"};
  if (name == "PDAMPT")
    return ResponseEffect{"gives damping over frequency", false, " computes with the nominal values"};
  if (name == "EPOINT") return ResponseEffect{"adds dofs to a response", false, " computes without them"};
  if (name == "TF") return ResponseEffect{"TFL", true, ""};
  if (name.substr(0, 5) == "NOLIN") return ResponseEffect{"NONLINEAR", true, ""};
  if (name == "GUST") return ResponseEffect{"GUST", true, ""};
  return std::nullopt;
}

const char* get_effect_name(CardEffect effect) {
  static constexpr std::pair<CardEffect, const char*> names[] = {
      {CardEffect::Stiffness, "stiffness"},
      {CardEffect::Mass, "mass"},
      {CardEffect::Constraint, "a constraint"},
      {CardEffect::Load, "a load"},
      {CardEffect::Damping, "damping, which real modes do not have"}};
  for (const auto& [one, name] : names)
    if (one == effect) return name;
  return "nothing Bough computes with";
}

}  // namespace bough::nastran::detail
