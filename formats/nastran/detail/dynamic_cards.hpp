#pragma once
/// \file Cards of loads over frequency and time, read for responses alone: elsewhere they are named as not read.
#include <string_view>
#include <unordered_map>

#include "formats/nastran/detail/card.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::nastran::detail {

using DynamicParser = void (*)(Card&, records::DynamicCards&);
using DynamicParserTable = std::unordered_map<std::string_view, DynamicParser>;

/// xLOADn, DLOAD, DAREA, DELAY, DPHASE, LSEQ, TIC, TABLEDn, TABDMP1, FREQn, TSTEP, RANDPS, RANDT1, TABRND1,
/// TABRNDG.
const DynamicParserTable& get_dynamic_parsers();

/// EIGC, TF, EPOINT: cards of complex modes alone.
const DynamicParserTable& get_complex_parsers();

/// The member of the case control that alone selects the sets of such cards; nullptr for other cards. What is wrong
/// with a set that no subcase selects is a warning.
int records::DynamicSelection::*find_selection_of(std::string_view card);

}  // namespace bough::nastran::detail
