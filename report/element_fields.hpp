#pragma once
/// \file Stresses, strains, failure indices and margins of a static solution as colours of its elements.
#include <string>

#include "formats/records/static_result.hpp"
#include "report/drawing.hpp"

namespace bough::report {

/// Returns the name of a column of `/subcases/ID/stresses` or `strains`: "von_mises@top" of a stress is "von Mises
/// stress, top", "xx@C_a" is "stress xx, C, end a".
std::string name_field(const std::string& component, const std::string& quantity);

/// Adds the columns of stresses, strains and margins, derived quantities first. A column belongs to all cards that have
/// it; elements that are neither drawn nor touch a drawn point are left out.
///
/// \param max_values  columns that would need more numbers, of all shapes together, are left out.
/// \return number of columns that are left out.
/// \pre the shapes of `drawing` belong to the first subcases of `result`.
int add_fields(const records::StaticResult& result, Drawing& drawing, std::size_t max_values = 900000);

}  // namespace bough::report
