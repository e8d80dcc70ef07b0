#pragma once
/// \file The chapter of static solutions: deformed shapes, sums of forces, the largest of each kind.
#include <string>
#include <utility>
#include <vector>

#include "formats/records/static_result.hpp"
#include "report/page.hpp"

namespace bough::report {

/// Tables of the first 20 subcases; shapes of as many as a page can hold.
Chapter make_chapter(const records::StaticResult& result, const std::string& file,
                     const std::vector<std::pair<std::string, std::string>>& facts);

}  // namespace bough::report
