#pragma once
/// \file Cards of loads over frequency and time, read for responses alone: elsewhere they are named as not read.
#include <string_view>
#include <unordered_map>

#include "formats/nastran/detail/card.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::nastran::detail {

using DynamicParser = void (*)(Card&, records::DynamicCards&);
using DynamicParserTable = std::unordered_map<std::string_view, DynamicParser>;

/// xLOADn, DLOAD, DAREA, DELAY, DPHASE, LSEQ, TIC, TABLEDn, TABDMP1, FREQn, TSTEP.
const DynamicParserTable& get_dynamic_parsers();

}  // namespace bough::nastran::detail
