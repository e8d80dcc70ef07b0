#pragma once
/// \file Set selection of the case control: unions (SPCADD, MPCADD) and the subcase.
#include <string>
#include <vector>

#include "formats/records/deck.hpp"
#include "formats/records/params.hpp"

namespace bough::fe {

/// The subcase with this id; 0: the first that has an id, or what stands above them. Reports fe.unknown-subcase.
records::Subcase select_subcase(const records::Deck& deck, int id, Diagnostics& diagnostics);

/// Ids of the plain sets that set `sid` stands for: itself, or the members of its unions, each once.
/// `plain`: sorted ids of the sets with cards. Warns of sets without cards: fe.missing-set.
std::vector<int> expand_set(int sid, const std::vector<records::SetUnion>& unions, const std::vector<int>& plain,
                            const std::string& what, const records::Deck& deck, Diagnostics& diagnostics);

using records::get_real_param;

}  // namespace bough::fe
