#pragma once
#include <string>
#include <vector>

namespace bough::analysis {

struct EditCommand {
  std::string name, usage, description;
};

/// The commands of `bough edit`, as `help` lists them.
const std::vector<EditCommand>& get_edit_commands();
/// Returns a command of the list. \pre The name is in it.
const EditCommand& get_edit_command(const std::string& name);

}  // namespace bough::analysis
