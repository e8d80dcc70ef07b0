#pragma once
/// \file Ranking of modes in the linear models of whole systems, in one or several configurations.
#include <string>
#include <vector>

#include "analysis/select/weighing.hpp"

namespace bough::analysis {

/// Ranks the modes of the body file `o.body` in every system at every time requested; bodies of that file add up.
std::vector<Weighing> weigh_in_systems(const SelectRequest& o, Diagnostics& diagnostics);

/// A flexible body of a system whose modes are ranked with those of other bodies.
struct SystemBody {
  std::string name, file;  ///< path relative to the working directory
  records::FlexBody body;  ///< with the modes that the system uses
};

/// Flexible bodies of the first system by name, so that their order in the file has no effect. Throws InputError
/// "select.no-modes" if no body has modes, "select.other-bodies" if the systems have not the same.
std::vector<SystemBody> list_system_bodies(const SelectRequest& o, Diagnostics& diagnostics);

/// Ranks the modes of all bodies in every system at every time requested, in the order of `bodies`.
std::vector<Weighing> weigh_in_systems(const SelectRequest& o, const std::vector<SystemBody>& bodies,
                                       Diagnostics& diagnostics);

}  // namespace bough::analysis
