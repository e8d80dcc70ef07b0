#include "analysis/edit/edit_commands.hpp"

#include <algorithm>

#include "base/diagnostic.hpp"

namespace bough::analysis {

const std::vector<EditCommand>& get_edit_commands() {
  static const std::vector<EditCommand> commands{
      {"list", "list [KIND]", "The tables of the file, or those of a kind."},
      {"show", "show [NAME | KIND NAME | NAME.key]", "The lines of a table, a value, or the whole text."},
      {"add", "add KIND [NAME] [key=value ...]", "A new table; at a terminal what is required is asked for."},
      {"set", "set NAME.key=value ...",
       "Changes a value or adds it; also 'change'. Of several of one name: KIND.NAME.key."},
      {"unset", "unset NAME.key ...", "Takes the key away."},
      {"delete", "delete NAME [--with-references]", "Takes the table away; what refers to it only if asked to."},
      {"rename", "rename NAME NEW", "Another name, wherever it is referred to: keys, signals, channels, $parameters."},
      {"copy", "copy NAME NEW", "A second table of the same keys under another name."},
      {"undo", "undo", "Takes the last change back."},
      {"redo", "redo", "Does it again."},
      {"check", "check", "Every error of the text as it is now, as bough check finds them."},
      {"run", "run [options]", "bough run of the saved file."},
      {"reduce", "reduce [options]", "bough reduce of the saved body file."},
      {"plot", "plot RESULTS.h5 [options]", "bough plot."},
      {"diff", "diff", "What has changed since the file was read or saved."},
      {"save", "save [FILE] [--force]", "Writes the file; what was not edited keeps every byte."},
      {"quit", "quit", "Ends the session; asks where something is not saved."},
      {"help", "help [COMMAND | KIND | KEY]", "The commands; keys with type, range, default and choices."},
      {"complete", "complete TEXT", "What the tabulator would offer after TEXT, for other editors."}};
  return commands;
}

const EditCommand& get_edit_command(const std::string& name) {
  const auto& commands = get_edit_commands();
  const auto at = std::find_if(commands.begin(), commands.end(), [&](const auto& c) { return c.name == name; });
  BOUGH_DEMAND(at != commands.end());
  return *at;
}

}  // namespace bough::analysis
