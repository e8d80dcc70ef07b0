#pragma once
/// \file The chapter of complex modes: poles, damping, shapes in motion.
#include <string>
#include <utility>
#include <vector>

#include "formats/records/complex_modes.hpp"
#include "report/page.hpp"

namespace bough::report {

/// Composes the chapter: eigenvalues, damping ratios, shapes, and checks of residuals and of unstable modes. \param
/// facts  names and values for its head.
Chapter make_chapter(const records::ComplexModesResult& modes, const std::string& file,
                     const std::vector<std::pair<std::string, std::string>>& facts);

}  // namespace bough::report
