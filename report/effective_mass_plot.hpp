#pragma once
/// \file Bars of the modal effective mass as SVG.
#include <string>

#include "report/modal_chapter.hpp"

namespace bough::report {

/// Draws a bar for each direction of motion: the shares of the modes in the mass, or in the inertia about the origin,
/// one after the other, up to 100 %. Each share has its mode and frequency as a title.
///
/// \return empty without effective masses.
std::string draw_effective_mass(const ModalModel& model);

}  // namespace bough::report
