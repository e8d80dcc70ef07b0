#pragma once
/// \file `bough select SYSTEM`: modes of all flexible bodies of a system, ranked together.
#include <string>
#include <vector>

#include "analysis/select/selection.hpp"
#include "analysis/select/system_weighing.hpp"

namespace bough::analysis {

struct SystemSelection {
  std::vector<SystemBody> bodies;  ///< by name
  Selection selection;             ///< rows: the modes of the bodies, one body after the other

  /// Modes kept of a body, from 0 and ascending. \param number  of the body, from 0.
  std::vector<int> list_kept(std::size_t number) const;
};

/// Ranks the modes of all flexible bodies of `request.systems` together, chooses `request.number` of all or as many as
/// the tolerance requires, and computes the loss without the others. Warnings: those of choose_and_measure(),
/// select.third-order. \throws InputError those of list_system_bodies() and of the weighings.
SystemSelection select_system_modes(const SelectRequest& request, Events& events);

/// A system file, and bodies, with the modes kept.
struct SelectedFiles {
  struct Text {
    std::string name, text;
  };
  struct Body {
    std::string name;
    records::FlexBody body;
  };
  std::vector<Text> systems;
  std::vector<Body> bodies;  ///< NAME.h5 for each body
};

/// The files of a selection, to be written into `folder`. Other files that a system names keep their location. A body
/// of which no mode is kept has its first in its file and `modes = 0` in the system.
SelectedFiles make_selected_files(const SelectRequest& request, const SystemSelection& answer,
                                  const std::string& folder);

}  // namespace bough::analysis
