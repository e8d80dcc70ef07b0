#pragma once
/// \file A free deck with a bit of everything that carries mass or holds by arms and links.
#include <string>

#include "formats/nastran/reader.hpp"

namespace bough::test {

inline records::Deck read_deck(const std::string& text, Diagnostics& diagnostics) {
  auto deck = nastran::read_deck_text(text, "deck.bdf", {}, diagnostics);
  diagnostics.throw_if_errors();
  return deck;
}

/// Bars (or beams instead) with offsets and pins, tapered and unsymmetric beams, an arc, offset and curved shells (or
/// beams), a solid, masses with offset and inertia. Nothing is held and no link is there.
inline std::string make_all_masses(bool with_bars = true, bool with_shells = true) {
  const std::string bar = with_bars ? "CBAR" : "CBEAM", property = with_bars ? ",1," : ",2,";
  std::string surface;
  if (with_shells) {
    surface =
        "PSHELL,5,1,.02,1,,1,,3.\n"
        "CQUAD4,11,5,11,12,13,14,,.04\nCTRIA3,12,5,14,13,15,,-.03\n"
        "CQUADR,13,5,11,12,13,14\n"
        "CQUAD8,14,5,21,22,23,24,25,26\n,27,28,,,,,,.03\n";
  } else {  // rings of beams
    const int ends[][2] = {{11, 12}, {12, 13}, {13, 14}, {14, 11}, {14, 15}, {13, 15}, {21, 25},
                           {25, 22}, {22, 26}, {26, 23}, {23, 27}, {27, 24}, {24, 28}, {28, 21}};
    int id = 60;
    for (const auto& [a, b] : ends)
      surface += "CBEAM," + std::to_string(++id) + ",2," + std::to_string(a) + "," + std::to_string(b) + ",.1,.2,1.\n";
  }
  return "SOL 103\nCEND\nBEGIN BULK\n"
         "GRID,1,,0.,0.,0.\nGRID,2,,1.,.1,0.\nGRID,3,,2.,-.1,.2\nGRID,4,,2.1,1.,.3\nGRID,5,,2.,1.1,1.2\n"
         "GRID,6,,1.1,1.,1.3\nGRID,7,,.1,1.2,.9\n"
         "MAT1,1,70.+9,,.3,2700.\nMAT1,2,3.+9,,.3,1200.\n"
         "PBAR,1,1,4.-4,3.-8,5.-8,6.-8,1.5\n" +
         bar + ",1" + property + "1,2,0.,0.,1.\n,,,.01,.05,-.03,.02,-.04,.06\n" + bar + ",2" + property +
         "2,3,0.,0.,1.\n" + bar + ",3" + property +
         "3,4,0.3,0.,1.\n,5,,.0,.03,.01,.02,.03,-.02\n"
         "PBEAM,2,1,4.-4,8.-8,2.-8,1.-8,3.-8,.7\n,,,,,,,,\n,YES,1.,3.-4,5.-8,1.-8,5.-9,2.-8,.5\n,,,,,,,,\n"
         ",.8,.8\n,.01,.02,-.01,.02,.005,-.01,.01,.01\n"
         "CBEAM,4,2,4,5,1.,0.2,0.\n"
         "CBEAM,5,2,5,6,0.,0.2,1.\n,,,.02,.03,-.05,-.02,.04,.03\n"
         "PBEND,3,1,4.-4,3.-8,5.-8,6.-8,2,1.5\n"
         "CBEND,6,3,6,7,0.,1.,1.,1\n"
         // offset shells: a warped quadrilateral, a triangle
         "GRID,11,,0.,0.,0.\nGRID,12,,-1.,.1,0.\nGRID,13,,-1.1,1.1,.06\nGRID,14,,-.1,1.,0.\nGRID,15,,-.6,1.7,.1\n"
         // a curved one
         "GRID,21,,-1.,.1,0.\nGRID,22,,-1.1,1.1,.06\nGRID,23,,-2.1,1.,-.2\nGRID,24,,-2.,0.,-.3\n"
         "GRID,25,,-1.05,.6,.05\nGRID,26,,-1.6,1.05,-.02\nGRID,27,,-2.1,.5,-.22\nGRID,28,,-1.5,.05,-.1\n"
         // masses
         "CONM2,31,7,,.6,.2,-.1,.3\n,.02,.003,.03,-.002,.004,.04\n"
         "PSOLID,6,2\nCTETRA,90,6,4,3,5,2\nCONM2,32,3,,.4\nCONM2,33,13,,.2,0.,0.,.2\n" +
         surface;
}

/// The parts tied by links, and a lever with a mass for each kind of link.
inline std::string make_all_kinds(bool with_bars = true, bool with_shells = true) {
  const std::string bar = with_bars ? "CBAR" : "CBEAM";
  const std::string property = with_bars ? "PBAR,9,1,4.-4,3.-7,5.-7,6.-7\n" : "PBEAM,9,1,4.-4,3.-7,5.-7,,6.-7\n";
  return make_all_masses(with_bars, with_shells) + property +
         "RBE2,101,1,123456,11\n"
         "RBE2,102,12,123456,21\nRBE2,103,13,123456,22\n"
         // grids of the levers: 41 RBE2, 42 on 41 by RBE2 of translations and a soft bar, 43 RBAR, 44 RBE1, 45 RBE3
         "GRID,41,,.2,2.,1.3\nRBE2,104,7,123456,41\nCONM2,41,41,,.3,.1,.1,0.\n"
         "GRID,42,,.3,2.2,2.\nRBE2,105,41,123456,42\nCONM2,42,42,,.5\n"
         "GRID,43,,3.,-.3,.4\nRBAR,106,3,43,123456,,,123456\nCONM2,43,43,,.25\n"
         "GRID,44,,2.5,1.5,-.4\nRBE1,107,4,123456\n,UM,44,123456\nCONM2,44,44,,.35\n"
         "GRID,45,,-1.7,.6,.8\nRBE3,108,,45,123456,1.,123,21\n,22,23,24\nCONM2,45,45,,.45,.1,0.,0.2\n"
         // a bar held at its far end by a rod without strain, one on a plate link, one on a bush with arms
         "GRID,46,,3.,1.,1.\nGRID,47,,3.2,.2,.1\n" +
         bar + ",46,9,46,5,0.,1.,.2\nRROD,109,46,47,,1\n" + bar +
         ",47,9,47,3,0.,1.,.2\nCONM2,46,46,,.3\n"
         "GRID,48,,-.5,1.,1.\nRTRPLT,110,14,15,48,12346,3\nCONM2,48,48,,.15,.05,.1,0.\n"
         "GRID,49,,.1,1.6,.9\nPBUSH,8,K,1.+6,2.+6,3.+6,1.+4,2.+4,3.+4\n"
         "CBUSH,49,8,7,49,0.,0.,1.\n,.3\nCONM2,49,49,,.2,.02,.03,.01\n"
         // a fork: translations only, the rotations held by a bar; and a mean of rotations too, solved for others
         "GRID,50,,1.,.1,.7\nRBE2,111,2,123,50\n" +
         bar +
         ",50,9,50,6,0.,1.,.2\nCONM2,50,50,,.22\n"
         "GRID,51,,-1.5,.2,.6\nRBE3,112,,51,123456,1.,123456,24\n,23,2.,123456,28\nCONM2,51,51,,.33,0.,.1,.1\n";
}

}  // namespace bough::test
