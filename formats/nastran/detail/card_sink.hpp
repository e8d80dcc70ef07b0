#pragma once
/// \file The groups of card writers, as parsers.hpp has the groups of card parsers.
#include <string>

#include "formats/nastran/detail/card_text.hpp"

namespace bough::nastran::detail {

/// Where the cards of one deck go.
struct CardSink {
  FieldFormat format = FieldFormat::Large;
  std::string out;
  void put(const CardFields& card) { card.write(format, out); }
};

void write_points(const records::Deck& deck, CardSink& sink);           ///< GRID, SPOINT, CORD1x, CORD2x
void write_materials(const records::Deck& deck, CardSink& sink);        ///< MATi
void write_properties(const records::Deck& deck, CardSink& sink);       ///< Pxxx of lines and points
void write_line_elements(const records::Deck& deck, CardSink& sink);    ///< CBAR, CBEAM, CROD, CONROD, CTUBE, PLOTEL
void write_point_elements(const records::Deck& deck, CardSink& sink);   ///< CELASi, CMASSi, CBUSH, CONMi
void write_dampers(const records::Deck& deck, CardSink& sink);          ///< CDAMPi, CVISC, CBUSH1D and properties
void write_shells(const records::Deck& deck, CardSink& sink);           ///< shells, CSHEAR, PSHEAR
void write_continua(const records::Deck& deck, CardSink& sink);         ///< PSHELL, PCOMP, PSOLID, solids
void write_constraints(const records::Deck& deck, CardSink& sink);      ///< RBEi, RBAR, RROD, SPC, SPC1, MPC, xADD
void write_dof_sets(const records::Deck& deck, CardSink& sink);         ///< SUPORT, SUPORT1, ASET, OMIT
void write_direct_matrices(const records::Deck& deck, CardSink& sink);  ///< DMIG
void write_loads(const records::Deck& deck,
                 CardSink& sink);  ///< FORCEi, MOMENTi, PLOADi, GRAV, RFORCE, SPCD, SLOAD, LOAD
void write_temperatures(const records::Deck& deck, CardSink& sink);  ///< TEMP, TEMPD, TEMPRB, TEMPP1
void write_special(const records::Deck& deck, CardSink& sink);       ///< PBCOMP, GENEL, CGAP, NSM, RSPLINE, ACCEL
void write_solution(const records::Deck& deck, CardSink& sink);      ///< EIGRL, EIGR, PARAM

}  // namespace bough::nastran::detail
