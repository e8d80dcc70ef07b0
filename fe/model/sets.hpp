#pragma once
/// \file Set selection of the case control: unions (SPCADD, MPCADD) and the subcase.
#include <string>
#include <vector>

#include "bough/formats/records/deck.hpp"

namespace bough::fe {

/// The subcase with this id; 0: the first that has an id, or what stands above them. Reports fe.unknown-subcase.
records::Subcase select_subcase(const records::Deck& deck, int id, Diagnostics& diagnostics);

/// Ids of the plain sets that set `sid` stands for: itself, or the members of its unions, each once.
/// `plain`: sorted ids of the sets that have cards of their own. Reports fe.missing-set.
std::vector<int> expand_set(int sid, const std::vector<records::SetUnion>& unions, const std::vector<int>& plain,
                            const std::string& what, const records::Deck& deck, Diagnostics& diagnostics);

/// A PARAM as a real number in any Nastran spelling ("2.59-3", "1.D2"); `fallback` when absent. Reports fe.bad-param.
double get_real_param(const records::Deck& deck, const std::string& name, double fallback, Diagnostics& diagnostics);

}  // namespace bough::fe
